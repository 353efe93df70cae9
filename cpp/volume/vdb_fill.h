// SPDX-License-Identifier: GPL-3.0-or-later
// Height fields: the trees of a volume filled column by column (vertical metric).
#pragma once

#include "base/parallel.h"
#include "base/progress.h"
#include "volume/face_distance.h"
#include "volume/plan_mask.h"
#include "volume/surface.h"
#include "volume/tin_surface.h"
#include "volume/vdb.h"

namespace sightbound {

struct VoxelSize {
  double side = 0, height = 0;  // metres
};

// Band, inside and background of `ratios` (made with its background), and where the terrain is unknown.
// Bounds of k are those of column_overlay.h: exact but for what lies between the bounds of sigma_g. Advances
// `progress` by 1 in all.
PlanMask fill_ratios(const Surface& surface, const VoxelSize& size, double largest_ratio, RatioTree& ratios,
                     const Workers&, Progress&);

// Voxels wholly within +-quantile, and those that touch it; `inner` leaves out columns where terrain is
// missing.
void fill_covers(const Surface& surface, const VoxelSize& size, double quantile, BitTree& inner,
                 BitTree& outer, const Workers&, Progress&);

// Any TIN, along the normal: band, inside (solids) and background of `ratios`, and the band's voxels whose
// places may be nearest to a border. Voxel by voxel from the faces that may be nearest to some place of it
// (face_distance.h), found by halving boxes from leaves down. Advances `progress` by 1 in all.
void fill_nearest(const TinSurface& surface, const VoxelSize& size, double largest_ratio, RatioTree& ratios,
                  BitTree& ambiguous, const Workers&, Progress&);

// Solids: gives all that lies inside, beyond the band, the value `inside`. Voxels and tiles beyond the band
// that touch one another lie on one side, so one place of each such group within a node is looked at.
void fill_inside(const TinSurface& surface, const FaceDistances& distances, const VoxelSize& size,
                 std::int32_t inside, RatioTree& ratios, const Workers&);

}  // namespace sightbound
