// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/tin_crs.h"

#include <cpl_conv.h>
#include <ogr_spatialref.h>

#include "base/error.h"
#include "io/crs.h"
#include "io/gdal_support.h"

namespace sightbound {

double metres_per_plan_unit(const std::string& crs_wkt) {
  if (crs_wkt.empty()) return 1;
  const CrsUnits units = crs_units(crs_wkt);
  if (!units.horizontal_m) {
    throw InvalidInput("The CRS measures in degrees (" + units.horizontal_name +
                       "), a TIN needs lengths: reproject to a projected CRS such as UTM.");
  }
  return *units.horizontal_m;
}

std::string crs_from_text(const std::string& text) {
  const gdal::ErrorLog log;
  OGRSpatialReference reference;
  const char* const options[] = {"ALLOW_NETWORK_ACCESS=NO", "ALLOW_FILE_ACCESS=NO", nullptr};
  if (reference.SetFromUserInput(text.c_str(), options) != OGRERR_NONE) return {};
  return gdal::crs_wkt_of(&reference);
}

std::string short_crs(const std::string& crs_wkt) {
  if (crs_wkt.empty()) return {};
  const gdal::ErrorLog log;
  OGRSpatialReference reference;
  if (reference.importFromWkt(crs_wkt.c_str()) != OGRERR_NONE) return {};
  const char* authority = reference.GetAuthorityName(nullptr);
  const char* code = reference.GetAuthorityCode(nullptr);
  if (authority != nullptr && code != nullptr) {
    const std::string name = std::string(authority) + ":" + code;
    if (same_crs(name, crs_wkt)) return name;
  }
  char* line = nullptr;
  const char* const options[] = {"FORMAT=WKT2_2019", "MULTILINE=NO", nullptr};
  std::string wkt;
  if (reference.exportToWkt(&line, options) == OGRERR_NONE && line != nullptr) wkt = line;
  CPLFree(line);
  return wkt;
}

}  // namespace sightbound
