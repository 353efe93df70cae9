// SPDX-License-Identifier: GPL-3.0-or-later
// Method. Read, resolve, then one pass that turns the heights into the lower surface in place.
#include "jobs/error_surfaces_job.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/memory_budget.h"
#include "base/parallel.h"
#include "io/crs.h"
#include "jobs/resolve_error.h"

namespace sightbound {

namespace {

// The nearest float that is not below, not above.
float at_least(double value) {
  const auto rounded = static_cast<float>(value);
  return rounded < value ? std::nextafter(rounded, std::numeric_limits<float>::infinity()) : rounded;
}

float at_most(double value) { return -at_least(-value); }

void bound_row(const ErrorField& field, double z_of_confidence, int r, ErrorSurfaces& out) {
  const bool by_amplitude = field.profile.shape == GeologicShape::kGaussian && field.profile.range_m == 0;
  const bool varies = by_amplitude && !field.amplitude.is_constant();
  const double of_row = field.largest_profile(r, field.amplitude.constant());
  float *lower = out.lower.row(r), *upper = out.upper.row(r), *sigma = out.sigma.row(r);
  for (int c = 0; c < out.lower.cols(); ++c) {
    const double height = lower[c];  // still the height
    if (std::isnan(height)) {
      sigma[c] = upper[c] = lower[c];
      continue;
    }
    const double amplitude = field.amplitude.at(r, c);
    const double share = varies ? field.largest_profile(r, amplitude) : of_row;
    const double total = std::max(field.sampling.at(r, c) + amplitude * share, kLeastSigma);  // equation 3.5
    sigma[c] = at_least(total);
    lower[c] = at_most(height - z_of_confidence * total);
    upper[c] = at_least(height + z_of_confidence * total);
  }
}

std::size_t planned_memory(const ErrorModel& model, const Window& window) {
  const ResolveMemory error = resolve_error_memory(model, window);
  const std::size_t grid = window.cells() * sizeof(float);
  return grid + std::max(error.peak, error.kept + 2 * grid);
}

}  // namespace

ErrorSurfaces run_error_surfaces(const DemSource& source, const ErrorModel& model,
                                 const ErrorSurfacesOptions& options, Progress& progress) {
  two_sided_quantile(options.confidence);  // refuses what is none
  model.validate();
  const Window window = window_of(options.extent, source);
  const Georeference georeference = georeference_of(source);
  const Workers workers(options.threads);
  const auto cells = static_cast<double>(window.cells());

  ErrorSurfaces out;
  out.memory_bytes = planned_memory(model, window);
  MemoryBudget(options.memory_budget)
      .require(out.memory_bytes,
               "The error of " + std::to_string(window.cols) + " x " + std::to_string(window.rows) + " cells",
               "Give a smaller extent, or a larger memory budget.");

  progress.begin(0.1, 1);
  const ErrorModel completed = complete_model(model, source, out.warnings, progress);
  const double z = two_sided_quantile(options.confidence, completed.tails_used());
  progress.begin(0.4, cells);
  out.lower = source.read(window, progress);
  progress.begin(0.3, 1);
  const ErrorField field =
      resolve_error(completed, source, georeference, window, out.lower, out.warnings, workers, progress);

  take_bias_off(completed, out.lower, workers);
  progress.begin(0.2, cells);
  out.sigma = Grid<float>(window.rows, window.cols);
  out.upper = Grid<float>(window.rows, window.cols);
  workers.for_each(static_cast<std::size_t>(window.rows), [&](std::size_t r) {
    bound_row(field, z, static_cast<int>(r), out);
    progress.advance(window.cols);
  });

  if (source.flipped()) {
    for (Grid<float>* grid : {&out.sigma, &out.lower, &out.upper}) grid->flip_rows();
  }
  out.geotransform = delivered_geotransform(source, window);
  out.crs_wkt = source.crs_wkt();
  out.error_model = completed.describe();
  const std::vector<std::string> notes = source.notes();  // reading adds to them
  out.warnings.insert(out.warnings.begin(), notes.begin(), notes.end());
  progress.finish();
  return out;
}

}  // namespace sightbound
