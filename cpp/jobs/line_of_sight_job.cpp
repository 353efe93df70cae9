// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/line_of_sight_job.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/memory_budget.h"
#include "base/number_text.h"
#include "io/crs.h"
#include "jobs/line_judge.h"
#include "jobs/loaded_terrain.h"
#include "jobs/observer_place.h"
#include "jobs/observer_posts.h"

namespace sightbound {

namespace {

constexpr int kMostRealisations = 65535;
constexpr double kLowest_mhz = 1, kHighest_mhz = 1e6;  // longer waves bend round hills; light has no zone

struct Pair {
  std::string observer_name, target_name;
  LineEnd observer, target;
  Window lines;  // whole raster
  ObserverFrame frame;
};

Pair place_pair(const DemSource& source, const Georeference& georeference, const Observer& o,
                const LineOfSightTarget& t, std::size_t index, const LineExtras& extras) {
  const std::string name = name_of(o, index), target_name = "Target " + std::to_string(index + 1);
  validate(o, name);
  if (!std::isfinite(t.x) || !std::isfinite(t.y))
    throw InvalidInput(target_name + " has a coordinate that is not a number.");
  const GridPlace from = place_on(source, o.x, o.y, name), to = place_on(source, t.x, t.y, target_name);
  const Window ends = bounding({from.base_col, from.base_row, 2, 2}, {to.base_col, to.base_row, 2, 2});
  // A frame about both ends, the same whichever of them is the observer.
  const Window reach =
      intersection({ends.col - 2, ends.row - 2, ends.cols + 4, ends.rows + 4}, source.window());
  ObserverFrame frame = frame_of(georeference, from, reach);
  const Window lines = lines_window(source, frame, from, intersection(ends, source.window()));
  return {name,
          target_name,
          {from, o.height},
          {to, o.target_height},
          window_for(lines, extras, source),
          std::move(frame)};
}

// Pairs over terrain in memory.
class Judging {
 public:
  Judging(const DemSource& source, const Georeference& georeference, const ErrorModel& model,
          const ViewshedOptions& options, const LineExtras& extras, std::vector<std::string>& warnings,
          const Workers& workers, Progress& progress)
      : source_(source),
        georeference_(georeference),
        model_(model),
        options_(options),
        extras_(extras),
        warnings_(warnings),
        workers_(workers),
        progress_(progress) {}

  std::vector<LineOfSight> together(const std::vector<Pair>& pairs, const Window& window) const {
    const LoadedTerrain terrain(source_, georeference_, window, model_, options_, warnings_, workers_,
                                progress_);
    const LineJudge judge(source_, terrain, options_, extras_, workers_, progress_);
    for (const Pair& pair : pairs) require_ground(judge, pair);
    std::vector<LineOfSight> lines(pairs.size());
    workers_.for_each(pairs.size(), [&](std::size_t i) {
      lines[i] = judge.judge(pairs[i].observer, pairs[i].target, pairs[i].frame, nullptr, true);
      progress_.advance(1);
    });
    return lines;
  }

  std::vector<LineOfSight> one_by_one(const std::vector<Pair>& pairs) const {
    std::vector<LineOfSight> lines;
    for (const Pair& pair : pairs) {
      const LoadedTerrain terrain(source_, georeference_, pair.lines, model_, options_, warnings_, workers_,
                                  progress_);
      const LineJudge judge(source_, terrain, options_, extras_, workers_, progress_);
      require_ground(judge, pair);
      lines.push_back(judge.judge(pair.observer, pair.target, pair.frame, nullptr, true));
      progress_.advance(1);
    }
    return lines;
  }

 private:
  static void require_ground(const LineJudge& judge, const Pair& pair) {
    for (const auto& [name, end] :
         {std::pair{&pair.observer_name, &pair.observer}, {&pair.target_name, &pair.target}}) {
      if (judge.has_ground(end->place)) continue;
      throw InvalidInput(*name +
                         " stands where the DEM has no height (nodata). Move it, or fill the hole first.");
    }
  }

