// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/crs_crossing.h"

#include <limits>
#include <vector>

#include <ogr_spatialref.h>

#include "base/error.h"
#include "io/crs.h"
#include "io/gdal_support.h"

namespace sightbound {

struct CrsCrossing::Way {
  std::unique_ptr<OGRCoordinateTransformation> forward;
};

namespace {

OGRSpatialReference reference_of(const std::string& wkt) {
  OGRSpatialReference reference;
  reference.importFromWkt(horizontal_crs(wkt).c_str());
  reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return reference;
}

}  // namespace

CrsCrossing::CrsCrossing(const std::string& from_wkt, const std::string& to_wkt, const std::string& what) {
  if (from_wkt.empty() || to_wkt.empty()) return;
  if (same_crs(horizontal_crs(from_wkt), horizontal_crs(to_wkt))) return;
  const OGRSpatialReference from = reference_of(from_wkt), to = reference_of(to_wkt);
  const gdal::ErrorLog log;
  way_ = std::make_unique<Way>();
  way_->forward.reset(OGRCreateCoordinateTransformation(&from, &to));
  if (!way_->forward) {
    throw InvalidInput(
        what + " and the DEM have coordinate systems between which there is no way: " + log.message());
  }
}

CrsCrossing::~CrsCrossing() = default;
CrsCrossing::CrsCrossing(CrsCrossing&&) noexcept = default;

void CrsCrossing::apply(std::span<double> x, std::span<double> y) const {
  if (is_identity() || x.empty()) return;
  const gdal::ErrorLog log;
  std::vector<int> done(x.size());
  way_->forward->Transform(static_cast<int>(x.size()), x.data(), y.data(), nullptr, done.data());
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!done[i]) x[i] = y[i] = std::numeric_limits<double>::infinity();
  }
}

}  // namespace sightbound
