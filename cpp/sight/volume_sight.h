// SPDX-License-Identifier: GPL-3.0-or-later
// One sight line in an error volume, ends included (design sections 3 and 4, docs/algorithms/volume.md).
//
// Between the end zones the voxels alone judge: bounds of k* from the walk of volume_ray.h. Within 1.5 L of
// either end sigma_g alone counts, voxels are too coarse, and the triangles around the end are judged
// themselves: where the line crosses their edges and at 1/16, 1/8, 1/4, 1/2 and 3/4 L from the end. The ends
// are not judged. Cost of an EndZone: a look-up of faces; of a line: that of its walk and some tens of
// crossings.
#pragma once

#include <optional>
#include <vector>

#include "error_model/verdict.h"
#include "sight/end_faces.h"
#include "sight/end_room.h"
#include "volume/volume_ray.h"

namespace sightbound {

// How far the curved ground drops below a straight line, from place to place in plan: (1 - refraction) / 2
// times the curvature of the ellipsoid in the direction of (dx, dy) (Euler), 1 / metre. All 0 = a plane.
struct GroundBend {
  double xx = 0, xy = 0, yy = 0;

  double drop(double dx, double dy) const { return xx * dx * dx + 2 * xy * dx * dy + yy * dy * dy; }
};

// The faces around an observer or a target; for any number of lines that end there.
class EndZone {
 public:
  // `place` in local metres.
  EndZone(const Surface&, const Xyz& place);
  // Cheap for height fields: their faces stay.
  void move_to_height(double z);

  const Xyz& place() const { return place_; }
  // The same k bounds as VolumeRays::least, for the part of the line within the zone; `from_start`: the
  // line's end at t = 0 is this place.
  RatioInterval least(const VolumeLine&, bool from_start, float beyond) const;

 private:
  void find_faces();
  RatioInterval least_in_plan(const VolumeLine&, double t0, double t1, bool from_start, float beyond) const;
  RatioInterval least_in_space(const VolumeLine&, double t0, double t1, bool from_start, float beyond) const;

  const Surface* surface_;
  Xyz place_;
  std::vector<SurfaceFace> faces_;    // vertical metric
  std::optional<EndFaces> in_space_;  // along the normal
};

class VolumeSight {
 public:
  // Keeps references.
  VolumeSight(const VolumeRays& rays, const GroundBend& bend);

  const VolumeRays& rays() const { return rays_; }
  EndZone zone(const Xyz& place) const { return EndZone(rays_.volume().surface(), place); }
  EndRoom room(const Xyz& middle, const Xyz& half) const { return EndRoom(rays_.volume(), middle, half); }

  // Bounds of k* between the two places, within +-K'.
  RatioInterval ratio(const EndZone& observer, const EndZone& target) const {
    return least(observer, target, VolumeRays::kNever).k;
  }
  // The same with a hint, as VolumeRays::least_near takes and gives it.
  LeastOnLine least(const EndZone& observer, const EndZone& target, double hint) const;

  // Proofs for every line between two boxes; false = not proven. k* >= ratio for all; k* <= -ratio for all.
  // abs(ratio) <= K, > 0 where the end zones are judged. Sheets are never proven to block.
  bool clear(const EndRoom& observer, const EndRoom& target, double ratio) const;
  bool blocked(const EndRoom& observer, const EndRoom& target, double ratio) const;
  // The same from the voxels, or their blocks, alone: cheaper for large boxes, and proves less. What is clear
  // with the error of the samples is clear without.
  bool clear(const EndRoom& observer, const Box3& targets, double ratio) const;
  bool blocked(const Box3& observers, const Box3& targets, double ratio, Grain) const;
  // ratio().low is not above `most` for any of the lines.
  bool doubtful(const Box3& observers, const Box3& targets, double most, Grain) const;

 private:
  LineBundle bundle(const Box3& from, const Box3& to) const;

  const VolumeRays& rays_;
  GroundBend bend_;
};

// A claim needs the near bound: visible k.low >= z(c), hidden k.high <= -z(c).
inline std::uint8_t verdict_of(const RatioInterval& k, double quantile) {
  if (static_cast<double>(k.low) >= quantile) return kVisible;
  return static_cast<double>(k.high) <= -quantile ? kHidden : kUncertain;
}
// The confidence of visibility that is proven: F of the bound nearer to 0, 1/2 where the sign is open.
double proven_probability(const RatioInterval& k, Tails tails);

}  // namespace sightbound
