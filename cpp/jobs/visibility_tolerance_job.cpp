// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/visibility_tolerance_job.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "base/error.h"
#include "base/memory_budget.h"
#include "base/number_text.h"
#include "base/parallel.h"
#include "error_model/verdict.h"
#include "io/crs.h"
#include "jobs/resolve_error.h"

namespace sightbound {

namespace {

// Of the range within which a claim holds: the other half is the target's.
constexpr double kOwnPart = 0.5;

// Asked about every sample, whatever else they are asked about: what lies on the way hides, too.
std::vector<Observer> with_targets_raised(const std::vector<Observer>& observers, double metres) {
  std::vector<Observer> raised;
  for (const Observer& o : observers) {
    if (!(o.target_height >= 0)) {
      throw InvalidInput("target_height is " + number_text(o.target_height) +
                         "; give metres above the ground, 0 or more.");
    }
    Observer all;
    all.x = o.x, all.y = o.y, all.height = o.height, all.name = o.name, all.number = o.number;
    all.target_height = o.target_height + metres;
    raised.push_back(std::move(all));
  }
  return raised;
}

ViewshedOptions of_claims(const ViewshedOptions& given) {
  ViewshedOptions options;
  options.confidence = given.confidence;
  options.refraction = given.refraction;
  options.curvature = given.curvature;
  options.threads = given.threads;
  options.memory_budget = given.memory_budget;
  options.stand = Stand::kGround;
  return options;
}

// The least sigma_s of all samples: near its ends a claim rests on theirs alone, and any sample may be one.
double least_sampling(const ErrorModel& completed, const DemSource& source, const MemoryBudget& budget,
                      const Workers& workers, Progress& progress) {
  const double* everywhere = std::get_if<double>(&completed.vertical_rmse);
  if (everywhere != nullptr && !(completed.horizontal_rmse > 0)) return *everywhere;
  const Window whole{0, 0, source.cols(), source.rows()};
  budget.require(whole.cells() * sizeof(float) + resolve_error_memory(completed, whole).peak,
                 "The error of " + std::to_string(whole.cols) + " x " + std::to_string(whole.rows) + " cells",
                 "Give a part of the DEM, or allow a larger memory_budget.");
  Grid<float> heights = source.read(whole, progress);
  std::vector<std::string> said_by_the_viewshed_too;
  const ErrorField error = resolve_error(completed, source, georeference_of(source), whole, heights,
                                         said_by_the_viewshed_too, workers, progress);
  if (error.sampling.is_constant()) return static_cast<double>(error.sampling.constant());
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < heights.size(); ++n) {
    if (!std::isnan(heights.data()[n]))
      least = std::min(least, static_cast<double>(error.sampling.values().data()[n]));
  }
  return std::isfinite(least) ? least : 0;
}

// Is nothing seen of a sample and its neighbours? Where there is no terrain nothing is.
bool is_free(const Grid<std::uint8_t>& verdict, int row, int col) {
  for (int r = std::max(row - 1, 0); r <= std::min(row + 1, verdict.rows() - 1); ++r) {
    for (int c = std::max(col - 1, 0); c <= std::min(col + 1, verdict.cols() - 1); ++c) {
      const std::uint8_t claim = verdict.at(r, c);
      if (claim != kHidden && claim != kNoVerdict) return false;
    }
  }
  return true;
}

}  // namespace

VisibilityTolerance run_visibility_tolerance(const DemSource& source, const std::vector<Observer>& observers,
                                             const ErrorModel& model, double tolerance_m,
                                             const ViewshedOptions& options, Progress& progress) {
  if (!(tolerance_m >= 0) || !std::isfinite(tolerance_m))
    throw InvalidInput("tolerance is " + number_text(tolerance_m) + "; give metres, 0 or more.");
  VisibilityTolerance result;
  const Workers workers(options.threads);
  const ErrorModel completed = complete_model(model, source, result.warnings, progress);
  result.error_model = completed.describe();
  const double own =
      kOwnPart * two_sided_quantile(options.confidence) *
      least_sampling(completed, source, MemoryBudget(options.memory_budget), workers, progress);
  const ViewshedResult seen = run_viewshed(source, with_targets_raised(observers, tolerance_m), completed,
                                           of_claims(options), progress);
  result.tolerance = Grid<float>(source.rows(), source.cols());
  std::vector<int> free(static_cast<std::size_t>(source.rows()));
  workers.for_each(free.size(), [&](std::size_t n) {
    progress.check();
    const int row = static_cast<int>(n);
    for (int col = 0; col < source.cols(); ++col) {
      const bool whole_tolerance = is_free(seen.verdict, row, col);
      result.tolerance.at(row, col) =
          static_cast<float>(whole_tolerance ? tolerance_m : std::min(tolerance_m, own));
      free[n] += whole_tolerance;
    }
  });
  for (const int count : free) result.free_share += count;
  result.free_share /= static_cast<double>(result.tolerance.size());
  result.warnings.insert(result.warnings.end(), seen.report.warnings.begin(), seen.report.warnings.end());
  return result;
}

}  // namespace sightbound