  const DemSource& source_;
  const Georeference& georeference_;
  const ErrorModel& model_;
  const ViewshedOptions& options_;
  const LineExtras& extras_;
  std::vector<std::string>& warnings_;
  const Workers& workers_;
  Progress& progress_;
};

}  // namespace

void validate(const LineExtras& extras) {
  if (extras.whole_line &&
      (extras.whole_line->realisations < 1 || extras.whole_line->realisations > kMostRealisations)) {
    throw InvalidInput("realisations is " + std::to_string(extras.whole_line->realisations) + "; give 1 to " +
                       std::to_string(kMostRealisations) + ".");
  }
  if (!extras.radio) return;
  const double frequency = extras.radio->frequency_mhz, share = extras.radio->zone_share;
  if (!(frequency >= kLowest_mhz && frequency <= kHighest_mhz)) {
    throw InvalidInput("frequency is " + number_text(frequency) +
                       "; it must be between 1 and 1000000 MHz (1 GHz is 1000).");
  }
  if (!(share >= 0 && share <= 1)) {
    throw InvalidInput("fresnel_share is " + number_text(share) +
                       "; it must be between 0 and 1 (usual: 0.6 of the zone's radius).");
  }
}

std::vector<LineOfSight> run_lines_of_sight(const DemSource& source, const std::vector<Observer>& observers,
                                            const std::vector<LineOfSightTarget>& targets,
                                            const ErrorModel& model, const ViewshedOptions& options,
                                            const LineExtras& extras, Progress& progress) {
  validate(options);
  validate(extras);
  model.validate();
  if (observers.size() != targets.size()) {
    throw InvalidInput("There are " + std::to_string(observers.size()) + " observers and " +
                       std::to_string(targets.size()) +
                       " targets; lines of sight need as many of one as of the other.");
  }
  const MemoryBudget budget(options.memory_budget);
  const Workers workers(options.threads);
  const Georeference georeference = georeference_of(source);
  std::vector<std::string> warnings;

  const auto bytes = [&](const Window& window) {
    return LoadedTerrain::memory(window, model, options).peak + LineJudge::memory(window, extras);
  };
  std::vector<Pair> pairs;
  Window all;
  std::size_t cells = 0, largest = 0;
  for (std::size_t i = 0; i < observers.size(); ++i) {
    pairs.push_back(place_pair(source, georeference, observers[i], targets[i], i, extras));
    all = bounding(all, pairs.back().lines);
    cells += pairs.back().lines.cells();
    largest = std::max(largest, bytes(pairs.back().lines));
    progress.check();
  }
  constexpr std::size_t kWorthwhile = 4;  // lines that cross the same ground are read once
  const std::size_t together_bytes = bytes(all);
  const bool together = all.cells() <= kWorthwhile * cells && together_bytes <= budget.bytes();
  budget.require(together ? together_bytes : largest, "The longest line of sight",
                 "Allow a larger memory_budget.");

  progress.begin(0.2, 1);
  const ErrorModel completed = complete_model(model, source, warnings, progress);
  progress.begin(0.78, static_cast<double>(std::max<std::size_t>(pairs.size(), 1)));
  const Judging judging(source, georeference, completed, options, extras, warnings, workers, progress);
  std::vector<LineOfSight> lines;
  if (!pairs.empty()) lines = together ? judging.together(pairs, all) : judging.one_by_one(pairs);
  const std::vector<std::string> notes = source.notes();  // reading adds to them
  warnings.insert(warnings.begin(), notes.begin(), notes.end());
  for (LineOfSight& line : lines) {
    line.error_model = completed.describe();
    line.warnings = warnings;
  }
  progress.finish();
  return lines;
}

LineOfSight run_line_of_sight(const DemSource& source, const Observer& observer,
                              const LineOfSightTarget& target, const ErrorModel& model,
                              const ViewshedOptions& options, const LineExtras& extras, Progress& progress) {
  return std::move(
      run_lines_of_sight(source, {observer}, {target}, model, options, extras, progress).front());
}

}  // namespace sightbound
