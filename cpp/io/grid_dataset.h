// SPDX-License-Identifier: GPL-3.0-or-later
// Lets GDAL's algorithms write straight into a window of the DEM's grid. Internal to cpp/io.
#pragma once

#include <exception>
#include <string>

#include "io/gdal_support.h"
#include "terrain/dem.h"
#include "terrain/grid.h"

namespace sightbound::gdal {

// A one-band Float32 dataset over memory of the grid, whole or `rows` of it from `row` on; `geotransform` is
// the whole grid's. Without CRS, nodata NaN.
GDALDatasetUniquePtr dataset_over(Grid<float>&, const Geotransform&);
GDALDatasetUniquePtr dataset_over(Grid<float>&, const Geotransform&, int row, int rows);

// Passes a Progress to GDAL: GDAL stops when it is cancelled, rethrow() then says so.
class ProgressBridge {
 public:
  explicit ProgressBridge(Progress& progress) : progress_(progress) {}
  static int CPL_STDCALL call(double fraction, const char* message, void* self);
  void rethrow() const {
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  Progress& progress_;
  std::exception_ptr thrown_;
};

}  // namespace sightbound::gdal
