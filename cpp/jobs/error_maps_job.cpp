// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/error_maps_job.h"

#include <cmath>

#include "base/memory_budget.h"
#include "base/parallel.h"
#include "base/version.h"
#include "io/crs.h"
#include "io/raster_writer.h"
#include "jobs/resolve_error.h"
#include "jobs/windows.h"

namespace sightbound {

ErrorMaps run_error_maps(const DemSource& source, const ErrorModel& model, int threads, Progress& progress) {
  const Workers workers(threads);
  const Window window = source.window();
  const std::size_t grid = window.cells() * sizeof(float);
  MemoryBudget(0).require(3 * grid + resolve_error_memory(model, window).peak, "The error of the DEM",
                          "Cut the DEM into parts.");
  ErrorMaps out;
  std::vector<std::string> unused;
  progress.begin(0.1, 1);
  const ErrorModel completed = complete_model(model, source, unused, progress);
  progress.begin(0.5, 1);
  Grid<float> heights = source.read(window, progress);
  progress.begin(0.4, 1);
  const ErrorField field =
      resolve_error(completed, source, georeference_of(source), window, heights, unused, workers, progress);
  out.between = Grid<float>(window.rows, window.cols);
  out.sampling = Grid<float>(window.rows, window.cols);
  const double half = 0.5 * field.larger_side_m;
  workers.for_each(static_cast<std::size_t>(window.rows), [&](std::size_t row) {
    const int r = static_cast<int>(row);
    for (int c = 0; c < window.cols; ++c) {
      const float z = heights.at(r, c), amplitude = field.amplitude.at(r, c);
      const bool hole = std::isnan(z);
      out.between.at(r, c) = hole ? z : static_cast<float>(amplitude * field.profile(half, amplitude));
      out.sampling.at(r, c) = hole ? z : field.sampling.at(r, c);
    }
  });
  if (source.flipped()) out.between.flip_rows(), out.sampling.flip_rows();
  out.geotransform = delivered_geotransform(source, window);
  out.crs_wkt = source.crs_wkt();
  out.error_model = completed.describe();
  progress.finish();
  return out;
}

void write_error_maps(const ErrorMaps& maps, const std::string& between, const std::string& sampling,
                      const std::vector<std::string>& creation_options, int threads, Progress& progress) {
  std::vector<RasterOutput> outputs;
  const auto add = [&](const std::string& path, const Grid<float>& grid, const std::string& what) {
    if (path.empty()) return;
    RasterMetadata metadata;
    metadata.description = what;
    metadata.unit = std::string("m");
    metadata.items = {{"SIGHTBOUND_VERSION", version()}, {"SIGHTBOUND_ERROR_MODEL", maps.error_model}};
    metadata.creation_options = creation_options;
    outputs.push_back({path, &grid, metadata});
  };
  add(between, maps.between, "standard deviation between samples, half a spacing away");
  add(sampling, maps.sampling, "standard deviation of the measured height");
  write_rasters(outputs, maps.geotransform, maps.crs_wkt, threads, progress);
}

}  // namespace sightbound
