// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/dem_to_tin_job.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "base/number_text.h"
#include "base/parallel.h"
#include "io/crs.h"
#include "io/tin_crs.h"
#include "jobs/resolve_error.h"
#include "jobs/tolerance_windows.h"

namespace sightbound {

namespace {

constexpr double kDefaultConfidence = 0.95;

// metres that one sigma_s stands for.
double metres_of(const DemToTinOptions& options, double level, Tails tails) {
  return options.error_means == ErrorMeans::kTolerance ? level : two_sided_quantile(level, tails);
}

double first_level(const DemToTinOptions& options) {
  if (!options.levels.empty()) return options.levels[0];
  return options.error_means == ErrorMeans::kTolerance ? 1 : kDefaultConfidence;
}

std::vector<double> factors_of(const DemToTinOptions& options, Tails tails) {
  const double first = metres_of(options, first_level(options), tails);
  std::vector<double> factors{1};
  for (std::size_t n = 1; n < options.levels.size(); ++n)
    factors.push_back(metres_of(options, options.levels[n], tails) / first);
  return factors;
}

// As edges of the TIN of a window, and how far each may be from them.
void set_break_lines(const DemToTinOptions& options, const DemPlace& place, const Window& window,
                     SimplifyOptions& simplify, std::vector<std::string>& warnings) {
  std::vector<std::vector<Xy>> lines = options.break_lines;
  std::size_t beside = 0;
  for (std::vector<Xy>& line : lines) {
    for (Xy& p : line) p = place.geotransform.to_raster(p.x, p.y);
    beside += line_chains(std::span(&line, 1), window.rows, window.cols).empty() ? 1 : 0;
  }
  simplify.break_lines = line_chains(lines, window.rows, window.cols);
  if (beside > 0) {
    warnings.push_back(std::to_string(beside) + " of " + std::to_string(lines.size()) +
                       " break lines do not cross the DEM; check their CRS.");
  }
  const auto& g = place.geotransform.coefficients();
  const double cell = std::max(std::hypot(g[1], g[4]), std::hypot(g[2], g[5])) * place.metres_per_unit;
  simplify.break_line_tolerance_m = options.break_line_tolerance_m.value_or(cell);
}

constexpr double kMuchForRounding = 0.01;  // of the tolerance

void say_what_stays(DemToTin& result) {
  const double kept = result.levels[0].report.kept_for_rounding_m;
  if (kept > kMuchForRounding * result.least_tolerance_m && result.least_tolerance_m > kLeastSigma) {
    result.warnings.push_back(
        "Rounding takes " + number_text(kept) +
        " m of the tolerance: somewhere the DEM rises absurdly. Make such heights nodata.");
  }
  if (result.least_tolerance_m > kLeastSigma) return;
  result.warnings.push_back(
      (result.largest_tolerance_m > kLeastSigma ? "Some samples count" : std::string("The samples count")) +
      " as exact (tolerance " + number_text(result.least_tolerance_m) +
      " m), and the surface passes through such samples: little can be removed there. Give the accuracy of "
      "the "
      "heights (vertical_rmse), or a tolerance.");
}

void say_what_was_lost(const SimplifyOptions& simplify, DemToTin& result) {
  const std::size_t lost = result.levels[0].report.break_line_edges_lost, all = simplify.break_lines.size();
  if (lost > 0) {
    result.warnings.push_back(std::to_string(lost) + " of " + std::to_string(all) +
                              " cells along the break lines have no terrain; the lines have gaps there.");
  }
}

}  // namespace

DemToTin run_dem_to_tin(const DemSource& source, const ErrorModel& model, const DemToTinOptions& options,
                        Progress& progress) {
  DemToTin result;
  factors_of(options, Tails::kNormal);  // refuses what is no confidence
  model.validate();
  const double metres_per_unit = metres_per_plan_unit(source.crs_wkt());
  const Window window = window_of(options.extent, source);
  const Workers workers(options.threads);

  progress.begin(0.03, 1);
  const ErrorModel completed = complete_model(model, source, result.warnings, progress);
  result.error_model = completed.describe();
  const Tails tails = completed.tails_used();
  result.factors = factors_of(options, tails);
  ToleranceWindows windows(source, window, completed, metres_of(options, first_level(options), tails),
                           options.keep, workers);

  SimplifyOptions simplify;
  simplify.tolerance_m = windows.constant();
  simplify.keep_border = options.keep_border;
  simplify.border_tolerance_m = options.border_tolerance_m;
  simplify.target_faces = options.target.faces;
  simplify.target_bytes = bytes_for(options.target, empty_simplified_tin(horizontal_crs(source.crs_wkt())));
  simplify.threads = options.threads;
  simplify.memory_bytes = options.memory_budget;
  const DemPlace place{source.geotransform().of_window(window), metres_per_unit,
                       horizontal_crs(source.crs_wkt())};
  set_break_lines(options, place, window, simplify, result.warnings);
  progress.begin(0.97, 1);
  result.levels = simplify_dem_levels(windows, place, simplify, result.factors, progress);
  result.least_tolerance_m = windows.least();
  result.largest_tolerance_m = windows.largest();
  const std::vector<std::string> holes = windows.warnings();
  result.warnings.insert(result.warnings.end(), holes.begin(), holes.end());
  const std::vector<std::string> notes = source.notes();  // reading adds to them
  result.warnings.insert(result.warnings.begin(), notes.begin(), notes.end());
  say_what_stays(result);
  say_what_was_lost(simplify, result);
  say_what_is_missed(options.target, simplify.target_bytes, result.levels[0].tin, result.warnings);
  progress.finish();
  return result;
}

}  // namespace sightbound
