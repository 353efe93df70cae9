// SPDX-License-Identifier: GPL-3.0-or-later
// Where a surface may lie (paper section 5.1): a set of voxels that is asked of whole triangles.
//
// holds() is never true for a triangle with a point outside the set, interior and edges included; it is false
// for every triangle with a point outside by more than the slack below. Any thread; O(voxels touched), stops
// at the first one that is missing.
#pragma once

#include <array>

#include "terrain/tin.h"
#include "volume/volume_mask.h"

namespace sightbound {

// Triangles are taken that much thicker, metres: coordinates of a CRS in doubles are rounded by less below
// 10,000 km, so that what was found holds for the triangle as written.
inline constexpr double kWrittenSlack = 1e-6;

class PermissionGrid {
 public:
  // As inner(c) of an error volume with such voxels, metres.
  PermissionGrid(VolumeMask allowed, double voxel_m, double voxel_height_m)
      : allowed_(std::move(allowed)), voxel_{voxel_m, voxel_m, voxel_height_m} {}

  // In local metres (surface.h).
  bool holds(const std::array<Xyz, 3>& triangle) const;

  double voxel_m() const { return voxel_.x; }
  double voxel_height_m() const { return voxel_.z; }
  std::size_t bytes() const { return allowed_.bytes(); }

 private:
  VolumeMask allowed_;
  Xyz voxel_;
};

}  // namespace sightbound
