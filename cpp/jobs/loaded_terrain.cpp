// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/loaded_terrain.h"

#include <algorithm>
#include <cmath>

#include "jobs/ground_raster.h"

namespace sightbound {

std::vector<double> cell_areas(const std::vector<CellSize>& sizes, const Geotransform& geotransform) {
  const auto& g = geotransform.coefficients();
  // Sine of the angle between the raster's axes: 1 but for sheared rasters.
  const double sine = std::abs(g[1] * g[5] - g[2] * g[4]) / (std::hypot(g[1], g[4]) * std::hypot(g[2], g[5]));
  std::vector<double> areas;
  for (const CellSize& cell : sizes) areas.push_back(cell.col_m * cell.row_m * sine);
  return areas;
}

LoadedTerrain::LoadedTerrain(const DemSource& source, const Georeference& georeference, const Window& window,
                             const ErrorModel& model, const ViewshedOptions& options,
                             std::vector<std::string>& warnings, const Workers& workers, Progress& progress)
    : window_(window), heights_(source.read(window, progress)) {
  if (options.ground) ground_ = ground_at(*options.ground, source, window, progress);
  error_ = resolve_error(model, source, georeference, window, heights_, warnings, workers, progress);
  take_bias_off(model, heights_, workers);
  take_bias_off(model, ground_, workers);
  SceneOptions scene;
  scene.confidence = options.confidence;
  scene.refraction = options.refraction;
  scene.curvature = options.curvature;
  scene.ends_move = options.stand == Stand::kGround;
  scene.see_across_nodata = options.see_across_nodata;
  scene_ = std::make_unique<Scene>(heights_, error_, scene, workers, progress);
  cell_areas_ = sightbound::cell_areas(error_.cell_sizes, source.geotransform());
}

ResolveMemory LoadedTerrain::memory(const Window& window, const ErrorModel& model,
                                    const ViewshedOptions& options) {
  const std::size_t grid = window.cells() * sizeof(float);
  const ResolveMemory error = resolve_error_memory(model, window);
  const std::size_t heights = options.ground ? 2 * grid + kGroundBandBytes : grid;
  const std::size_t pyramids = 2 * (grid / 8);  // of heights, and of sigma unless it is the same everywhere
  ResolveMemory memory;
  memory.kept = heights + error.kept + pyramids;
  memory.peak = std::max(heights + error.peak, memory.kept);
  return memory;
}

}  // namespace sightbound
