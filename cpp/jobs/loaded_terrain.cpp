// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/loaded_terrain.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace sightbound {

namespace {

// Sine of the angle between the raster's axes: 1 but for sheared rasters.
double skew(const Geotransform& geotransform) {
  const auto& g = geotransform.coefficients();
  return std::abs(g[1] * g[5] - g[2] * g[4]) / (std::hypot(g[1], g[4]) * std::hypot(g[2], g[5]));
}

// The ground raster's heights at the DEM's samples.
Grid<float> ground_at(const DemSource& ground, const DemSource& source, const Window& window,
                      Progress& progress) {
  if (ground.crs_wkt() != source.crs_wkt() && !ground.crs_wkt().empty() && !source.crs_wkt().empty() &&
      ground.geotransform().coefficients() != source.geotransform().coefficients()) {
    throw InvalidInput("ground is in another coordinate system than the DEM; reproject it to the DEM's.");
  }
  const auto on_ground = [&](int col, int row) {
    const Xy at = source.geotransform().of_sample(window.col + col, window.row + row);
    return ground.geotransform().to_raster(at.x, at.y);
  };
  double col_low = 1e300, col_high = -1e300, row_low = 1e300, row_high = -1e300;
  for (const int col : {0, window.cols - 1}) {
    for (const int row : {0, window.rows - 1}) {
      const Xy at = on_ground(col, row);
      col_low = std::min(col_low, at.x);
      col_high = std::max(col_high, at.x);
      row_low = std::min(row_low, at.y);
      row_high = std::max(row_high, at.y);
    }
  }
  const auto whole = [](double value) { return static_cast<int>(std::clamp(value, -1e9, 1e9)); };
  Window needed{whole(std::floor(col_low)) - 1, whole(std::floor(row_low)) - 1, 0, 0};
  needed.cols = whole(std::ceil(col_high)) + 2 - needed.col;
  needed.rows = whole(std::ceil(row_high)) + 2 - needed.row;
  needed = intersection(needed, ground.window());
  if (needed.cols < 2 || needed.rows < 2)
    throw InvalidInput("ground does not cover the DEM where it is needed.");
  const Grid<float> samples = ground.read(needed, progress);
  if (needed.cols == window.cols && needed.rows == window.rows &&
      ground.geotransform().coefficients() == source.geotransform().coefficients()) {
    return ground.read(window, progress);
  }
  constexpr double kRim = 1e-6;  // cells: rounding of aligned rasters
  Grid<float> out(window.rows, window.cols);
  for (int row = 0; row < window.rows; ++row) {
    for (int col = 0; col < window.cols; ++col) {
      const Xy at = on_ground(col, row);
      const double c = at.x - needed.col, r = at.y - needed.row;
      const bool inside =
          c >= -kRim && r >= -kRim && c <= needed.cols - 1 + kRim && r <= needed.rows - 1 + kRim;
      out.at(row, col) = inside ? static_cast<float>(interpolate(samples, c, r)) : std::nanf("");
    }
    progress.check();
  }
  return out;
}

}  // namespace

double interpolate(const Grid<float>& samples, double col, double row) {
  const int c = std::clamp(static_cast<int>(std::floor(col)), 0, samples.cols() - 2);
  const int r = std::clamp(static_cast<int>(std::floor(row)), 0, samples.rows() - 2);
  const double x = std::clamp(col - c, 0.0, 1.0), y = std::clamp(row - r, 0.0, 1.0);
  double value = 0;
  const auto add = [&](int dr, int dc, double weight) {
    if (weight != 0) value += weight * static_cast<double>(samples.at(r + dr, c + dc));
  };
  add(0, 0, 1 - std::max(x, y));
  add(0, 1, std::max(x - y, 0.0));
  add(1, 0, std::max(y - x, 0.0));
  add(1, 1, std::min(x, y));
  return value;
}

LoadedTerrain::LoadedTerrain(const DemSource& source, const Georeference& georeference, const Window& window,
                             const ErrorModel& model, const ViewshedOptions& options,
                             std::vector<std::string>& warnings, const Workers& workers, Progress& progress)
    : window_(window), heights_(source.read(window, progress)) {
  if (options.ground) ground_ = ground_at(*options.ground, source, window, progress);
  error_ = resolve_error(model, source, georeference, window, heights_, warnings, workers, progress);
  SceneOptions scene;
  scene.confidence = options.confidence;
  scene.refraction = options.refraction;
  scene.curvature = options.curvature;
  scene.ends_move = options.stand == Stand::kGround;
  scene.see_across_nodata = options.see_across_nodata;
  scene_ = std::make_unique<Scene>(heights_, error_, scene, workers);
  const double sine = skew(source.geotransform());
  for (const CellSize& cell : error_.cell_sizes) cell_areas_.push_back(cell.col_m * cell.row_m * sine);
}

ResolveMemory LoadedTerrain::memory(const Window& window, const ErrorModel& model,
                                    const ViewshedOptions& options) {
  const std::size_t grid = window.cells() * sizeof(float);
  const ResolveMemory error = resolve_error_memory(model, window);
  const std::size_t heights = grid * (options.ground ? 2 : 1), pyramid = grid / 8;
  const bool uniform = error.kept == 0;
  ResolveMemory memory;
  memory.kept = heights + error.kept + pyramid * (uniform ? 1 : 2);
  memory.peak = std::max(heights + error.peak, memory.kept);
  return memory;
}

}  // namespace sightbound
