// SPDX-License-Identifier: GPL-3.0-or-later
// The terrain that a volume surrounds, face by face, with its error: what the volume is built from, and what
// sight asks near the ends of a line, where voxels are too coarse.
//
// Everything is in local metres: x and y from the frame's place in the CRS (the lowest of all vertices in x
// and in y, so that local plan coordinates are >= 0), z the height itself.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "error_model/error_field.h"
#include "terrain/tin.h"

namespace sightbound {

struct VolumeFrame {
  double x = 0, y = 0;         // of local (0, 0), CRS units
  double metres_per_unit = 1;  // of the CRS in plan
  std::string crs_wkt;         // empty = a plane in metres

  Xyz to_crs(const Xyz& local) const {
    return {x + local.x / metres_per_unit, y + local.y / metres_per_unit, local.z};
  }
  Xyz from_crs(const Xyz& crs) const {
    return {(crs.x - x) * metres_per_unit, (crs.y - y) * metres_per_unit, crs.z};
  }
};

// How distance from the terrain is measured: height fields vertically, all else along the normal.
enum class Metric { kVertical, kNormal };

// What the sides of the terrain mean. Height fields and closed bodies have an outside (k > 0) and an inside;
// a sheet has only the two sides of its faces, and nothing is inside.
enum class Sides { kSolid, kSheet };

struct SurfaceFace {
  std::array<Xyz, 3> corner;
  std::array<double, 3> sampling{};   // sigma_s at the corners, metres; linear between
  std::array<double, 3> amplitude{};  // Delta / z(0.95), metres; linear between
  // Plan metres to ground metres, row-major 2 x 2: DEMs measure d with the ground size of their cells.
  // Identity for TINs.
  std::array<double, 4> to_ground{1, 0, 0, 1};

  // d: distance to the nearest corner; in plan on the ground for the vertical metric, in space for the normal
  // one.
  double nearest_corner_in_plan(double x, double y) const;
  double nearest_corner_in_space(const Xyz& place) const;
};

class Surface {
 public:
  virtual ~Surface() = default;

  Metric metric() const { return metric_; }
  Sides sides() const { return sides_; }
  const VolumeFrame& frame() const { return frame_; }
  const GrowthProfile& profile() const { return profile_; }
  // Is there any error between the samples?
  bool has_between() const { return has_between_; }
  // L: larger cell side of a DEM, else median edge, metres. End zones of sight are 1.5 L long.
  double spacing_m() const { return spacing_m_; }
  const Box3& bounds() const { return bounds_; }

  // Faces are numbered [0, face_count()); some numbers of a DEM stand for holes.
  std::size_t face_count() const { return face_count_; }
  virtual std::optional<SurfaceFace> face(std::size_t number) const = 0;

  // Numbers of the faces whose bounding box meets `box`, ascending, into `found` (cleared first). DEMs look
  // at the plan alone unless the box is small. Any thread; the first call may build an index.
  virtual void faces_near(const Box3& box, std::vector<std::uint32_t>& found) const = 0;

  // Bytes in memory, index included.
  virtual std::size_t bytes() const = 0;

 protected:
  Metric metric_ = Metric::kVertical;
  Sides sides_ = Sides::kSolid;
  VolumeFrame frame_;
  GrowthProfile profile_;
  bool has_between_ = false;
  double spacing_m_ = 0;
  Box3 bounds_;
  std::size_t face_count_ = 0;
};

// sigma_s + sigma_g at a plan place of a face (vertical metric); the parts apart, since sight judges the ends
// of a line by sigma_g alone.
struct SurfacePlace {
  double height = 0, sampling = 0, between = 0;  // metres

  double sigma() const { return sampling + between > kLeastSigma ? sampling + between : kLeastSigma; }
};
// Linear in the face's plane, also beyond its edges. The face must not be vertical.
SurfacePlace place_on(const SurfaceFace&, const GrowthProfile&, double x, double y);

}  // namespace sightbound
