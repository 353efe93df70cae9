// SPDX-License-Identifier: GPL-3.0-or-later
// Raster files for tests of cpp/io, written with GDAL alone.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

namespace sightbound::testing {

struct RasterFileSpec {
  int rows = 3, cols = 4;
  std::vector<double> values = {};  // row-major; empty = 0, 1, 2 ...
  GDALDataType type = GDT_Float32;
  std::optional<std::array<double, 6>> geotransform = std::array<double, 6>{500000, 10, 0, 5000000, 0, -10};
  std::string crs = "EPSG:32632";  // empty = none
  std::optional<double> nodata = {};
  std::optional<double> scale = {}, offset = {};
  std::string unit = {};
  int bands = 1;  // all alike, band b plus 1000 (b - 1)
  std::vector<std::string> options = {};
  std::vector<std::uint8_t> mask = {};  // of the dataset, 0 = hole
};

inline GDALDatasetUniquePtr make_dataset(const RasterFileSpec& spec, const std::string& path,
                                         const std::string& driver = "GTiff") {
  if (GDALGetDriverCount() == 0) GDALAllRegister();
  CPLStringList options;
  for (const std::string& option : spec.options) options.AddString(option.c_str());
  GDALDatasetUniquePtr dataset(
      GetGDALDriverManager()
          ->GetDriverByName(driver.c_str())
          ->Create(path.c_str(), spec.cols, spec.rows, spec.bands, spec.type, options.List()));
  if (!dataset) throw std::runtime_error("the test cannot make " + path);
  if (spec.geotransform) {
    auto g = *spec.geotransform;
    dataset->SetGeoTransform(g.data());
  }
  if (!spec.crs.empty()) {
    OGRSpatialReference crs;
    crs.SetFromUserInput(spec.crs.c_str());
    dataset->SetSpatialRef(&crs);
  }
  std::vector<double> values = spec.values;
  if (values.empty()) {
    for (int i = 0; i < spec.rows * spec.cols; ++i) values.push_back(i);
  }
  for (int b = 1; b <= spec.bands; ++b) {
    GDALRasterBand* band = dataset->GetRasterBand(b);
    if (spec.nodata) band->SetNoDataValue(*spec.nodata);
    if (spec.scale) band->SetScale(*spec.scale);
    if (spec.offset) band->SetOffset(*spec.offset);
    if (!spec.unit.empty()) band->SetUnitType(spec.unit.c_str());
    std::vector<double> shifted = values;
    for (double& value : shifted) value += 1000 * (b - 1);
    const CPLErr failed = band->RasterIO(GF_Write, 0, 0, spec.cols, spec.rows, shifted.data(), spec.cols,
                                         spec.rows, GDT_Float64, 0, 0, nullptr);
    if (failed != CE_None) throw std::runtime_error("the test cannot fill " + path);
  }
  if (!spec.mask.empty()) {
    CPLSetThreadLocalConfigOption("GDAL_TIFF_INTERNAL_MASK", "YES");
    dataset->CreateMaskBand(GMF_PER_DATASET);
    std::vector<std::uint8_t> mask = spec.mask;
    const CPLErr failed = dataset->GetRasterBand(1)->GetMaskBand()->RasterIO(
        GF_Write, 0, 0, spec.cols, spec.rows, mask.data(), spec.cols, spec.rows, GDT_Byte, 0, 0, nullptr);
    CPLSetThreadLocalConfigOption("GDAL_TIFF_INTERNAL_MASK", nullptr);
    if (failed != CE_None) throw std::runtime_error("the test cannot mask " + path);
  }
  return dataset;
}

inline std::string make_raster(const RasterFileSpec& spec, const std::string& path,
                               const std::string& driver = "GTiff") {
  make_dataset(spec, path, driver);
  return path;
}

// For formats that can only be copied into.
inline std::string copy_raster(const RasterFileSpec& spec, const std::string& path, const std::string& driver,
                               const std::vector<std::string>& creation = {}) {
  const GDALDatasetUniquePtr memory = make_dataset(spec, "", "MEM");
  CPLStringList options;
  for (const std::string& option : creation) options.AddString(option.c_str());
  const GDALDatasetUniquePtr copy(
      GetGDALDriverManager()
          ->GetDriverByName(driver.c_str())
          ->CreateCopy(path.c_str(), memory.get(), FALSE, options.List(), nullptr, nullptr));
  if (!copy) throw std::runtime_error("the test cannot copy to " + path);
  return path;
}

}  // namespace sightbound::testing
