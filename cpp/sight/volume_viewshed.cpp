// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/volume_viewshed.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "base/error.h"
#include "error_model/error_model.h"

namespace sightbound {

namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g", value);
  return text;
}

double checked_quantile(const ErrorVolume& volume, double confidence) {
  const double quantile = two_sided_quantile(confidence);
  if (quantile <= volume.largest_ratio()) return quantile;
  throw InvalidInput("confidence is " + number(confidence) + ", more than this volume was built for (" +
                     number(2 * normal_cdf(volume.largest_ratio()) - 1) +
                     "); build it with a larger largest_confidence.");
}

void check_lines(const TargetLattice& targets, std::size_t views, double most) {
  const double lines = lines_of(targets, views);
  if (lines <= most) return;
  // Lines go with 1 / spacing^2.
  throw InvalidInput("The viewshed needs " + number(lines) + " lines (" + number(static_cast<double>(views)) +
                     " view places, targets " + number(targets.spacing_m) + " m apart), more than the " +
                     number(most) + " allowed; targets " +
                     number(std::ceil(targets.spacing_m * std::sqrt(lines / most))) + " m apart would fit.");
}

TargetAnswer answer_of(const RatioInterval& k, double quantile) {
  return {static_cast<float>(proven_probability(k)), verdict_of(k, quantile)};
}

// Better (or worse) of two answers.
TargetAnswer combined(const TargetAnswer& a, const TargetAnswer& b, bool any) {
  if (a.verdict == kNoVerdict) return b;
  if (b.verdict == kNoVerdict) return a;
  return any ? TargetAnswer{std::max(a.p, b.p), std::max(a.verdict, b.verdict)}
             : TargetAnswer{std::min(a.p, b.p), std::min(a.verdict, b.verdict)};
}

}  // namespace

double lines_of(const TargetLattice& targets, std::size_t views) {
  return static_cast<double>(targets.targets()) * static_cast<double>(views);
}

HiddenVolume volume_viewshed(const VolumeSight& sight, const std::vector<Xyz>& views,
                             std::shared_ptr<const TargetLattice> targets,
                             const VolumeViewshedOptions& options, const Workers& workers,
                             Progress& progress) {
  const double quantile = checked_quantile(sight.rays().volume(), options.confidence);
  if (views.empty()) throw InvalidInput("views is empty; give at least one place to look from.");
  check_lines(*targets, views.size(), options.most_lines);
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
          answer = combined(answer, answer_of(sight.ratio(view, target), quantile), any);
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
