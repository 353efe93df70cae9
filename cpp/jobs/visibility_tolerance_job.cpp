// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/visibility_tolerance_job.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/number_text.h"
#include "base/parallel.h"
#include "error_model/verdict.h"
#include "io/crs.h"
#include "jobs/resolve_error.h"

namespace sightbound {

namespace {

// Of the range within which a claim holds: the other half is the target's.
constexpr double kOwnPart = 0.5;

std::vector<Observer> with_targets_raised(std::vector<Observer> observers, double metres) {
  for (Observer& o : observers) o.target_height += metres;
  return observers;
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

SampleField sampling_error(const ErrorModel& completed, const DemSource& source, const Workers& workers,
                           Progress& progress) {
  const Window whole{0, 0, source.cols(), source.rows()};
  Grid<float> heights = source.read(whole, progress);
  std::vector<std::string> said_by_the_viewshed;
  return resolve_error(completed, source, georeference_of(source), whole, heights, said_by_the_viewshed,
                       workers, progress)
      .sampling;
}

// Is nothing seen, or asked, at a sample and at its neighbours?
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
  const SampleField sampling = sampling_error(completed, source, workers, progress);
  const ViewshedResult seen = run_viewshed(source, with_targets_raised(observers, tolerance_m), completed,
                                           of_claims(options), progress);
  const double range = two_sided_quantile(options.confidence);
  result.tolerance = Grid<float>(source.rows(), source.cols());
  std::vector<int> free(static_cast<std::size_t>(source.rows()));
  workers.for_each(free.size(), [&](std::size_t n) {
    progress.check();
    const int row = static_cast<int>(n), in_core = source.flipped() ? source.rows() - 1 - row : row;
    for (int col = 0; col < source.cols(); ++col) {
      const bool whole_tolerance = is_free(seen.verdict, row, col);
      const double own = kOwnPart * range * static_cast<double>(sampling.at(in_core, col));
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
