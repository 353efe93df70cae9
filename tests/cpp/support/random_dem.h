// SPDX-License-Identifier: GPL-3.0-or-later
// Small random DEMs with their error, and k at a place by the definitions alone (design sections 1-3): no
// code of cpp/volume.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "support/growth.h"
#include "volume/dem_surface.h"

namespace sightbound::testing {

struct RandomDem {
  int rows = 9, cols = 11;
  double cell_x = 10, cell_y = -10;                 // metres a column, a row
  std::vector<double> height, sampling, amplitude;  // row-major
  GeologicShape shape = GeologicShape::kGaussian;
  double range = 0, exponent = 1;
  double ground_scale = 1;  // ground metres a plan metre

  std::size_t at(int r, int c) const { return static_cast<std::size_t>(r * cols + c); }
  double spacing() const { return ground_scale * std::max(std::abs(cell_x), std::abs(cell_y)); }

  // The same numbers as a surface. Local coordinates begin at the lowest x and y.
  std::shared_ptr<const DemSurface> surface() const {
    DemInput input{.heights = Grid<float>(rows, cols),
                   .error = {},
                   .geotransform = Geotransform({5e5, cell_x, 0, 5e6, 0, cell_y}),
                   .crs_wkt = ""};
    Grid<float> s(rows, cols), a(rows, cols);
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < cols; ++c) {
        input.heights.at(r, c) = static_cast<float>(height[at(r, c)]);
        s.at(r, c) = static_cast<float>(sampling[at(r, c)]);
        a.at(r, c) = static_cast<float>(amplitude[at(r, c)]);
      }
    }
    input.error.sampling = SampleField(std::move(s));
    input.error.amplitude = SampleField(std::move(a));
    input.error.profile = {shape, range, exponent, spacing() / 2};
    for (int r = 0; r < rows; ++r) {
      input.error.cell_sizes.push_back({ground_scale * std::abs(cell_x), ground_scale * std::abs(cell_y)});
      input.error.farthest.push_back(0.5 * std::hypot(cell_x, cell_y));
    }
    input.error.larger_side_m = spacing();
    return std::make_shared<DemSurface>(std::move(input));
  }

  struct Place {
    double height, sigma;  // NaN = nothing there
  };

  // Of a local plan place.
  Place place(double x, double y) const {
    const double col = (cell_x > 0 ? x : x + cell_x * (cols - 1)) / cell_x;
    const double row = (cell_y > 0 ? y : y + cell_y * (rows - 1)) / cell_y;
    constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
    if (col < 0 || row < 0 || col > cols - 1 || row > rows - 1) return {kNothing, kNothing};
    const int c = std::min(static_cast<int>(col), cols - 2), r = std::min(static_cast<int>(row), rows - 2);
    const double u = col - c, v = row - r;
    const auto linear = [&](const std::vector<double>& f) {
      return u >= v ? (1 - u) * f[at(r, c)] + (u - v) * f[at(r, c + 1)] + v * f[at(r + 1, c + 1)]
                    : (1 - v) * f[at(r, c)] + (v - u) * f[at(r + 1, c)] + u * f[at(r + 1, c + 1)];
    };
    const double dx = std::min(u, 1 - u) * cell_x * ground_scale,
                 dy = std::min(v, 1 - v) * cell_y * ground_scale;
    const double d = std::sqrt(dx * dx + dy * dy), a = linear(amplitude);
    double between = 0;
    switch (shape) {
      case GeologicShape::kGaussian: {
        const double f = range > 0 ? 1 / (range * range) : std::pow(a * 1.959963984540054, 2);
        between = a * (1 - std::exp(-0.5 * f * d * d));
        break;
      }
      case GeologicShape::kStep:
        between = d < range ? 0 : a;
        break;
      case GeologicShape::kGrowth:
        between = a * growth(2 * d / spacing(), exponent);
        break;
    }
    return {linear(height), std::max(linear(sampling) + between, 0.001)};
  }
  double k(double x, double y, double z) const {
    const Place p = place(x, y);
    return (z - p.height) / p.sigma;
  }
};

// Every kind of error, cells of any proportion, holes in some.
inline RandomDem random_dem(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  RandomDem dem;
  dem.rows = 2 + static_cast<int>(unit(random) * 9);
  dem.cols = 2 + static_cast<int>(unit(random) * 9);
  dem.cell_x = (unit(random) < 0.5 ? -1 : 1) * (2 + 10 * unit(random));
  dem.cell_y = (unit(random) < 0.5 ? -1 : 1) * (2 + 10 * unit(random));
  // The core's rows run so that the NW-SE diagonal is (r, c) to (r + 1, c + 1).
  if (dem.cell_x * dem.cell_y > 0) dem.cell_y = -dem.cell_y;
  const double rough = 12 * unit(random), spread = 3 * unit(random),
               geologic = unit(random) < 0.3 ? 0 : 3 * unit(random);
  const double least = unit(random) < 0.2 ? 0 : 0.3;
  dem.shape = std::array{GeologicShape::kGaussian, GeologicShape::kStep, GeologicShape::kGrowth}[seed % 3];
  dem.range = dem.shape == GeologicShape::kStep ? 3 * unit(random)
              : unit(random) < 0.5              ? 0
                                                : 5 * unit(random);
  dem.exponent = 0.3 + 1.5 * unit(random);
  dem.ground_scale = unit(random) < 0.5 ? 1 : 0.7 + 0.4 * unit(random);
  const bool holes = unit(random) < 0.3;
  for (int i = 0; i < dem.rows * dem.cols; ++i) {
    // Floats, so that the surface holds the very same numbers.
    const auto as_float = [](double value) { return static_cast<double>(static_cast<float>(value)); };
    dem.height.push_back(holes && i > 3 && unit(random) < 0.1 ? std::numeric_limits<double>::quiet_NaN()
                                                              : as_float(-20 + rough * unit(random)));
    dem.sampling.push_back(as_float(least + spread * unit(random)));
    dem.amplitude.push_back(as_float(geologic * unit(random)));
  }
  for (const int i : {0, 1, dem.cols, dem.cols + 1}) {  // some terrain there must be
    if (std::isnan(dem.height[static_cast<std::size_t>(i)])) dem.height[static_cast<std::size_t>(i)] = 0;
  }
  return dem;
}

}  // namespace sightbound::testing
