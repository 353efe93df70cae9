// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/dem_to_tin_job.h"

#include <cmath>

#include "base/error.h"
#include "base/number_text.h"
#include "base/parallel.h"
#include "io/crs.h"
#include "io/tin_crs.h"
#include "io/tin_writer.h"
#include "jobs/resolve_error.h"
#include "jobs/tolerance_windows.h"

namespace sightbound {

namespace {

// metres that one sigma_s stands for.
double factor_of(const DemToTinOptions& options) {
  return options.error_means == ErrorMeans::kTolerance ? 1 : two_sided_quantile(options.confidence);
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

// What is left for vertices and faces.
SimplifyOptions::Bytes bytes_for(const DemToTinOptions& options, const DemSource& source) {
  const TinFileSize size = tin_file_size(options.target_ending, horizontal_crs(source.crs_wkt()));
  const double most = options.target_bytes - size.fixed;
  if (!(most > 0) || !std::isfinite(most)) {
    throw InvalidInput("target_bytes is " + number_text(options.target_bytes) + "; a file that ends in '" +
                       options.target_ending + "' takes more than " + number_text(size.fixed) + " bytes.");
  }
  return {most, size.of_vertex, size.of_face};
}

void say_what_it_takes(const SimplifyOptions::Bytes& target, DemToTin& result) {
  const Tin& tin = result.simplified.tin;
  const double bytes = target.of_vertex * static_cast<double>(tin.vertices.size()) +
                       target.of_face * static_cast<double>(tin.faces.size());
  if (bytes <= target.most) return;
  result.warnings.push_back("The file will have some " + number_text(bytes - target.most) +
                            " bytes more than target_bytes: the tolerance lets no more triangles go.");
}

}  // namespace

DemToTin run_dem_to_tin(const DemSource& source, const ErrorModel& model, const DemToTinOptions& options,
                        Progress& progress) {
  const double factor = factor_of(options);
  model.validate();
  const double metres_per_unit = metres_per_plan_unit(source.crs_wkt());
  const Window window = window_of(options.extent, source);
  const Workers workers(options.threads);

  DemToTin result;
  progress.begin(0.03, 1);
  const ErrorModel completed = complete_model(model, source, result.warnings, progress);
  result.error_model = completed.describe();
  ToleranceWindows windows(source, window, completed, factor, options.keep, workers);

  SimplifyOptions simplify;
  simplify.tolerance_m = windows.constant();
  simplify.keep_border = options.keep_border;
  simplify.target_faces = options.target_faces;
  if (options.target_bytes != 0) simplify.target_bytes = bytes_for(options, source);
  simplify.threads = options.threads;
  simplify.memory_bytes = options.memory_budget;
  const DemPlace place{source.geotransform().of_window(window), metres_per_unit,
                       horizontal_crs(source.crs_wkt())};
  progress.begin(0.97, 1);
  result.simplified = simplify_dem(windows, place, simplify, progress);
  result.least_tolerance_m = windows.least();
  result.largest_tolerance_m = windows.largest();
  const std::vector<std::string> holes = windows.warnings();
  result.warnings.insert(result.warnings.end(), holes.begin(), holes.end());
  const std::vector<std::string> notes = source.notes();  // reading adds to them
  result.warnings.insert(result.warnings.begin(), notes.begin(), notes.end());
  say_what_stays(result);
  if (options.target_bytes != 0) say_what_it_takes(simplify.target_bytes, result);
  progress.finish();
  return result;
}

}  // namespace sightbound
