// SPDX-License-Identifier: GPL-3.0-or-later
// The corners of a DEM's overlays with 8 x 8 columns (column_corners.h), read off the grid: every sample,
// every edge and every lattice point once, no faces made. Half the time. Internal to cpp/volume.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "volume/column_corners.h"
#include "volume/dem_surface.h"

namespace sightbound {

// False where the DEM has a hole, ends, or has sigma_s on both sides of its floor: then faces must be looked
// at.
template <class F>
bool dem_corners(const DemSurface& dem, double voxel, int i0, int j0, LatticePoints& lattice, F& f) {
  const double x0 = i0 * voxel, y0 = j0 * voxel, x1 = (i0 + 8) * voxel, y1 = (j0 + 8) * voxel;
  if (!dem.spans(x0, y0, x1, y1)) return false;
  const Window squares = dem.squares_near(x0, y0, x1, y1);
  const Grid<float>& heights = dem.input().heights;
  const SampleField& sampling = dem.input().error.sampling;
  const int width = squares.cols + 1;
  thread_local std::vector<ColumnCorners::Corner> samples;
  samples.clear();
  bool floor = false, above = false;
  for (int r = squares.row; r <= squares.row_end(); ++r) {
    for (int c = squares.col; c <= squares.col_end(); ++c) {
      const float height = heights.at(r, c);
      if (std::isnan(height)) return false;
      const Xy place = dem.place_of(c, r);
      const auto sigma = static_cast<double>(sampling.at(r, c));
      floor = floor || sigma < kLeastSigma;
      above = above || sigma > kLeastSigma;
      samples.push_back({place.x / voxel - i0, place.y / voxel - j0, static_cast<double>(height), sigma});
    }
  }
  if (floor && above) return false;

  const auto sample = [&](int row, int col) -> const ColumnCorners::Corner& {
    return samples[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                   static_cast<std::size_t>(col)];
  };
  // The raster coordinates of lattice points, from the window's first sample.
  const Xy first = dem.to_raster(x0, y0), along_i = dem.raster_step(voxel, 0),
           along_j = dem.raster_step(0, voxel);
  for (int i = 0; i <= 8; ++i) {
    for (int j = 0; j <= 8; ++j) {
      const double x = first.x + i * along_i.x + j * along_j.x - squares.col,
                   y = first.y + i * along_i.y + j * along_j.y - squares.row;
      const int c = std::clamp(static_cast<int>(x), 0, squares.cols - 1),
                r = std::clamp(static_cast<int>(y), 0, squares.rows - 1);
      const double u = std::clamp(x - c, 0.0, 1.0), v = std::clamp(y - r, 0.0, 1.0);
      const ColumnCorners::Corner &a = sample(r, c), &d = sample(r + 1, c + 1),
                                  &b = u >= v ? sample(r, c + 1) : sample(r + 1, c);
      const double at_a = 1 - std::max(u, v), at_b = std::abs(u - v), at_d = std::min(u, v);
      const auto n = static_cast<std::size_t>(9 * i + j);
      lattice.height[n] = at_a * a.height + at_b * b.height + at_d * d.height;
      lattice.sigma[n] = std::max(at_a * a.sampling + at_b * b.sampling + at_d * d.sampling, kLeastSigma);
    }
  }
  const ColumnCorners corners(voxel, i0, j0, lattice);
  for (int r = 0; r <= squares.rows; ++r) {
    for (int c = 0; c <= squares.cols; ++c) {
      corners.vertex(sample(r, c), f);
      if (c < squares.cols) corners.edge(sample(r, c), sample(r, c + 1), f);
      if (r < squares.rows) corners.edge(sample(r, c), sample(r + 1, c), f);
      if (c < squares.cols && r < squares.rows) corners.edge(sample(r, c), sample(r + 1, c + 1), f);
    }
  }
  return true;
}

}  // namespace sightbound
