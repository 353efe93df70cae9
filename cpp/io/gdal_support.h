// SPDX-License-Identifier: GPL-3.0-or-later
// GDAL without its habits: registered once, silent, errors kept for our messages. Internal to cpp/io.
#pragma once

#include <string>

#include <gdal_priv.h>

namespace sightbound::gdal {

// Registers GDAL's drivers unless somebody (QGIS) has.
void register_drivers();

// While it lives, GDAL's complaints on this thread are collected instead of printed.
class ErrorLog {
 public:
  ErrorLog();
  ~ErrorLog();
  ErrorLog(const ErrorLog&) = delete;
  ErrorLog& operator=(const ErrorLog&) = delete;

  bool failed() const { return failed_; }
  // The first failure's message (later ones are mostly its consequences), or `otherwise`; ends with a full
  // stop.
  std::string message(const std::string& otherwise = "GDAL gives no reason") const;

 private:
  static void CPL_STDCALL receive(CPLErr, CPLErrorNum, const char* text);
  bool failed_ = false;
  std::string first_;
};

// Sets a configuration option for this thread, back to what it was at the end.
class ThreadOption {
 public:
  ThreadOption(const char* key, const char* value);
  ~ThreadOption();
  ThreadOption(const ThreadOption&) = delete;
  ThreadOption& operator=(const ThreadOption&) = delete;

 private:
  std::string key_, before_;
  bool was_set_;
};

// Opens for reading; `flags` are GDAL_OF_RASTER or GDAL_OF_VECTOR. `what` begins the message ("The DEM").
// Throws IoError, InvalidInput for an empty path.
GDALDatasetUniquePtr open(const std::string& path, unsigned flags, const std::string& what);

// A band of an open raster, checked: it exists and holds real numbers. Throws InvalidInput.
GDALRasterBand* band_of(GDALDataset&, int band, const std::string& path, const std::string& what);

// The dataset's CRS as WKT2:2019; empty when it has none.
std::string crs_wkt_of(const OGRSpatialReference*);

// The dataset's geotransform. Throws InvalidInput when it has none, or only control points.
std::array<double, 6> geotransform_of(GDALDataset&, const std::string& path, const std::string& what);

}  // namespace sightbound::gdal
