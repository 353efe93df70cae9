// SPDX-License-Identifier: GPL-3.0-or-later
// Affine map from a raster's pixel corners to its CRS, any orientation (GDAL's six numbers in GDAL's order).
#pragma once

#include <array>

#include "terrain/grid.h"

namespace sightbound {

struct Xy {
  double x = 0, y = 0;
};

class Geotransform {
 public:
  Geotransform() = default;
  // x = g[0] + col g[1] + row g[2], y = g[3] + col g[4] + row g[5]. Throws InvalidInput when not invertible or not finite.
  explicit Geotransform(const std::array<double, 6>& g);

  const std::array<double, 6>& coefficients() const { return g_; }
  // What windows and flipped rows lost of g[0] and g[3] in rounding.
  const Xy& lost() const { return lost_; }

  // CRS coordinates of the sample with raster coordinates (col, row): integers are cell centres.
  Xy of_sample(double col, double row) const;
  // Raster coordinates (col, row) of a CRS position: integers are cell centres.
  Xy to_raster(double x, double y) const;

  // The transform of a window of the raster, and of the raster with its rows in reverse order.
  Geotransform of_window(const Window& w) const;
  Geotransform of_flipped(int rows) const;
  // Raster to `scale` times what is left of CRS coordinates when `origin` is taken off: as exact as doubles of that
  // size can be, however far from 0 the origin is, windows and flipped rows included.
  Geotransform seen_from(const Xy& origin, double scale) const;

  // True when the diagonal of a cell that runs NW-SE on the ground goes from sample (r, c+1) to (r+1, c), so that
  // rows must be flipped for the core, which knows the other diagonal only.
  bool diagonal_is_anti() const;

 private:
  void move(int cols, int rows);

  std::array<double, 6> g_{0, 1, 0, 0, 0, -1};
  Xy lost_;
};

}  // namespace sightbound
