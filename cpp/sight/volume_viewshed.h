// SPDX-License-Identifier: GPL-3.0-or-later
// Which places above the ground are seen from a set of view places (paper section 5.2): the volume's
// viewshed.
//
// Coarse to fine (target_tile.h): beams between boxes of targets and of views first, then single lines, some
// microseconds each. Memory: some 10 KiB a view place. Parallel over tiles of columns; the same answer for
// any number of threads.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "sight/view_tree.h"
#include "sight/volume_sight.h"
#include "volume/hidden_volume.h"

namespace sightbound {

// A target counts as seen when it is seen from any of the view places, or from all of them.
enum class SeenFrom { kAny, kAll };

// What a target's verdict holds for: its centre alone; every place within half a voxel of the error volume of
// it; or all of the target's box above ground. Claims that do not hold so far are uncertain.
enum class HoldsFor { kPlace, kVoxel, kTarget };

struct VolumeViewshedOptions {
  double confidence = 0.95;
  SeenFrom seen_from = SeenFrom::kAny;
  HoldsFor holds_for = HoldsFor::kVoxel;
  double max_distance_m = 1e300;  // in plan; targets beyond have no verdict
};

// Seen from any: some view place sees the target; hidden: no place in any of the cells does. Seen from all:
// every place in all of the cells sees it; hidden: from some view place it is.
// Views are in local metres (VolumeFrame). Throws InvalidInput (no views, confidence outside (0, 1) or beyond
// the band), Cancelled. Advances `progress` to its end.
HiddenVolume volume_viewshed(const VolumeSight& sight, const std::vector<ViewPlace>& views,
                             std::shared_ptr<const TargetLattice> targets,
                             const VolumeViewshedOptions& options, const Workers& workers,
                             Progress& progress);

// The same for single places (local metres), one answer each: that of a target whose centre is there, with
// HoldsFor::kTarget the same as kPlace. Places that have no terrain above or beneath have no verdict.
std::vector<TargetAnswer> see_places(const VolumeSight& sight, const std::vector<ViewPlace>& views,
                                     const std::vector<Xyz>& targets, const VolumeViewshedOptions& options,
                                     const Workers& workers, Progress& progress);

}  // namespace sightbound
