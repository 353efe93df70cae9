// SPDX-License-Identifier: GPL-3.0-or-later
// What can be seen from points and patrol areas in an error volume, as a hidden volume.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/progress.h"
#include "jobs/view_places.h"
#include "sight/volume_viewshed.h"
#include "volume/hidden_places.h"

namespace sightbound {

struct VolumeSightOptions {
  double confidence = 0.95;
  double refraction = 0.13;
  bool curvature = true;
  SeenFrom seen_from = SeenFrom::kAny;  // any or all of the view places, all views together
  HeightReference height_reference = HeightReference::kGround;
  double max_distance = kUnlimited;       // metres in plan; targets beyond have no verdict
  HoldsFor holds_for = HoldsFor::kVoxel;  // what of a target its verdict speaks of
  double view_spacing =
      0;  // metres between places in a patrol area; 0 = an eighth of it, at least the targets'
  LatticeOptions targets;         // not used by subtract_observer()
  double most_lines = 1e9;        // refused above
  int threads = 0;                // 0 = all cores
  std::size_t memory_budget = 0;  // bytes; 0 = three quarters of the machine's memory
};

struct SightEstimate {
  std::size_t view_places = 0, targets = 0;
  double lines = 0;
  std::size_t bytes = 0;  // of the answer, while it is made
  double seconds = 0;     // about: from lines timed through this very volume
};

struct HiddenResult {
  HiddenVolume hidden;
  SightEstimate estimate;  // seconds left at 0
  std::vector<std::string> warnings;
};

// Throw InvalidInput, OverBudget, Cancelled.
SightEstimate estimate_sight(const ErrorVolume&, const std::vector<ViewVolume>&, const VolumeSightOptions&,
                             Progress&);
HiddenResult run_volume_viewshed(const ErrorVolume&, const std::vector<ViewVolume>&,
                                 const VolumeSightOptions&, Progress&);

// What a further observer takes away from a hidden volume.
struct Subtraction {
  HiddenVolume rest;
  double gained_m3 = 0;       // not visible before, visible now
  double gained_core_m3 = 0;  // surely hidden before, not now
  HiddenArea before, after;   // for the height asked
  SightEstimate estimate;
  std::vector<std::string> warnings;
};
// The volume must be the one that `hidden` was made with (InvalidInput when it lies elsewhere). Targets and
// confidence are those of `hidden`; height_m > 0, at most its ceiling.
Subtraction subtract_observer(const HiddenVolume& hidden, const ErrorVolume&, const std::vector<ViewVolume>&,
                              const VolumeSightOptions&, double height_m, Progress&);

}  // namespace sightbound
