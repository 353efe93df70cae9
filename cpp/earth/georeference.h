// SPDX-License-Identifier: GPL-3.0-or-later
// Where a raster lies on the Earth: raster coordinates to longitude and latitude, and the true size of its cells.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "terrain/geotransform.h"

namespace sightbound {

struct Ellipsoid {
  double semi_major_m = 6378137.0;
  double flattening = 1 / 298.257223563;
};

// Longitude and latitude in degrees.
struct LonLat {
  double lon = 0, lat = 0;
};

class Georeference {
 public:
  // In place: x becomes longitude, y latitude, in degrees; a place that cannot be transformed becomes infinite or NaN.
  using ToLonLat = std::function<void(std::span<double> x, std::span<double> y)>;

  // A plane in metres with the Earth's mean radius (no CRS known).
  explicit Georeference(const Geotransform& geotransform);
  Georeference(const Geotransform& geotransform, const Ellipsoid& ellipsoid, ToLonLat to_lon_lat);

  bool is_plane() const { return !to_lon_lat_; }
  const Geotransform& geotransform() const { return geotransform_; }
  const Ellipsoid& ellipsoid() const { return ellipsoid_; }

  // Longitude and latitude of raster coordinates (col, row); not for a plane.
  LonLat lon_lat(double col, double row) const;
  // The same for many, in place: cols become longitudes, rows latitudes.
  void lon_lat(std::span<double> cols, std::span<double> rows) const;

  // The same ground seen through a window of the raster.
  Georeference of_window(const Window&) const;

 private:
  Geotransform geotransform_;
  Ellipsoid ellipsoid_;
  ToLonLat to_lon_lat_;
};

// Ground lengths of one step along a row (col_m) and along a column (row_m), metres.
struct CellSize {
  double col_m = 0, row_m = 0;
};

// One per row of the raster's window, taken at the window's middle column. Cost: 4 transformations a row.
// Within a projected raster the scale differs across a row by the projection's distortion only (UTM: below 0.1 %).
std::vector<CellSize> ground_cell_sizes(const Georeference&, const Window&);

// The larger cell side at the middle of the whole raster (L of the definitions), metres.
double larger_cell_side(const Georeference&, int rows, int cols);

}  // namespace sightbound
