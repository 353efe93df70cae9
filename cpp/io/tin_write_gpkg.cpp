// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <memory>

#include <ogrsf_frmts.h>

#include "base/error.h"
#include "io/gdal_support.h"
#include "io/tin_writers.h"

namespace sightbound {

void write_gpkg(const std::string& path, const std::string& layer_name, const Tin& tin, Progress& progress) {
  constexpr std::size_t kFacesPerReport = 1 << 12;
  gdal::register_drivers();
  const gdal::ErrorLog log;
  const auto fail = [&] {
    throw IoError("The GeoPackage cannot be written: " + log.message("the disk is full, or went away."));
  };
  // The file's ending comes with its renaming; no journal is left beside it when it is closed.
  const gdal::ThreadOption no_sync("OGR_SQLITE_SYNCHRONOUS", "OFF");
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GPKG");
  if (driver == nullptr) throw IoError("This GDAL knows no GeoPackage; write PLY.");
  GDALDatasetUniquePtr dataset(driver->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  if (!dataset) fail();

  OGRSpatialReference crs;
  const bool has_crs = !tin.crs_wkt.empty() && crs.importFromWkt(tin.crs_wkt.c_str()) == OGRERR_NONE;
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  OGRLayer* layer = dataset->CreateLayer(layer_name.empty() ? "tin" : layer_name.c_str(),
                                         has_crs ? &crs : nullptr, wkbPolygon25D, nullptr);
  if (layer == nullptr) fail();
  const std::vector<NamedValues> values = face_values(tin, {"fid", "geom"});
  for (const NamedValues& one : values) {
    OGRFieldDefn field(one.name.c_str(), OFTReal);
    field.SetSubType(OFSTFloat32);
    if (layer->CreateField(&field) != OGRERR_NONE) fail();
  }
  if (dataset->StartTransaction() != OGRERR_NONE) fail();
  for (std::size_t f = 0; f < tin.faces.size(); ++f) {
    auto ring = std::make_unique<OGRLinearRing>();
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{0}}) {
      const Xyz p = tin.to_crs(tin.vertices[static_cast<std::size_t>(tin.faces[f][i])]);
      ring->addPoint(p.x, p.y, p.z);
    }
    auto polygon = std::make_unique<OGRPolygon>();
    polygon->addRingDirectly(ring.release());
    const OGRFeatureUniquePtr feature(OGRFeature::CreateFeature(layer->GetLayerDefn()));
    for (std::size_t i = 0; i < values.size(); ++i) {
      const float value = (*values[i].values)[f];
      if (!std::isnan(value)) feature->SetField(static_cast<int>(i), static_cast<double>(value));
    }
    feature->SetGeometryDirectly(polygon.release());
    if (layer->CreateFeature(feature.get()) != OGRERR_NONE) fail();
    if ((f + 1) % kFacesPerReport == 0) progress.advance(kFacesPerReport);
  }
  progress.advance(static_cast<double>(tin.faces.size() % kFacesPerReport + tin.vertices.size()));
  if (dataset->CommitTransaction() != OGRERR_NONE) fail();
  dataset.reset();
  if (log.failed()) fail();
}

}  // namespace sightbound
