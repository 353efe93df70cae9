// SPDX-License-Identifier: GPL-3.0-or-later
// Small terrains for tests, made the same way every time.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <memory>
#include <utility>

#include "terrain/dem.h"

namespace sightbound::testing {

inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
inline constexpr std::array<double, 6> kNorthUp{0, 10, 0, 0, 0, -10};
inline constexpr std::array<double, 6> kSouthUp{0, 10, 0, 0, 0, 10};

inline Grid<float> grid_of(std::initializer_list<std::initializer_list<float>> rows) {
  Grid<float> grid(static_cast<int>(rows.size()), static_cast<int>(rows.begin()->size()));
  float* to = grid.data();
  for (const auto& row : rows) {
    for (const float z : row) *to++ = z;
  }
  return grid;
}

// f(row, col) as double.
template <class F>
Grid<float> grid_from(int rows, int cols, const F& f) {
  Grid<float> grid(rows, cols);
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) grid.at(r, c) = static_cast<float>(f(r, c));
  }
  return grid;
}

inline Grid<float> copy_of(const Grid<float>& grid) {
  return grid_from(grid.rows(), grid.cols(), [&](int r, int c) { return grid.at(r, c); });
}

inline Grid<float> part_of(const Grid<float>& grid, const Window& w) {
  return grid_from(w.rows, w.cols, [&](int r, int c) { return grid.at(w.row + r, w.col + c); });
}

// Uniform in [0, 1) from a place and a seed (splitmix64): no state, no order.
inline double noise(int r, int c, std::uint64_t seed) {
  std::uint64_t x = seed * 0x9E3779B97F4A7C15u + static_cast<std::uint64_t>(r) * 0xBF58476D1CE4E5B9u +
                    static_cast<std::uint64_t>(c) * 0x94D049BB133111EBu;
  for (int i = 0; i < 2; ++i) {
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    x ^= x >> 31;
  }
  return static_cast<double>(x >> 11) * 0x1p-53;
}

// Hills with bumps on them: sums of smooth value noise, halving in size and, with `roughness` H, 2^-H in
// height.
inline double hills(int r, int c, double roughness, std::uint64_t seed) {
  double z = 0, height = 40;
  for (int size = 64; size >= 1; size /= 2, height *= std::exp2(-roughness)) {
    const int i = r / size, j = c / size;
    const double fy = (r % size + 0.5) / size, fx = (c % size + 0.5) / size;
    const auto ease = [](double t) { return t * t * (3 - 2 * t); };
    const auto at = [&](int a, int b) { return noise(a, b, seed + static_cast<std::uint64_t>(size)); };
    const double top = at(i, j) + ease(fx) * (at(i, j + 1) - at(i, j));
    const double bottom = at(i + 1, j) + ease(fx) * (at(i + 1, j + 1) - at(i + 1, j));
    z += height * (top + ease(fy) * (bottom - top));
  }
  return z;
}

// A DEM that owns its heights, in the user's row order.
inline std::unique_ptr<DemSource> dem_of(Grid<float> heights,
                                         const std::array<double, 6>& geotransform = kNorthUp) {
  const auto owner = std::make_shared<Grid<float>>(std::move(heights));
  ArrayDem::Heights given{owner->data(), owner->rows(), owner->cols(), std::nan(""), 1, owner};
  return std::make_unique<ArrayDem>(std::move(given), Geotransform(geotransform), "");
}

}  // namespace sightbound::testing
