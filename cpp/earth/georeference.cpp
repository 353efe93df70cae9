// SPDX-License-Identifier: GPL-3.0-or-later
// Raster coordinates -> CRS (affine) -> longitude, latitude (the CRS's own inverse) -> geodesics on its
// ellipsoid.
#include "earth/georeference.h"

#include <cmath>
#include <cstddef>
#include <utility>

#include <GeographicLib/Geodesic.hpp>

#include "base/error.h"

namespace sightbound {

namespace {

bool usable(const CellSize& size) {
  return std::isfinite(size.col_m) && std::isfinite(size.row_m) && size.col_m > 0 && size.row_m > 0;
}

CellSize plane_cell_size(const Geotransform& geotransform) {
  const auto& g = geotransform.coefficients();
  return {std::hypot(g[1], g[4]), std::hypot(g[2], g[5])};
}

// One step around (col, row) in both directions, for each of `count` rows from `first_row` on.
std::vector<CellSize> measured_cell_sizes(const Georeference& georeference, double col, int first_row,
                                          int count) {
  const auto n = static_cast<std::size_t>(count);
  std::vector<double> x(4 * n), y(4 * n);
  for (std::size_t i = 0; i < n; ++i) {
    const double row = first_row + static_cast<double>(i);
    const std::size_t at = 4 * i;
    x[at] = col - 0.5, y[at] = row;
    x[at + 1] = col + 0.5, y[at + 1] = row;
    x[at + 2] = col, y[at + 2] = row - 0.5;
    x[at + 3] = col, y[at + 3] = row + 0.5;
  }
  georeference.lon_lat(x, y);

  const Ellipsoid& ellipsoid = georeference.ellipsoid();
  const GeographicLib::Geodesic geodesic(ellipsoid.semi_major_m, ellipsoid.flattening);
  const auto distance = [&](std::size_t from, std::size_t to) {
    double metres = 0;
    geodesic.Inverse(y[from], x[from], y[to], x[to], metres);
    return metres;
  };
  std::vector<CellSize> sizes(n);
  for (std::size_t i = 0; i < n; ++i) sizes[i] = {distance(4 * i, 4 * i + 1), distance(4 * i + 2, 4 * i + 3)};
  return sizes;
}

// Rows that the projection cannot reach, or on a pole where a step along the row has no length, take the size
// of the nearest row that has one.
void fill_from_nearest(std::vector<CellSize>& sizes) {
  const std::size_t n = sizes.size();
  std::size_t last = n;
  for (std::size_t i = 0; i < n; ++i) {
    if (!usable(sizes[i])) continue;
    const std::size_t from = last == n ? 0 : last + (i - last) / 2 + 1;
    for (std::size_t j = from; j < i; ++j) sizes[j] = sizes[i];
    if (last != n) {
      for (std::size_t j = last + 1; j < from; ++j) sizes[j] = sizes[last];
    }
    last = i;
  }
  if (last == n) {
    throw InvalidInput(
        "The DEM's coordinates have no longitude and latitude in its CRS: the CRS does not fit the "
        "coordinates. "
        "Assign the right CRS.");
  }
  for (std::size_t j = last + 1; j < n; ++j) sizes[j] = sizes[last];
}

}  // namespace

Georeference::Georeference(const Geotransform& geotransform) : geotransform_(geotransform) {}

Georeference::Georeference(const Geotransform& geotransform, const Ellipsoid& ellipsoid, ToLonLat to_lon_lat)
    : geotransform_(geotransform), ellipsoid_(ellipsoid), to_lon_lat_(std::move(to_lon_lat)) {
  if (!to_lon_lat_)
    throw BrokenGuarantee("a georeference on an ellipsoid needs a way to longitude and latitude");
}

LonLat Georeference::lon_lat(double col, double row) const {
  lon_lat(std::span(&col, 1), std::span(&row, 1));
  return {col, row};
}

void Georeference::lon_lat(std::span<double> cols, std::span<double> rows) const {
  if (is_plane()) throw BrokenGuarantee("a plane has no longitude and latitude");
  for (std::size_t i = 0; i < cols.size(); ++i) {
    const Xy p = geotransform_.of_sample(cols[i], rows[i]);
    cols[i] = p.x;
    rows[i] = p.y;
  }
  to_lon_lat_(cols, rows);
}

Georeference Georeference::of_window(const Window& window) const {
  Georeference moved = *this;
  moved.geotransform_ = geotransform_.of_window(window);
  return moved;
}

std::vector<CellSize> ground_cell_sizes(const Georeference& georeference, const Window& window) {
  if (window.empty()) return {};
  if (georeference.is_plane()) {
    return std::vector<CellSize>(static_cast<std::size_t>(window.rows),
                                 plane_cell_size(georeference.geotransform()));
  }
  const double middle_col = window.col + (window.cols - 1) / 2.0;
  std::vector<CellSize> sizes = measured_cell_sizes(georeference, middle_col, window.row, window.rows);
  fill_from_nearest(sizes);
  return sizes;
}

double larger_cell_side(const Georeference& georeference, int rows, int cols) {
  const std::vector<CellSize> middle = ground_cell_sizes(georeference, {0, (rows - 1) / 2, cols, 1});
  return std::max(middle[0].col_m, middle[0].row_m);
}

}  // namespace sightbound
