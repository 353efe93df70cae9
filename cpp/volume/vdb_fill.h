// SPDX-License-Identifier: GPL-3.0-or-later
// Height fields: the trees of a volume filled column by column (vertical metric).
#pragma once

#include "base/parallel.h"
#include "base/progress.h"
#include "volume/plan_mask.h"
#include "volume/surface.h"
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

}  // namespace sightbound
