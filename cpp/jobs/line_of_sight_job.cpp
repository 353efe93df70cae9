// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/line_of_sight_job.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/memory_budget.h"
#include "io/crs.h"
#include "jobs/loaded_terrain.h"
#include "jobs/observer_place.h"
#include "sight/confidence.h"
#include "sight/sight_line.h"

namespace sightbound {

namespace {

struct Pair {
  std::string observer_name, target_name;
  GridPlace observer, target;
  Window lines;  // whole raster
  ObserverFrame frame;
};

Pair place_pair(const DemSource& source, const Georeference& georeference, const Observer& o,
                const LineOfSightTarget& t, std::size_t index) {
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
  return {name, target_name, from, to, lines, std::move(frame)};
}

double height_at(const Grid<float>& ground, const GridPlace& place, const Window& window,
                 const std::string& name) {
  const double height = interpolate(ground, place.whole_col() - window.col, place.whole_row() - window.row);
  if (std::isnan(height))
    throw InvalidInput(name +
                       " stands where the DEM has no height (nodata). Move it, or fill the hole first.");
  return height;
}

SightProfile profile_of(const SightLine& line, const DemSource& source, const GridPlace& base) {
  std::vector<JudgedPlace> places;
  line.for_each_place([&](const JudgedPlace& place) { places.push_back(place); });
  std::sort(places.begin(), places.end(),
            [](const JudgedPlace& a, const JudgedPlace& b) { return a.share < b.share; });
  SightProfile profile;
  for (const JudgedPlace& place : places) {
    const Xy at = source.geotransform().of_sample(base.base_col + line.col(place.xi),
                                                  base.base_row + line.row(place.xi));
    profile.distance.push_back(place.share * line.distance());
    profile.x.push_back(at.x);
    profile.y.push_back(at.y);
    profile.ground.push_back(place.ground);
    profile.sigma.push_back(place.sigma);
    profile.line.push_back(place.line);
    profile.clearance.push_back((place.line - place.ground) / place.sigma);
  }
  return profile;
}

LineOfSight judge(const DemSource& source, const Observer& o, const Pair& pair, const LoadedTerrain& terrain,
                  const ViewshedOptions& options) {
  const Window& window = terrain.window();
  const Scene& scene = terrain.scene();
  const bool absolute = options.height_reference == HeightReference::kAbsolute;
  const auto sampling = [&](const GridPlace& place) {
    const SampleField& field = scene.error.sampling;
    return field.is_constant()
               ? static_cast<double>(field.constant())
               : interpolate(field.values(), place.whole_col() - window.col, place.whole_row() - window.row);
  };
  LineOfSight out;
  out.observer_ground = height_at(terrain.ground(), pair.observer, window, pair.observer_name);
  out.target_ground = height_at(terrain.ground(), pair.target, window, pair.target_name);
  height_at(scene.heights, pair.observer, window, pair.observer_name);
  height_at(scene.heights, pair.target, window, pair.target_name);
  out.eye_height = absolute ? o.height : out.observer_ground + o.height;
  out.target_top = absolute ? o.target_height : out.target_ground + o.target_height;

  const Eye eye{&pair.frame, pair.observer.base_col - window.col, pair.observer.base_row - window.row,
                out.eye_height, sampling(pair.observer)};
  const Target target{pair.target.base_col - pair.observer.base_col + pair.target.col,
                      pair.target.base_row - pair.observer.base_row + pair.target.row, out.target_top,
                      sampling(pair.target)};
  const SightLine line(scene, eye, target);
  const Critical critical = line.settle();
  out.k = critical.k;
  out.p = static_cast<double>(probability(scene, critical.k));
  out.verdict = verdict(scene, critical.k);
  out.distance = line.distance();
  out.azimuth = line.azimuth_deg();
  out.profile = profile_of(line, source, pair.observer);

  // The place that decides: where the clearance is least; unknown ground when that holds k* down.
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  out.critical_x = out.critical_y = out.critical_distance = kNan;
  const SightProfile& p = out.profile;
  std::optional<std::size_t> least, unknown;
  for (std::size_t i = 0; i < p.clearance.size(); ++i) {
    if (std::isnan(p.ground[i])) {
      if (!unknown) unknown = i;
    } else if (!least || p.clearance[i] < p.clearance[*least]) {
      least = i;
    }
  }
  const std::optional<std::size_t> decisive = critical.hole ? unknown : least;
  if (decisive) {
    out.critical_x = p.x[*decisive];
    out.critical_y = p.y[*decisive];
    out.critical_distance = p.distance[*decisive];
  }
  const double certain = line.needed_height(scene.quantile, out.target_ground),
               likely = line.needed_height(0, out.target_ground);
  out.required_height = std::isinf(certain) ? kNan : certain - out.target_ground;
  out.likely_height = std::isinf(likely) ? kNan : likely - out.target_ground;
  return out;
}

}  // namespace

std::vector<LineOfSight> run_lines_of_sight(const DemSource& source, const std::vector<Observer>& observers,
                                            const std::vector<LineOfSightTarget>& targets,
                                            const ErrorModel& model, const ViewshedOptions& options,
                                            Progress& progress) {
  validate(options);
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

  std::vector<Pair> pairs;
  Window all;
  std::size_t cells = 0, largest = 0;
  for (std::size_t i = 0; i < observers.size(); ++i) {
    pairs.push_back(place_pair(source, georeference, observers[i], targets[i], i));
    all = bounding(all, pairs.back().lines);
    cells += pairs.back().lines.cells();
    largest = std::max(largest, LoadedTerrain::memory(pairs.back().lines, model, options).peak);
    progress.check();
  }
  constexpr std::size_t kWorthwhile = 4;  // lines that cross the same ground are read once
  const std::size_t together_bytes = LoadedTerrain::memory(all, model, options).peak;
  const bool together = all.cells() <= kWorthwhile * cells && together_bytes <= budget.bytes();
  budget.require(together ? together_bytes : largest, "The longest line of sight",
                 "Allow a larger memory_budget.");

  progress.begin(0.2, 1);
  const ErrorModel completed = complete_model(model, source, warnings, progress);
  progress.begin(0.78, static_cast<double>(std::max<std::size_t>(pairs.size(), 1)));
  std::unique_ptr<LoadedTerrain> terrain;
  if (together && !pairs.empty()) {
    terrain = std::make_unique<LoadedTerrain>(source, georeference, all, completed, options, warnings,
                                              workers, progress);
  }
  std::vector<LineOfSight> lines;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!together) {
      terrain.reset();
      terrain = std::make_unique<LoadedTerrain>(source, georeference, pairs[i].lines, completed, options,
                                                warnings, workers, progress);
    }
    lines.push_back(judge(source, observers[i], pairs[i], *terrain, options));
    progress.advance(1);
  }
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
                              const ViewshedOptions& options, Progress& progress) {
  return std::move(run_lines_of_sight(source, {observer}, {target}, model, options, progress).front());
}

}  // namespace sightbound
