// SPDX-License-Identifier: GPL-3.0-or-later
#include "terrain/geotransform.h"

#include <cmath>

#include "base/error.h"

namespace sightbound {

Geotransform::Geotransform(const std::array<double, 6>& g) : g_(g) {
  const double determinant = g[1] * g[5] - g[2] * g[4];
  if (!std::isfinite(determinant) || determinant == 0 || !std::isfinite(g[0]) || !std::isfinite(g[3])) {
    throw InvalidInput("The DEM's geotransform is not invertible: cells need a width and a height. Georeference the raster.");
  }
}

Xy Geotransform::of_sample(double col, double row) const {
  const double c = col + 0.5, r = row + 0.5;
  return {g_[0] + c * g_[1] + r * g_[2], g_[3] + c * g_[4] + r * g_[5]};
}

Xy Geotransform::to_raster(double x, double y) const {
  const double determinant = g_[1] * g_[5] - g_[2] * g_[4];
  const double dx = x - g_[0], dy = y - g_[3];
  return {(dx * g_[5] - dy * g_[2]) / determinant - 0.5, (dy * g_[1] - dx * g_[4]) / determinant - 0.5};
}

Geotransform Geotransform::of_window(const Window& w) const {
  std::array<double, 6> g = g_;
  g[0] += w.col * g[1] + w.row * g[2];
  g[3] += w.col * g[4] + w.row * g[5];
  return Geotransform(g);
}

Geotransform Geotransform::of_flipped(int rows) const {
  std::array<double, 6> g = g_;
  g[0] += rows * g[2];
  g[3] += rows * g[5];
  g[2] = -g[2];
  g[5] = -g[5];
  return Geotransform(g);
}

bool Geotransform::diagonal_is_anti() const {
  // Cosine of the angle to the direction south-east, taken without sign: a diagonal has none.
  const auto along_south_east = [](double x, double y) { return std::abs(x - y) / std::hypot(x, y); };
  constexpr double kTie = 1e-9;  // rounding of a square cell turned by 45 degrees; the main diagonal wins
  return along_south_east(g_[1] - g_[2], g_[4] - g_[5]) > along_south_east(g_[1] + g_[2], g_[4] + g_[5]) + kTie;
}

}  // namespace sightbound
