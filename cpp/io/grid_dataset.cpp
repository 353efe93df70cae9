// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/grid_dataset.h"

#include <array>
#include <cstdio>
#include <limits>

#include <cpl_string.h>

#include "base/error.h"

namespace sightbound::gdal {

GDALDatasetUniquePtr dataset_over(Grid<float>& grid, const Geotransform& geotransform) {
  return dataset_over(grid, geotransform, 0, grid.rows());
}

GDALDatasetUniquePtr dataset_over(Grid<float>& grid, const Geotransform& geotransform, int row, int rows) {
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("MEM");
  GDALDatasetUniquePtr dataset(
      driver == nullptr ? nullptr : driver->Create("", grid.cols(), rows, 0, GDT_Float32, nullptr));
  if (!dataset)
    throw IoError("GDAL's in-memory driver (MEM) is missing; error rasters and polygons need it.");
  std::array<char, 64> address{};
  address[static_cast<std::size_t>(CPLPrintPointer(address.data(), grid.row(row), address.size() - 1))] =
      '\0';
  CPLStringList options;
  options.SetNameValue("DATAPOINTER", address.data());
  dataset->AddBand(GDT_Float32, options.List());
  dataset->GetRasterBand(1)->SetNoDataValue(std::numeric_limits<double>::quiet_NaN());
  std::array<double, 6> g = geotransform.of_window({0, row, grid.cols(), rows}).coefficients();
  dataset->SetGeoTransform(g.data());
  return dataset;
}

int CPL_STDCALL ProgressBridge::call(double, const char*, void* self) {
  auto* bridge = static_cast<ProgressBridge*>(self);
  try {
    bridge->progress_.check();
    return TRUE;
  } catch (...) {
    bridge->thrown_ = std::current_exception();
    return FALSE;
  }
}

}  // namespace sightbound::gdal
