// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/gdal_support.h"

#include <algorithm>
#include <array>
#include <mutex>

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <ogr_spatialref.h>

#include "base/error.h"

namespace sightbound::gdal {

void register_drivers() {
  static std::once_flag once;
  std::call_once(once, [] {
    if (GDALGetDriverCount() == 0) GDALAllRegister();
  });
}

ErrorLog::ErrorLog() {
  CPLErrorReset();
  CPLPushErrorHandlerEx(receive, this);
}

ErrorLog::~ErrorLog() {
  CPLPopErrorHandler();
  CPLErrorReset();
}

void CPL_STDCALL ErrorLog::receive(CPLErr level, CPLErrorNum, const char* text) {
  auto* log = static_cast<ErrorLog*>(CPLGetErrorHandlerUserData());
  if (level < CE_Failure || log->failed_) return;
  log->failed_ = true;
  log->first_ = text;
}

std::string ErrorLog::message(const std::string& otherwise) const {
  std::string text = first_.empty() ? otherwise : first_;
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ' || text.back() == '.')) text.pop_back();
  return text + ".";
}

ThreadOption::ThreadOption(const char* key, const char* value) : key_(key) {
  const char* before = CPLGetThreadLocalConfigOption(key, nullptr);
  was_set_ = before != nullptr;
  if (was_set_) before_ = before;
  CPLSetThreadLocalConfigOption(key, value);
}

ThreadOption::~ThreadOption() {
  CPLSetThreadLocalConfigOption(key_.c_str(), was_set_ ? before_.c_str() : nullptr);
}

GDALDatasetUniquePtr open(const std::string& path, unsigned flags, const std::string& what) {
  if (path.empty()) throw InvalidInput(what + ": the path is empty; name a file.");
  register_drivers();
  ErrorLog log;
  // The vertical part of a GeoTIFF's CRS says whether heights are feet.
  const ThreadOption compound("GTIFF_REPORT_COMPD_CS", "YES");
  GDALDatasetUniquePtr dataset(
      GDALDataset::Open(path.c_str(), flags | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
  if (!dataset) throw IoError(what + " cannot be opened: '" + path + "': " + log.message());
  return dataset;
}

GDALRasterBand* band_of(GDALDataset& dataset, int band, const std::string& path, const std::string& what) {
  const int bands = dataset.GetRasterCount();
  if (bands == 0) {
    std::string message = what + " '" + path + "' has no raster bands.";
    const CPLStringList subdatasets(CSLDuplicate(dataset.GetMetadata("SUBDATASETS")));
    if (const char* first = subdatasets.FetchNameValue("SUBDATASET_1_NAME")) {
      message += std::string(" It holds several rasters; give the path of one, for example '") + first + "'.";
    }
    throw InvalidInput(message);
  }
  if (band < 1 || band > bands) {
    throw InvalidInput(what + " '" + path + "': band is " + std::to_string(band) +
                       "; the raster has bands 1 to " + std::to_string(bands) + ".");
  }
  GDALRasterBand* raster_band = dataset.GetRasterBand(band);
  if (GDALDataTypeIsComplex(raster_band->GetRasterDataType())) {
    throw InvalidInput(what + " '" + path + "': band " + std::to_string(band) + " holds complex numbers (" +
                       GDALGetDataTypeName(raster_band->GetRasterDataType()) +
                       "); choose a band of real ones.");
  }
  return raster_band;
}

std::string crs_wkt_of(const OGRSpatialReference* crs) {
  if (crs == nullptr || crs->IsEmpty()) return {};
  const ErrorLog log;
  char* text = nullptr;
  const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
  const OGRErr failed = crs->exportToWkt(&text, options);
  std::string wkt = text != nullptr && failed == OGRERR_NONE ? text : "";
  CPLFree(text);
  return wkt;
}

std::array<double, 6> geotransform_of(GDALDataset& dataset, const std::string& path,
                                      const std::string& what) {
  constexpr std::array<double, 6> kNone{0, 1, 0, 0, 0, 1};
  std::array<double, 6> g = kNone;
  if (dataset.GetGeoTransform(g.data()) == CE_None && g != kNone) return g;
  if (dataset.GetGCPCount() > 0) {
    throw InvalidInput(what + " '" + path +
                       "' is georeferenced by control points only; warp it first (gdalwarp, or QGIS: Warp).");
  }
  throw InvalidInput(
      what + " '" + path +
      "' has no georeference: where its cells lie is unknown. Georeference it first (a world file, "
      "gdal_translate -a_ullr, or the QGIS Georeferencer).");
}

}  // namespace sightbound::gdal
