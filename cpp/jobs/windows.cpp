// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/windows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

#include "base/error.h"

namespace sightbound {

namespace {

constexpr double kSnap = 1e-3;  // cells: room for coordinates that were written with few digits

struct Bounds {
  double least = std::numeric_limits<double>::infinity(), largest = -std::numeric_limits<double>::infinity();

  void add(double value) {
    least = std::min(least, value);
    largest = std::max(largest, value);
  }
};

std::string text(const Extent& e) {
  std::ostringstream out;
  out.precision(12);
  out << "x " << e.x_min << " to " << e.x_max << ", y " << e.y_min << " to " << e.y_max;
  return out.str();
}

Extent extent_of(const DemSource& source) {
  Bounds x, y;
  for (const double col : {-0.5, source.cols() - 0.5}) {
    for (const double row : {-0.5, source.rows() - 0.5}) {
      const Xy corner = source.geotransform().of_sample(col, row);
      x.add(corner.x);
      y.add(corner.y);
    }
  }
  return {x.least, y.least, x.largest, y.largest};
}

}  // namespace

Window snap_extent(const Extent& extent, const DemSource& source) {
  for (const double value : {extent.x_min, extent.y_min, extent.x_max, extent.y_max}) {
    if (!std::isfinite(value))
      throw InvalidInput("extent (" + text(extent) + ") has a coordinate that is not a number.");
  }
  if (!(extent.x_min < extent.x_max && extent.y_min < extent.y_max)) {
    throw InvalidInput("extent (" + text(extent) +
                       ") is empty; give (xmin, ymin, xmax, ymax) with xmin < xmax, ymin < ymax.");
  }
  Bounds col, row;  // of cell borders: 0 is the outer border of the first cell
  for (const double x : {extent.x_min, extent.x_max}) {
    for (const double y : {extent.y_min, extent.y_max}) {
      const Xy place = source.geotransform().to_raster(x, y);
      col.add(place.x + 0.5);
      row.add(place.y + 0.5);
    }
  }
  const auto begin = [](const Bounds& b, int cells) {
    return static_cast<int>(std::clamp(std::floor(b.least + kSnap), 0.0, double(cells)));
  };
  const auto end = [](const Bounds& b, int cells) {
    return static_cast<int>(std::clamp(std::ceil(b.largest - kSnap), 0.0, double(cells)));
  };
  Window window;
  window.col = begin(col, source.cols());
  window.row = begin(row, source.rows());
  window.cols = end(col, source.cols()) - window.col;
  window.rows = end(row, source.rows()) - window.row;
  if (window.empty()) {
    throw InvalidInput("extent (" + text(extent) + ") lies outside the DEM (" + text(extent_of(source)) +
                       "); give it in the DEM's coordinate system.");
  }
  return window;
}

Window window_of(const std::optional<Extent>& extent, const DemSource& source) {
  return extent ? snap_extent(*extent, source) : source.window();
}

Geotransform delivered_geotransform(const DemSource& source, const Window& window) {
  const Geotransform core = source.geotransform().of_window(window);
  return source.flipped() ? core.of_flipped(window.rows) : core;
}

}  // namespace sightbound
