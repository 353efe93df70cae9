// SPDX-License-Identifier: GPL-3.0-or-later
// Any TIN as the surface of a volume.
#pragma once

#include <mutex>

#include "terrain/tin_topology.h"
#include "volume/box_tree.h"
#include "volume/surface.h"
#include "volume/tin_error.h"
#include "volume/triangle.h"

namespace sightbound {

// The nearest place of a surface.
struct ClosestPlace {
  std::size_t face = 0;
  Xyz place;
  double distance = 0;  // metres
};

class TinSurface final : public Surface {
 public:
  // Vertical for a height field (tin_height_field.h), else along the normal.
  static Metric metric_of(const Tin&);

  // The Tin must be clean (tin.h). Throws InvalidInput when sizes do not agree.
  TinSurface(Tin tin, TinError error, Metric metric);

  const Tin& tin() const { return tin_; }
  const TinError& error() const { return error_; }
  // Local coordinates of a vertex.
  Xyz vertex(std::int32_t v) const { return tin_.vertices[static_cast<std::size_t>(v)] - shift_; }

  std::optional<SurfaceFace> face(std::size_t number) const override;
  void faces_near(const Box3& box, std::vector<std::uint32_t>& found) const override;
  std::size_t bytes() const override;

  // The nearest place of any face to a local place, the lowest face of several. Any thread.
  ClosestPlace closest(const Xyz& local) const;

  // Which faces are neighbours (empty with the vertical metric), and the boxes of the faces.
  const TinTopology& topology() const { return topology_; }
  const BoxTree& boxes() const;

 private:
  Tin tin_;
  TinError error_;
  TinTopology topology_;
  Xyz shift_;  // from the Tin's own coordinates to local ones
  mutable std::once_flag indexed_;
  mutable BoxTree boxes_;
};

}  // namespace sightbound
