// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/volume_targets_job.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/number_text.h"
#include "base/parallel.h"
#include "jobs/sight_lines.h"
#include "volume/hidden_places.h"

namespace sightbound {

namespace {

void require_finite(const TargetPoint& target, std::size_t index) {
  const std::string name = "Target " + std::to_string(index + 1);
  if (!std::isfinite(target.x) || !std::isfinite(target.y))
    throw InvalidInput(name + " has a coordinate that is not finite.");
  if (!(std::abs(target.height) <= 1e5)) {
    throw InvalidInput(name + ": height is " + number_text(target.height) +
                       "; allowed are -100000 to 100000 m.");
  }
}

// The targets that can be asked about, and what is told of the others.
struct PlacedTargets {
  std::vector<Xyz> places;           // local metres
  std::vector<std::size_t> indices;  // of the targets
  std::vector<std::string> warnings;
};

PlacedTargets place_targets(const Surface& surface, const std::vector<TargetPoint>& targets,
                            HeightReference reference) {
  if (targets.empty()) throw InvalidInput("targets is empty; give at least one place to look at.");
  PlacedTargets placed;
  std::vector<std::uint32_t> numbers;
  std::size_t off = 0, beneath = 0;
  for (std::size_t n = 0; n < targets.size(); ++n) {
    require_finite(targets[n], n);
    Xyz place = surface.frame().from_crs({targets[n].x, targets[n].y, targets[n].height});
    const TerrainSpan span = terrain_over(surface, place.x, place.y, numbers);
    if (std::isnan(span.highest) || std::isnan(span.ground)) {
      ++off;
      continue;
    }
    if (reference == HeightReference::kGround) place.z = span.highest + targets[n].height;
    if (place.z < span.ground) {
      ++beneath;
      continue;
    }
    placed.places.push_back(place);
    placed.indices.push_back(n);
  }
  const std::string of = " of " + std::to_string(targets.size()) + " targets are ";
  if (off > 0) placed.warnings.push_back(std::to_string(off) + of + "not on the terrain: no verdict.");
  if (beneath > 0)
    placed.warnings.push_back(std::to_string(beneath) + of + "beneath the ground: no verdict.");
  if (off == targets.size()) {
    throw InvalidInput("None of the targets is on the terrain of the volume, the first at (" +
                       number_text(targets[0].x) + ", " + number_text(targets[0].y) +
                       "); give places within it, in its CRS.");
  }
  return placed;
}

}  // namespace

LayerResult see_layer(const ErrorVolume& volume, const std::vector<ViewVolume>& views, double target_height,
                      const VolumeSightOptions& options, Progress& progress) {
  validate_sight(options);
  const Workers workers(options.threads);
  progress.begin(0.05, 1);
  const auto targets =
      layer_above(volume.surface(), options.targets.spacing_m, target_height, workers, progress);
  PlacedViews job =
      place_views(volume, views, options,
                  {targets->targets(), targets->spacing_m, HiddenVolumeBuilder::bytes_needed(*targets)});
  const HiddenVolume seen = volume_viewshed(SightLines(volume, options).sight(), job.views.places, targets,
                                            viewshed_options(options), workers, progress);

  LayerResult found;
  found.verdict = Grid<std::uint8_t>(targets->ny, targets->nx, kNoVerdict);
  found.confidence = Grid<float>(targets->ny, targets->nx, std::numeric_limits<float>::quiet_NaN());
  for (int j = 0; j < targets->ny; ++j) {
    for (int i = 0; i < targets->nx; ++i) {
      const TargetAnswer answer = seen.at(i, j, 0);
      if (answer.verdict == kNoVerdict) continue;
      found.verdict.at(targets->ny - 1 - j, i) = answer.verdict;
      found.confidence.at(targets->ny - 1 - j, i) = answer.p;
    }
  }
  found.geotransform = geotransform_of(*targets);
  found.crs_wkt = targets->frame.crs_wkt;
  found.height_m = target_height;
  found.spacing_m = targets->spacing_m;
  found.info.confidence = options.confidence;
  found.info.observers = std::move(job.views.as_json);
  found.info.error_model = volume.error_model();
  found.estimate = job.estimate;
  found.warnings = std::move(job.views.warnings);
  return found;
}

TargetsResult see_targets(const ErrorVolume& volume, const std::vector<ViewVolume>& views,
                          const std::vector<TargetPoint>& targets, HeightReference reference,
                          const VolumeSightOptions& options, Progress& progress) {
  validate_sight(options);
  const Workers workers(options.threads);
  PlacedTargets placed = place_targets(volume.surface(), targets, reference);
  PlacedViews job =
      place_views(volume, views, options, {placed.places.size(), 0, targets.size() * sizeof(TargetAnswer)});
  const std::vector<TargetAnswer> seen =
      see_places(SightLines(volume, options).sight(), job.views.places, placed.places,
                 viewshed_options(options), workers, progress);

  TargetsResult found{std::vector<TargetAnswer>(targets.size()), job.estimate, std::move(job.views.warnings)};
  for (std::size_t n = 0; n < seen.size(); ++n) found.answers[placed.indices[n]] = seen[n];
  found.warnings.insert(found.warnings.end(), placed.warnings.begin(), placed.warnings.end());
  return found;
}

}  // namespace sightbound
