// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/volume_viewshed.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/error.h"
#include "error_model/error_model.h"

namespace sightbound {

namespace {

TargetAnswer answer_of(const RatioInterval& k, double quantile) {
  return {static_cast<float>(proven_probability(k)), verdict_of(k, quantile)};
}

}  // namespace

HiddenVolume volume_viewshed(const VolumeSight& sight, const std::vector<Xyz>& views,
                             std::shared_ptr<const TargetLattice> targets,
                             const VolumeViewshedOptions& options, const Workers& workers,
                             Progress& progress) {
  const double quantile = sight.rays().volume().quantile(options.confidence);
  if (views.empty()) throw InvalidInput("views is empty; give at least one place to look from.");
  std::vector<EndZone> zones;
  for (const Xyz& view : views) zones.push_back(sight.zone(view));

  const bool any = options.seen_from == SeenFrom::kAny;
  HiddenVolumeBuilder builder(targets);
  progress.begin(1, static_cast<double>(targets->ny));
  workers.for_each(static_cast<std::size_t>(targets->ny), [&](std::size_t row) {
    const int j = static_cast<int>(row);
    std::vector<TargetAnswer> answers;
    for (int i = 0; i < targets->nx; ++i) {
      const TargetColumn& column = targets->column(i, j);
      if (column.size() == 0) continue;
      progress.check();
      answers.assign(static_cast<std::size_t>(column.size()), TargetAnswer{});
      EndZone target = sight.zone(targets->centre(i, j, column.first));
      for (const EndZone& view : zones) {
        const Xyz &from = view.place(), &to = target.place();
        if (std::hypot(to.x - from.x, to.y - from.y) > options.max_distance_m) continue;
        for (int k = column.first; k <= column.last; ++k) {
          TargetAnswer& answer = answers[static_cast<std::size_t>(k - column.first)];
          // Nothing more to gain.
          if (any && answer.verdict == kVisible && answer.p >= 1) continue;
          if (!any && answer.verdict == kHidden && answer.p <= 0) continue;
          target.move_to_height(targets->height_of(k));
          answer = (any ? better_of : worse_of)(answer, answer_of(sight.ratio(view, target), quantile));
        }
      }
      builder.set_column(i, j, answers);
    }
    progress.advance(1);
  });
  HiddenVolumeInfo info;
  info.confidence = options.confidence;
  HiddenVolume hidden = builder.finish(std::move(info), workers);
  progress.finish();
  return hidden;
}

}  // namespace sightbound
