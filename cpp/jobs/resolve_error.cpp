// SPDX-License-Identifier: GPL-3.0-or-later
// Method. Neighbours are looked at (slope, local map) while `heights` is still what the source gave; only
// then are cells without an error value made holes. So a window's values do not depend on where the window
// ends.
#include "jobs/resolve_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/error.h"
#include "error_model/estimate.h"
#include "error_model/local_variation.h"
#include "error_model/sampling_error.h"
#include "io/error_rasters.h"

namespace sightbound {

namespace {

std::size_t index(int row) { return static_cast<std::size_t>(row); }

// What every step needs to know of the job.
struct Job {
  const ErrorModel& model;
  const DemSource& source;
  const Window& window;
  const Workers& workers;
  Progress& progress;
};

// Rasters and arrays: a grid of their own, which may have no value where the DEM has a height.
bool is_grid(const Quantity& quantity) {
  return std::holds_alternative<RasterFile>(quantity) || std::holds_alternative<SharedGrid>(quantity);
}

bool from_dem(const ErrorModel& model) { return std::holds_alternative<FromDem>(model.geologic_variation); }

CellContent content_of(const ErrorModel& model) {
  return model.samples_or_means.value_or(CellContent::kSamples);
}

// What is left to the DEM becomes one number for sigma_v, a map for Delta. The map of means opens the heights
// at their own places too.
bool has_sampling_grid(const ErrorModel& model) {
  return model.horizontal_rmse > 0 || is_grid(model.vertical_rmse) ||
         (from_dem(model) && content_of(model) == CellContent::kMeans);
}

bool has_geologic_grid(const ErrorModel& model) {
  return model.terrain_types.has_value() || !std::holds_alternative<double>(model.geologic_variation);
}

bool needs_neighbours(const ErrorModel& model) { return model.horizontal_rmse > 0 || from_dem(model); }

void require_allowed(const Grid<float>& values, const char* field, const std::string& where) {
  for (const float value : values.values()) {
    if (value < 0 || value > kLargestError) {
      throw InvalidInput(std::string(field) + " (" + where + ") holds " + std::to_string(value) +
                         "; allowed are 0 to 10000 m. If this value stands for nodata, declare it as such.");
    }
  }
}

Grid<float> part_of(const SharedGrid& array, const char* field, const Job& job) {
  if (array->rows() != job.source.rows() || array->cols() != job.source.cols()) {
    throw InvalidInput(std::string(field) + " is an array of " + std::to_string(array->rows()) + " x " +
                       std::to_string(array->cols()) + " values, but the DEM has " +
                       std::to_string(job.source.rows()) + " x " + std::to_string(job.source.cols()) +
                       " samples; give one value per sample.");
  }
  Grid<float> out(job.window.rows, job.window.cols);
  for (int r = 0; r < out.rows(); ++r) {
    std::copy_n(array->row(job.window.row + r) + job.window.col, out.cols(), out.row(r));
  }
  return out;
}

// A quantity given as raster or array, on the window; NaN where it has no value.
Grid<float> grid_of(const Quantity& quantity, const char* field, const Job& job) {
  if (const auto* raster = std::get_if<RasterFile>(&quantity)) {
    Grid<float> out = aligned_raster(*raster, job.source, job.window, job.progress);
    require_allowed(out, field, raster->path);
    return out;
  }
  Grid<float> out = part_of(std::get<SharedGrid>(quantity), field, job);
  require_allowed(out, field, "array");
  return out;
}

SampleField given_sigma_v(const Job& job) {
  const Quantity& rmse = job.model.vertical_rmse;
  if (const auto* metres = std::get_if<double>(&rmse)) return SampleField(static_cast<float>(*metres));
  return SampleField(grid_of(rmse, "vertical_rmse", job));
}

void scale(Grid<float>& values, double factor, const Job& job) {
  job.workers.for_each(index(values.rows()), [&](std::size_t r) {
    float* row = values.row(static_cast<int>(r));
    for (int c = 0; c < values.cols(); ++c) row[c] = static_cast<float>(row[c] * factor);
  });
}

SampleField base_amplitude(const Job& job, const Surroundings* heights) {
  const Quantity& variation = job.model.geologic_variation;
  if (const auto* metres = std::get_if<double>(&variation))
    return SampleField(static_cast<float>(*metres / kZ95));
  if (std::holds_alternative<FromDem>(variation)) {
    const ResidualScale scale =
        residual_scale(*job.model.growth_exponent, content_of(job.model), job.model.local_scale.value_or(1));
    return SampleField(local_variation(*heights, scale, *job.model.typical_m, job.workers, job.progress));
  }
  Grid<float> delta = grid_of(variation, "geologic_variation", job);
  scale(delta, 1 / kZ95, job);
  return SampleField(std::move(delta));
}

// Inside polygons their own amplitude, outside the base's.
SampleField with_terrain_types(SampleField base, const Job& job) {
  Grid<float> amplitude =
      terrain_type_variation(*job.model.terrain_types, job.source, job.window, job.progress);
  require_allowed(amplitude, "terrain_types", job.model.terrain_types->path);
  scale(amplitude, 1 / kZ95, job);
  job.workers.for_each(index(amplitude.rows()), [&](std::size_t at) {
    const int r = static_cast<int>(at);
    float* row = amplitude.row(r);
    for (int c = 0; c < amplitude.cols(); ++c) {
      if (std::isnan(row[c])) row[c] = base.at(r, c);
    }
  });
  return SampleField(std::move(amplitude));
}

// Where `field` has no value the height becomes a hole. The value there, which then nobody judges by, becomes
// the least of all, so that it widens no bound. Returns the number of heights lost.
std::size_t make_holes(SampleField& field, Grid<float>& heights) {
  Grid<float> values = field.release();
  float least = std::numeric_limits<float>::infinity();
  for (const float value : values.values()) least = value < least ? value : least;
  if (std::isinf(least)) least = 0;
  std::size_t lost = 0;
  for (int r = 0; r < heights.rows(); ++r) {
    float *value = values.row(r), *z = heights.row(r);
    for (int c = 0; c < heights.cols(); ++c) {
      if (!std::isnan(value[c])) continue;
      value[c] = least;
      if (!std::isnan(z[c])) ++lost;
      z[c] = std::numeric_limits<float>::quiet_NaN();
    }
  }
  field = SampleField(std::move(values));
  return lost;
}

void warn_of_holes(std::size_t lost, const char* field, const Window& window,
                   std::vector<std::string>& warnings) {
  if (lost == 0) return;
  warnings.push_back(std::string(field) + " has no value at " + std::to_string(lost) + " of " +
                     std::to_string(window.cells()) +
                     " cells where the DEM has a height; the ground there counts as unknown.");
}

GrowthProfile profile_of(const ErrorModel& model, double larger_side_m) {
  GrowthProfile profile;
  profile.shape = model.geologic_shape;
  profile.range_m = model.geologic_range.value_or(0);
  profile.exponent = model.growth_exponent.value_or(1);
  profile.half_spacing_m = larger_side_m / 2;
  return profile;
}

// Of means, the share of the map that is open at a sample's own place is an error of its height.
void share_with_samples(ErrorField& field, const Job& job) {
  const auto node = static_cast<float>(field.surface->node);
  if (node == 0) return;
  Grid<float> map = field.amplitude.release();
  Grid<float> sampling = field.sampling.is_constant()
                             ? Grid<float>(map.rows(), map.cols(), field.sampling.constant())
                             : field.sampling.release();
  job.workers.for_each(index(map.rows()), [&](std::size_t r) {
    float *amplitude = map.row(static_cast<int>(r)), *own = sampling.row(static_cast<int>(r));
    for (int c = 0; c < map.cols(); ++c) {
      own[c] += node * amplitude[c];
      amplitude[c] *= 1 - node;
    }
  });
  field.amplitude = SampleField(std::move(map));
  field.sampling = SampleField(std::move(sampling));
}

// Cell sizes and what follows from them. A sample's cell reaches into the squares above and below it.
void add_geometry(ErrorField& field, const Job& job, const Georeference& georeference) {
  const int above = std::min(job.window.row, 1);
  const Window rows{0, job.window.row - above, job.source.cols(), job.window.rows + above};
  const std::vector<CellSize> sizes = ground_cell_sizes(georeference, rows);
  for (std::size_t r = index(above); r < sizes.size(); ++r) {
    const CellSize &cell = sizes[r], &before = sizes[r > 0 ? r - 1 : 0];
    field.cell_sizes.push_back(cell);
    field.farthest.push_back(
        0.5 * std::max(std::hypot(cell.col_m, cell.row_m), std::hypot(before.col_m, before.row_m)));
  }
  field.larger_side_m = larger_cell_side(georeference, job.source.rows(), job.source.cols());
  const Window middle{0, job.source.rows() / 2, job.source.cols(), 1};
  const CellSize cell = ground_cell_sizes(georeference, middle).front();
  field.noise = CorrelatedNoise(job.model.correlation_length, cell);
  if (!from_dem(job.model)) return;
  field.surface = fractal_surface(*job.model.growth_exponent, content_of(job.model), cell.row_m / cell.col_m);
  field.ridge_gain = job.model.ridge_gain.value_or(0);
  field.steps = {{job.model.level_variance.value_or(1), job.model.level_tail.value_or(0)},
                 {job.model.step_variance.value_or(1), job.model.step_tail.value_or(0)},
                 job.model.level_tail.has_value()};
}

}  // namespace

ErrorModel complete_model(const ErrorModel& model, const DemSource& source,
                          std::vector<std::string>& warnings, Progress& progress) {
  model.validate();
  if (!model.needs_estimate()) return model;
  const Estimate learnt = estimate(source, model.samples_or_means, progress);
  warnings.insert(warnings.end(), learnt.warnings.begin(), learnt.warnings.end());
  return with_estimate(model, learnt);
}

ErrorField resolve_error(const ErrorModel& completed, const DemSource& source,
                         const Georeference& georeference, const Window& window, Grid<float>& heights,
                         std::vector<std::string>& warnings, const Workers& workers, Progress& progress) {
  completed.validate();
  if (completed.needs_estimate())
    throw InvalidInput("The error model is not complete; pass it through complete_model first.");
  const Job job{completed, source, window, workers, progress};
  ErrorField field;
  add_geometry(field, job, georeference);
  field.profile = profile_of(completed, field.larger_side_m);
  field.tails = completed.tails_used();

  SampleField sigma_v = given_sigma_v(job);
  std::optional<Surroundings> around;
  if (needs_neighbours(completed)) around.emplace(heights, window, source, progress);
  field.sampling = completed.horizontal_rmse > 0
                       ? sampling_error(std::move(sigma_v), completed.horizontal_rmse, *around,
                                        field.cell_sizes, workers, progress)
                       : std::move(sigma_v);
  field.amplitude = base_amplitude(job, around ? &*around : nullptr);
  if (field.surface) share_with_samples(field, job);
  if (completed.terrain_types) field.amplitude = with_terrain_types(std::move(field.amplitude), job);

  if (is_grid(completed.vertical_rmse)) {
    warn_of_holes(make_holes(field.sampling, heights), "vertical_rmse", window, warnings);
  }
  if (is_grid(completed.geologic_variation)) {
    warn_of_holes(make_holes(field.amplitude, heights), "geologic_variation", window, warnings);
  }
  return field;
}

void take_bias_off(const ErrorModel& model, Grid<float>& heights, const Workers& workers) {
  if (model.shared_bias == 0) return;
  workers.for_each(index(heights.rows()), [&](std::size_t r) {
    float* row = heights.row(static_cast<int>(r));
    for (int c = 0; c < heights.cols(); ++c) row[c] = static_cast<float>(row[c] - model.shared_bias);
  });
}

ResolveMemory resolve_error_memory(const ErrorModel& model, const Window& window) {
  const std::size_t grid = window.cells() * sizeof(float);
  ResolveMemory memory;
  memory.kept = (has_sampling_grid(model) ? grid : 0) + (has_geologic_grid(model) ? grid : 0);
  const bool base_and_types =
      model.terrain_types && !std::holds_alternative<double>(model.geologic_variation);
  memory.peak = memory.kept + (base_and_types ? grid : 0);
  return memory;
}

}  // namespace sightbound
