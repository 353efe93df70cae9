// SPDX-License-Identifier: GPL-3.0-or-later
// Sight in an error volume to targets at one height above all the ground, as rasters, and to listed ones.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "jobs/volume_viewshed_job.h"
#include "terrain/geotransform.h"
#include "terrain/grid.h"

namespace sightbound {

struct LayerResult {
  Grid<std::uint8_t> verdict;
  Grid<float> confidence;  // p as HiddenVolume keeps it; NaN where nothing is asked
  Geotransform geotransform;
  std::string crs_wkt;
  double height_m = 0, spacing_m = 0;
  HiddenVolumeInfo info;
  SightEstimate estimate;
  std::vector<std::string> warnings;
};
// Targets at the columns' centres, options.targets.spacing_m apart, `target_height` above the highest of the
// terrain there; HoldsFor::kTarget is all of the column's square at that height. Throws InvalidInput,
// OverBudget, Cancelled.
LayerResult see_layer(const ErrorVolume&, const std::vector<ViewVolume>&, double target_height,
                      const VolumeSightOptions&, Progress&);

struct TargetPoint {
  double x = 0, y = 0;  // CRS
  double height = 0;    // metres, above the highest of the terrain there, or absolute
};
struct TargetsResult {
  std::vector<TargetAnswer> answers;  // one a target, in their order
  SightEstimate estimate;             // seconds left at 0
  std::vector<std::string> warnings;
};
// Targets off the terrain, and such beneath the ground (the lowest face there), have no verdict; a warning
// counts them. Throws InvalidInput (no targets, one that is not finite, none on the terrain), OverBudget,
// Cancelled.
TargetsResult see_targets(const ErrorVolume&, const std::vector<ViewVolume>&, const std::vector<TargetPoint>&,
                          HeightReference, const VolumeSightOptions&, Progress&);

}  // namespace sightbound
