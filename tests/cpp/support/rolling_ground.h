// SPDX-License-Identifier: GPL-3.0-or-later
// A rolling ground with error of every kind, its volume, and the sweep engine's lines over it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>

#include "sight/sight_line.h"
#include "sight/volume_sight.h"
#include "support/random_dem.h"
#include "volume/error_volume.h"

namespace sightbound::testing {

// The Earth as the definition has it where there is no CRS, refraction 0.13; and a plane.
inline constexpr GroundBend kBent{(1 - 0.13) / (2 * 6371008.8), 0, (1 - 0.13) / (2 * 6371008.8)};
inline constexpr GroundBend kPlane{};

inline ErrorVolume volume_of(const std::shared_ptr<const Surface>& surface, double voxel, double height = 0) {
  Progress progress;
  VolumeOptions options;
  options.voxel_m = voxel;
  options.voxel_height_m = height;
  return ErrorVolume::build(surface, options, progress);
}

// A rolling ground with error of every kind.
inline RandomDem rolling_dem(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  RandomDem dem;
  dem.rows = 24;
  dem.cols = 30;
  dem.shape = std::array{GeologicShape::kGaussian, GeologicShape::kGrowth}[seed % 2];
  dem.range = 4;
  dem.exponent = 0.8;
  const double wave = 6 + 8 * unit(random), size = 3 + 9 * unit(random), noise = 2 * unit(random);
  for (int r = 0; r < dem.rows; ++r) {
    for (int c = 0; c < dem.cols; ++c) {
      const auto as_float = [](double value) { return static_cast<double>(static_cast<float>(value)); };
      dem.height.push_back(
          as_float(50 + size * std::sin(r / wave * 6) * std::cos(c / wave * 5) + noise * unit(random)));
      dem.sampling.push_back(as_float(0.2 + unit(random)));
      dem.amplitude.push_back(as_float(seed % 3 == 0 ? 0 : unit(random)));
    }
  }
  return dem;
}

// The other engine on the same ground.
struct Lines {
  Grid<float> heights;
  ErrorField error;
  Workers workers{1};
  Progress progress;
  std::unique_ptr<Scene> scene;
  std::unique_ptr<ObserverFrame> frame;
  Eye eye;

  Lines(const RandomDem& dem, double col, double row, double eye_height, bool curvature)
      : heights(dem.rows, dem.cols) {
    Grid<float> sampling(dem.rows, dem.cols), amplitude(dem.rows, dem.cols);
    for (std::size_t i = 0; i < heights.size(); ++i) {
      heights.data()[i] = static_cast<float>(dem.height[i]);
      sampling.data()[i] = static_cast<float>(dem.sampling[i]);
      amplitude.data()[i] = static_cast<float>(dem.amplitude[i]);
    }
    error.sampling = SampleField(std::move(sampling));
    error.amplitude = SampleField(std::move(amplitude));
    error.profile = {dem.shape, dem.range, dem.exponent, dem.spacing() / 2};
    error.cell_sizes.assign(static_cast<std::size_t>(dem.rows), {std::abs(dem.cell_x), std::abs(dem.cell_y)});
    error.farthest.assign(static_cast<std::size_t>(dem.rows), 0.5 * std::hypot(dem.cell_x, dem.cell_y));
    error.larger_side_m = dem.spacing();
    SceneOptions options;
    options.curvature = curvature;
    scene = std::make_unique<Scene>(heights, error, options, workers, progress);
    eye.base_col = static_cast<int>(col);
    eye.base_row = static_cast<int>(row);
    const Georeference plane{Geotransform({0, dem.cell_x, 0, 0, 0, dem.cell_y})};
    frame = std::make_unique<ObserverFrame>(plane, col - eye.base_col, row - eye.base_row,
                                            Window{-eye.base_col, -eye.base_row, dem.cols, dem.rows});
    eye.frame = frame.get();
    eye.height = eye_height;
  }
  double ratio(double col, double row, double height) const {
    return SightLine(*scene, eye, {col - eye.base_col, row - eye.base_row, height, 0}).settle().k;
  }
};

}  // namespace sightbound::testing
