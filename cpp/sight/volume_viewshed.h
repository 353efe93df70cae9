// SPDX-License-Identifier: GPL-3.0-or-later
// Which places above the ground are seen from a set of view places (paper section 5.2): the volume's
// viewshed.
//
// Cost: view places x targets lines, each some microseconds; a column's targets share their end zone.
// Parallel over columns; the same answer for any number of threads.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "sight/volume_sight.h"
#include "volume/hidden_volume.h"

namespace sightbound {

// A target counts as seen when it is seen from any of the view places, or from all of them.
enum class SeenFrom { kAny, kAll };

struct VolumeViewshedOptions {
  double confidence = 0.95;
  SeenFrom seen_from = SeenFrom::kAny;
  double max_distance_m = 1e300;  // in plan; targets beyond have no verdict
};

// Views are in local metres (VolumeFrame). Throws InvalidInput (no views, confidence outside (0, 1) or beyond
// the band, too many lines), Cancelled. Advances `progress` to its end.
HiddenVolume volume_viewshed(const VolumeSight& sight, const std::vector<Xyz>& views,
                             std::shared_ptr<const TargetLattice> targets,
                             const VolumeViewshedOptions& options, const Workers& workers,
                             Progress& progress);

}  // namespace sightbound
