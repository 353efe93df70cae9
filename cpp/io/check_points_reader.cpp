// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/check_points_reader.h"

#include <cmath>
#include <span>

#include <ogrsf_frmts.h>

#include "base/error.h"
#include "io/crs.h"
#include "io/crs_crossing.h"
#include "io/gdal_support.h"
#include "io/vertical_unit.h"

namespace sightbound {

namespace {

constexpr const char* kWhat = "The check points";

std::string named(const CheckPointFile& file) { return std::string(kWhat) + " '" + file.path + "'"; }

OGRLayer& layer_of(GDALDataset& dataset, const CheckPointFile& file) {
  std::string names;
  for (OGRLayer* layer : dataset.GetLayers()) {
    names += (names.empty() ? "'" : ", '") + std::string(layer->GetName()) + "'";
  }
  if (file.layer.empty() && dataset.GetLayerCount() > 1)
    throw InvalidInput(named(file) + " have several layers: " + names + "; name one.");
  OGRLayer* layer = file.layer.empty() ? dataset.GetLayer(0) : dataset.GetLayerByName(file.layer.c_str());
  if (layer == nullptr) {
    throw InvalidInput(named(file) + ": there is no layer '" + file.layer + "'; the file has " +
                       (names.empty() ? "none" : names) + ".");
  }
  return *layer;
}

// -1 for Z of the geometry.
int elevation_field(OGRLayer& layer, const CheckPointFile& file) {
  if (file.elevation_field.empty()) return -1;
  const OGRFeatureDefn& definition = *layer.GetLayerDefn();
  const int field = definition.GetFieldIndex(file.elevation_field.c_str());
  if (field < 0) {
    std::string names;
    for (int i = 0; i < definition.GetFieldCount(); ++i)
      names += (i > 0 ? ", '" : "'") + std::string(definition.GetFieldDefn(i)->GetNameRef()) + "'";
    throw InvalidInput(named(file) + ": there is no field '" + file.elevation_field + "'; the layer has " +
                       (names.empty() ? "none" : names) + ".");
  }
  const OGRFieldType type = definition.GetFieldDefn(field)->GetType();
  if (type != OFTReal && type != OFTInteger && type != OFTInteger64) {
    throw InvalidInput(named(file) + ": the field '" + file.elevation_field +
                       "' holds no numbers; name the field of the elevations.");
  }
  return field;
}

class Collector {
 public:
  Collector(const CheckPointFile& file, int field, std::vector<Xyz>& out)
      : file_(file), field_(field), out_(out) {}

  void add(const OGRFeature& feature) {
    const OGRGeometry* geometry = feature.GetGeometryRef();
    const bool told = field_ < 0 || feature.IsFieldSetAndNotNull(field_) != 0;
    if (geometry == nullptr || geometry->IsEmpty() || !told) {
      ++empty_;
      return;
    }
    const double height = field_ < 0 ? 0 : feature.GetFieldAsDouble(field_);
    const OGRwkbGeometryType type = wkbFlatten(geometry->getGeometryType());
    if (type == wkbPoint) {
      add_point(*geometry->toPoint(), height, feature);
    } else if (type == wkbMultiPoint) {
      for (const OGRPoint* point : *geometry->toMultiPoint()) add_point(*point, height, feature);
    } else {
      throw InvalidInput(named(file_) + ": feature " + std::to_string(feature.GetFID()) +
                         " is no point; give points.");
    }
  }

  std::size_t empty() const { return empty_; }

 private:
  void add_point(const OGRPoint& point, double height, const OGRFeature& feature) {
    if (field_ < 0 && !point.Is3D()) {
      throw InvalidInput(named(file_) + ": feature " + std::to_string(feature.GetFID()) +
                         " has no Z; give 3D points, or the field of the elevations.");
    }
    const double z = field_ < 0 ? point.getZ() : height;
    if (std::isfinite(point.getX()) && std::isfinite(point.getY()) && std::isfinite(z)) {
      out_.push_back({point.getX(), point.getY(), z});
    } else {
      ++empty_;
    }
  }

  const CheckPointFile& file_;
  int field_;
  std::vector<Xyz>& out_;
  std::size_t empty_ = 0;
};

}  // namespace

CheckPoints read_check_points(const CheckPointFile& file, const DemSource& dem, Progress& progress) {
  const GDALDatasetUniquePtr dataset = gdal::open(file.path, GDAL_OF_VECTOR, kWhat);
  OGRLayer& layer = layer_of(*dataset, file);
  const std::string crs = gdal::crs_wkt_of(layer.GetSpatialRef());
  CheckPoints out;
  Collector collector(file, elevation_field(layer, file), out.places);
  for (const auto& feature : layer) {
    progress.check();
    collector.add(*feature);
  }
  if (out.places.empty()) {
    throw InvalidInput(named(file) + ": the layer '" + layer.GetName() +
                       "' is empty; it needs points with elevations.");
  }
  if (collector.empty() > 0) {
    out.notes.push_back(std::to_string(collector.empty()) +
                        " check points without place or elevation were left out.");
  }
  if (crs.empty() != dem.crs_wkt().empty()) {
    out.notes.push_back("The " + std::string(crs.empty() ? "check points have" : "DEM has") +
                        " no CRS; both were taken to be in the same.");
  }
  const VerticalScale scale = choose_vertical_unit(file.vertical_unit, crs_units(crs), "");
  for (const std::string& note : scale.notes) out.notes.push_back("Check points: " + note);

  const CrsCrossing crossing(crs, dem.crs_wkt(), kWhat);
  std::vector<double> x, y;
  for (const Xyz& place : out.places) x.push_back(place.x), y.push_back(place.y);
  crossing.apply(x, y);
  for (std::size_t i = 0; i < x.size(); ++i)
    out.places[i] = {x[i], y[i], out.places[i].z * scale.metres_per_unit};
  return out;
}

}  // namespace sightbound
