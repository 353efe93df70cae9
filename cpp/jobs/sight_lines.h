// SPDX-License-Identifier: GPL-3.0-or-later
// What the jobs of sight in a volume have in common: views placed, lines and memory asked for, the volume
// made ready. Internal to jobs.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "jobs/volume_viewshed_job.h"
#include "sight/volume_sight.h"

namespace sightbound {

// Throws InvalidInput for what no job of sight takes.
void validate_sight(const VolumeSightOptions&);

struct SightNeed {
  std::size_t targets = 0;
  double spacing_m = 0;   // between them; 0 = they were listed
  std::size_t bytes = 0;  // of the answer, while it is made
};
// The views placed, and the estimate but for its seconds. Throws InvalidInput (views, too many lines),
// OverBudget.
struct PlacedViews {
  ViewPlaces views;
  SightEstimate estimate;
};
PlacedViews place_views(const ErrorVolume&, const std::vector<ViewVolume>&, const VolumeSightOptions&,
                        const SightNeed&);

// The volume made ready for lines. Keeps a reference.
class SightLines {
 public:
  SightLines(const ErrorVolume& volume, const VolumeSightOptions& options)
      : rays_(volume),
        sight_(rays_, options.curvature ? ground_bend(volume.surface(), options.refraction) : GroundBend{}) {}

  const VolumeSight& sight() const { return sight_; }

 private:
  VolumeRays rays_;
  VolumeSight sight_;
};

VolumeViewshedOptions viewshed_options(const VolumeSightOptions&);

}  // namespace sightbound
