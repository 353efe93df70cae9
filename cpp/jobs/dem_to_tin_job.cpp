// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/dem_to_tin_job.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/memory_budget.h"
#include "base/number_text.h"
#include "base/parallel.h"
#include "io/crs.h"
#include "io/tin_crs.h"
#include "jobs/resolve_error.h"

namespace sightbound {

namespace {

// metres that one sigma_s stands for.
double factor_of(const DemToTinOptions& options) {
  return options.error_means == ErrorMeans::kTolerance ? 1 : two_sided_quantile(options.confidence);
}

// sigma_s becomes the tolerance of each sample, or of all.
void set_tolerance(SampleField sampling, double factor, const Grid<float>& heights, SimplifyOptions& options,
                   DemToTin& result) {
  if (sampling.is_constant()) {
    options.tolerance_m = factor * static_cast<double>(sampling.constant());
    result.least_tolerance_m = result.largest_tolerance_m = options.tolerance_m;
    return;
  }
  options.tolerance = sampling.release();
  double least = std::numeric_limits<double>::infinity(), largest = 0;
  for (std::size_t n = 0; n < heights.size(); ++n) {
    float& tolerance = options.tolerance.data()[n];
    tolerance = static_cast<float>(factor * static_cast<double>(tolerance));
    if (std::isnan(heights.data()[n])) continue;
    least = std::min(least, static_cast<double>(tolerance));
    largest = std::max(largest, static_cast<double>(tolerance));
  }
  result.least_tolerance_m = std::min(least, largest);
  result.largest_tolerance_m = largest;
}

// The window's part.
Grid<std::uint8_t> kept_in(const Window& window, const DemSource& source, const SharedGrid& keep) {
  if (!keep) return {};
  if (keep->rows() != source.rows() || keep->cols() != source.cols()) {
    throw InvalidInput("keep has " + std::to_string(keep->rows()) + " x " + std::to_string(keep->cols()) +
                       " values, the DEM " + std::to_string(source.rows()) + " x " +
                       std::to_string(source.cols()) + "; give one for each cell.");
  }
  Grid<std::uint8_t> kept(window.rows, window.cols);
  for (int r = 0; r < window.rows; ++r) {
    for (int c = 0; c < window.cols; ++c) kept.at(r, c) = keep->at(window.row + r, window.col + c) > 0;
  }
  return kept;
}

constexpr double kMuchForRounding = 0.01;  // of the tolerance

void say_what_stays(DemToTin& result) {
  const double kept = result.simplified.report.kept_for_rounding_m;
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

}  // namespace

DemToTin run_dem_to_tin(const DemSource& source, const ErrorModel& model, const DemToTinOptions& options,
                        Progress& progress) {
  const double factor = factor_of(options);
  model.validate();
  const double metres_per_unit = metres_per_plan_unit(source.crs_wkt());
  const Window window = window_of(options.extent, source);
  const Workers workers(options.threads);
  MemoryBudget(options.memory_budget)
      .require(window.cells() * sizeof(float) + resolve_error_memory(model, window).peak,
               "A DEM of " + std::to_string(window.cols) + " x " + std::to_string(window.rows) + " samples",
               "Give a smaller extent, or a larger memory budget.");

  DemToTin result;
  progress.begin(0.03, 1);
  const ErrorModel completed = complete_model(model, source, result.warnings, progress);
  progress.begin(0.03, static_cast<double>(window.cells()));
  Grid<float> heights = source.read(window, progress);
  progress.begin(0.04, 1);
  ErrorField error = resolve_error(completed, source, georeference_of(source), window, heights,
                                   result.warnings, workers, progress);
  result.error_model = completed.describe();

  SimplifyOptions simplify;
  simplify.keep = kept_in(window, source, options.keep);
  simplify.keep_border = options.keep_border;
  simplify.target_faces = options.target_faces;
  simplify.threads = options.threads;
  simplify.memory_bytes = options.memory_budget;
  set_tolerance(std::move(error.sampling), factor, heights, simplify, result);
  const DemTerrain terrain{heights, source.geotransform().of_window(window), metres_per_unit,
                           horizontal_crs(source.crs_wkt())};
  progress.begin(0.9, 1);
  result.simplified = simplify_dem(terrain, simplify, progress);
  const std::vector<std::string> notes = source.notes();  // reading adds to them
  result.warnings.insert(result.warnings.begin(), notes.begin(), notes.end());
  say_what_stays(result);
  progress.finish();
  return result;
}

}  // namespace sightbound
