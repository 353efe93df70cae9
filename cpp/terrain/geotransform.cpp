// SPDX-License-Identifier: GPL-3.0-or-later
#include "terrain/geotransform.h"

#include <cmath>

#include "base/error.h"

namespace sightbound {

namespace {

// x += n * step; what rounding takes from it goes to `lost` (Knuth's sum, and the product's remainder).
void add(double n, double step, double& x, double& lost) {
  const double product = n * step, sum = x + product, added = sum - x;
  lost += (x - (sum - added)) + (product - added) + std::fma(n, step, -product);
  x = sum;
}

}  // namespace

Geotransform::Geotransform(const std::array<double, 6>& g) : g_(g) {
  const double determinant = g[1] * g[5] - g[2] * g[4];
  if (!std::isfinite(determinant) || determinant == 0 || !std::isfinite(g[0]) || !std::isfinite(g[3])) {
    throw InvalidInput(
        "The DEM's geotransform is not invertible: cells need a width and a height. Georeference the "
        "raster.");
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
  Geotransform moved = *this;
  moved.move(w.col, w.row);
  return moved;
}

Geotransform Geotransform::of_flipped(int rows) const {
  Geotransform turned = *this;
  turned.move(0, rows);
  turned.g_[2] = -g_[2];
  turned.g_[5] = -g_[5];
  return turned;
}

Geotransform Geotransform::seen_from(const Xy& origin, double scale) const {
  std::array<double, 6> g = g_;
  g[0] = (g[0] - origin.x) + lost_.x;
  g[3] = (g[3] - origin.y) + lost_.y;
  for (double& one : g) one *= scale;
  return Geotransform(g);
}

void Geotransform::move(int cols, int rows) {
  add(cols, g_[1], g_[0], lost_.x);
  add(rows, g_[2], g_[0], lost_.x);
  add(cols, g_[4], g_[3], lost_.y);
  add(rows, g_[5], g_[3], lost_.y);
}

bool Geotransform::diagonal_is_anti() const {
  // Cosine of the angle to the direction south-east, taken without sign: a diagonal has none.
  const auto along_south_east = [](double x, double y) { return std::abs(x - y) / std::hypot(x, y); };
  constexpr double kTie = 1e-9;  // rounding of a square cell turned by 45 degrees; the main diagonal wins
  return along_south_east(g_[1] - g_[2], g_[4] - g_[5]) >
         along_south_east(g_[1] + g_[2], g_[4] + g_[5]) + kTie;
}

}  // namespace sightbound
