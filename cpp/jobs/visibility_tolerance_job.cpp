// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/visibility_tolerance_job.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/error.h"
#include "base/memory_budget.h"
#include "base/number_text.h"
#include "base/parallel.h"
#include "error_model/verdict.h"
#include "io/crs.h"
#include "io/tin_crs.h"
#include "jobs/loaded_terrain.h"
#include "jobs/observer_eye.h"
#include "jobs/observer_place.h"
#include "sight/dead_ground.h"

namespace sightbound {

namespace {

// Of the range within which a claim holds: the other half is the target's.
constexpr double kOwnPart = 0.5;

void validate(const std::vector<Observer>& observers, double tolerance_m) {
  if (!(tolerance_m >= 0) || !std::isfinite(tolerance_m))
    throw InvalidInput("tolerance is " + number_text(tolerance_m) + "; give metres, 0 or more.");
  if (observers.empty()) throw InvalidInput("observers is empty; give at least one.");
  for (std::size_t i = 0; i < observers.size(); ++i) {
    if (!(observers[i].target_height >= 0)) {
      throw InvalidInput("target_height is " + number_text(observers[i].target_height) +
                         "; give metres above the ground, 0 or more.");
    }
    validate(observers[i], name_of(observers[i], i));
  }
}

// The least sigma_s of all samples: near its ends a claim rests on theirs alone, and any sample may be one.
double least_sampling(const Scene& scene) {
  const SampleField& sampling = scene.error.sampling;
  if (sampling.is_constant()) return static_cast<double>(sampling.constant());
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < scene.heights.size(); ++n) {
    if (!std::isnan(scene.heights.data()[n]))
      least = std::min(least, static_cast<double>(sampling.values().data()[n]));
  }
  return std::isfinite(least) ? least : 0;
}

float not_above(double metres) {
  const auto rounded = static_cast<float>(metres);
  return static_cast<double>(rounded) > metres ? std::nextafter(rounded, 0.0f) : rounded;
}

// Dead are squares over which lines to targets that rise by the whole tolerance pass below all that hides
// them, although that, and the eye, move by `own_m`.
DeadGround dead_ground(const DemSource& source, const LoadedTerrain& terrain,
                       const Georeference& georeference, const std::vector<Observer>& observers,
                       double tolerance_m, double own_m, const Workers& workers, Progress& progress) {
  DeadGround dead(terrain.scene().heights);
  for (std::size_t i = 0; i < observers.size(); ++i) {
    const Observer& o = observers[i];
    const std::string name = name_of(o, i);
    const GridPlace place = place_on(source, o.x, o.y, name);
    const ObserverFrames frames = frames_of(source, georeference, place, source.window());
    const ObserverEye placed = eye_above(terrain, o, name, place, frames, HeightReference::kGround);
    dead.look_from(terrain.scene(), placed.eye, o.target_height + tolerance_m + own_m, 2 * own_m, workers,
                   progress);
    progress.advance(1);
  }
  return dead;
}

}  // namespace

VisibilityTolerance run_visibility_tolerance(const DemSource& source, const std::vector<Observer>& observers,
                                             const ErrorModel& model, double tolerance_m,
                                             const ViewshedOptions& options, Progress& progress) {
  validate(options);
  validate(observers, tolerance_m);
  metres_per_plan_unit(source.crs_wkt());  // throws for degrees
  ViewshedOptions claims = options;
  claims.ground.reset();
  const Workers workers(options.threads);
  const Georeference georeference = georeference_of(source);
  const Window whole = source.window();
  MemoryBudget(options.memory_budget)
      .require(LoadedTerrain::memory(whole, model, claims).peak + whole.cells() * (sizeof(float) + 1),
               "The views over " + std::to_string(whole.cols) + " x " + std::to_string(whole.rows) + " cells",
               "Give a part of the DEM, or allow a larger memory_budget.");

  VisibilityTolerance result;
  progress.begin(0.1, 1);
  const ErrorModel completed = complete_model(model, source, result.warnings, progress);
  result.error_model = completed.describe();
  progress.begin(0.3, 1);
  const LoadedTerrain terrain(source, georeference, whole, completed, claims, result.warnings, workers,
                              progress);
  const double own =
      std::min(tolerance_m, kOwnPart * two_sided_quantile(options.confidence, completed.tails_used()) *
                                least_sampling(terrain.scene()));
  progress.begin(0.55, static_cast<double>(observers.size()));
  const DeadGround dead =
      dead_ground(source, terrain, georeference, observers, tolerance_m, own, workers, progress);

  result.tolerance = Grid<float>(whole.rows, whole.cols);
  std::vector<int> free(static_cast<std::size_t>(whole.rows));
  workers.for_each(free.size(), [&](std::size_t n) {
    progress.check();
    const int row = static_cast<int>(n);
    for (int col = 0; col < whole.cols; ++col) {
      const bool is_free = dead.holds(row, col);
      result.tolerance.at(row, col) = not_above(is_free ? tolerance_m : own);
      free[n] += is_free;
    }
  });
  for (const int count : free) result.free_share += count;
  result.free_share /= static_cast<double>(result.tolerance.size());
  if (source.flipped()) result.tolerance.flip_rows();
  const std::vector<std::string> notes = source.notes();  // reading adds to them
  result.warnings.insert(result.warnings.begin(), notes.begin(), notes.end());
  progress.finish();
  return result;
}

}  // namespace sightbound
