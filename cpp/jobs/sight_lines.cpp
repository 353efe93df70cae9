// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/sight_lines.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/memory_budget.h"
#include "base/number_text.h"
#include "error_model/error_model.h"

namespace sightbound {

namespace {

constexpr std::size_t kBytesOfView = 32 << 10;  // the faces around a view place and its cell, about

void require_lines(const SightEstimate& estimate, double spacing_m, double most) {
  if (estimate.lines <= most) return;
  const bool listed = spacing_m == 0;
  const double fits =
      std::ceil(spacing_m * std::sqrt(estimate.lines / most));  // targets go with 1 / spacing^2
  throw InvalidInput(
      "most_lines is " + number_text(most, 6) + ", but " + number_text(estimate.lines, 6) +
      " lines of sight are needed (" + std::to_string(estimate.view_places) + " view places, " +
      std::to_string(estimate.targets) + " targets" +
      (listed ? "). Fewer targets"
              : " " + number_text(spacing_m, 6) + " m apart). Targets " + number_text(fits, 6) + " m apart") +
      " would fit, or a larger view_spacing, or a larger most_lines.");
}

void require_positive(double value, const char* field) {
  if (value > 0) return;  // false for a NaN
  throw InvalidInput(std::string(field) + " is " + std::to_string(value) + "; it must be more than 0.");
}

}  // namespace

void validate_sight(const VolumeSightOptions& options) {
  two_sided_quantile(options.confidence);  // refuses what is none
  require_positive(options.max_distance, "max_distance");
  require_positive(options.most_lines, "most_lines");
  if (!(options.refraction >= -1 && options.refraction <= 1))
    throw InvalidInput("refraction is " + std::to_string(options.refraction) + "; allowed are -1 to 1.");
}

PlacedViews place_views(const ErrorVolume& volume, const std::vector<ViewVolume>& views,
                        const VolumeSightOptions& options, const SightNeed& need) {
  PlacedViews job;
  job.views =
      view_places(volume.surface(), views, options.height_reference, options.view_spacing, need.spacing_m);
  job.estimate.view_places = job.views.places.size();
  job.estimate.targets = need.targets;
  job.estimate.lines = static_cast<double>(need.targets) * static_cast<double>(job.estimate.view_places);
  require_lines(job.estimate, need.spacing_m, options.most_lines);
  job.estimate.bytes = need.bytes + job.estimate.view_places * kBytesOfView;
  MemoryBudget(options.memory_budget)
      .require(job.estimate.bytes,
               "The answer for " + std::to_string(need.targets) + " targets from " +
                   std::to_string(job.estimate.view_places) + " view places",
               "Give a larger target_spacing or view_spacing, or a lower target_ceiling.");
  return job;
}

VolumeViewshedOptions viewshed_options(const VolumeSightOptions& options) {
  VolumeViewshedOptions used;
  used.confidence = options.confidence;
  used.seen_from = options.seen_from;
  used.holds_for = options.holds_for;
  used.max_distance_m = std::min(options.max_distance, used.max_distance_m);
  return used;
}

}  // namespace sightbound
