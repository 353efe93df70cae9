// SPDX-License-Identifier: GPL-3.0-or-later
// Layers are walked feature by feature. Polygons bring corners of their own, which clean() joins where they
// coincide; points and lines become one survey.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>

#include <ogrsf_frmts.h>

#include "base/error.h"
#include "io/crs.h"
#include "io/gdal_support.h"
#include "io/tin_formats.h"

namespace sightbound {

namespace {

constexpr const char* kSigmaField = "sigma_v";

// GeoPackages say of layers without a CRS that theirs is undefined.
std::string crs_of(OGRLayer& layer) {
  const OGRSpatialReference* crs = layer.GetSpatialRef();
  const char* name = crs != nullptr ? crs->GetName() : nullptr;
  if (name == nullptr || std::string_view(name).starts_with("Undefined ")) return {};
  return gdal::crs_wkt_of(crs);
}

class Collector {
 public:
  Collector(TinSource& source, const TinReadOptions& options, const std::string& what)
      : source_(source), options_(options), what_(what), faces_(source.tin, what) {}

  void add_layer(OGRLayer& layer, Progress& progress) {
    name_ = layer.GetName();
    take_crs(crs_of(layer));
    choose_fields(*layer.GetLayerDefn());
    for (const auto& feature : layer) {
      progress.check();
      const OGRGeometry* geometry = feature->GetGeometryRef();
      if (geometry == nullptr || geometry->IsEmpty()) {
        ++empty_;
        continue;
      }
      take_values(*feature);
      add(*geometry);
    }
  }

  void finish() {
    const bool polygons = faces_.polygons() > 0, survey = !source_.survey.points.empty();
    if (polygons && survey) {
      throw InvalidInput(what_ +
                         " mixes polygons with points or lines; name the layers of one kind as layer.");
    }
    if (!polygons && !survey) {
      throw InvalidInput(
          what_ + " has no 3D polygons, points or lines" +
          (other_ > 0 ? " (" + std::to_string(other_) + " geometries are of other kinds)." : "."));
    }
    // A field that only some layers have ends early in the others.
    const std::size_t rows = polygons ? faces_.polygons() : source_.survey.points.size();
    for (TinAttribute& one : attributes_) one.values.resize(rows, std::nanf(""));
    if (polygons) {
      faces_.finish(std::move(attributes_));
    } else {
      const auto sigma = std::find_if(attributes_.begin(), attributes_.end(),
                                      [](const auto& a) { return a.name == kSigmaField; });
      if (sigma != attributes_.end()) {
        source_.tin.sigma_v = std::move(sigma->values);
        attributes_.erase(sigma);
      }
      source_.tin.vertex_attributes = std::move(attributes_);
    }
    if (empty_ > 0)
      source_.tin.notes.push_back(std::to_string(empty_) + " features without geometry left out.");
    if (other_ > 0)
      source_.tin.notes.push_back(std::to_string(other_) + " geometries of other kinds left out.");
  }

 private:
  void take_crs(const std::string& crs) {
    if (!first_layer_ && !same_crs(crs, source_.crs)) {
      throw InvalidInput(what_ + ": layer '" + name_ +
                         "' has another CRS than the layers before it; reproject it.");
    }
    source_.crs = crs;
    first_layer_ = false;
  }

  // Columns of numbers, but the one of heights.
  void choose_fields(const OGRFeatureDefn& definition) {
    fields_.clear();
    z_field_ = -1;
    for (int i = 0; i < definition.GetFieldCount(); ++i) {
      const OGRFieldDefn* field = definition.GetFieldDefn(i);
      const std::string name = field->GetNameRef();
      const OGRFieldType type = field->GetType();
      if (!options_.z_field.empty() && name == options_.z_field) {
        z_field_ = i;
      } else if (type == OFTInteger || type == OFTInteger64 || type == OFTReal) {
        fields_.push_back({i, attribute_named(name)});
      }
    }
    if (!options_.z_field.empty() && z_field_ < 0) {
      throw InvalidInput(what_ + ": layer '" + name_ + "' has no field '" + options_.z_field +
                         "' (z_field).");
    }
  }

  std::size_t attribute_named(const std::string& name) {
    for (std::size_t i = 0; i < attributes_.size(); ++i) {
      if (attributes_[i].name == name) return i;
    }
    attributes_.push_back({name, {}});
    return attributes_.size() - 1;
  }

  void take_values(const OGRFeature& feature) {
    values_.clear();
    for (const Field& field : fields_) {
      const bool told = feature.IsFieldSetAndNotNull(field.column) != 0;
      values_.push_back(told ? static_cast<float>(feature.GetFieldAsDouble(field.column)) : std::nanf(""));
    }
    z_.reset();
    if (z_field_ < 0) return;
    if (!feature.IsFieldSetAndNotNull(z_field_)) {
      throw InvalidInput(what_ + ": feature " + std::to_string(feature.GetFID()) + " of layer '" + name_ +
                         "' has no value in the field '" + options_.z_field + "' (z_field).");
    }
    z_ = feature.GetFieldAsDouble(z_field_);
  }

  // The values of the feature for its next polygon or point.
  void push_values(std::size_t row) {
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      std::vector<float>& column = attributes_[fields_[i].attribute].values;
      column.resize(row, std::nanf(""));
      column.push_back(values_[i]);
    }
  }

  void add(const OGRGeometry& geometry) {
    const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
    if (OGR_GT_IsNonLinear(type)) {
      const std::unique_ptr<OGRGeometry> straight(geometry.getLinearGeometry());
      if (straight) add(*straight);
    } else if (type == wkbPolygon || type == wkbTriangle) {
      add_polygon(*geometry.toPolygon());
    } else if (type == wkbTIN || type == wkbPolyhedralSurface) {
      for (const OGRPolygon* polygon : *geometry.toPolyhedralSurface()) add_polygon(*polygon);
    } else if (type == wkbLineString) {
      add_line(*geometry.toLineString());
    } else if (type == wkbPoint) {
      const OGRPoint& p = *geometry.toPoint();
      add_point(p.getX(), p.getY(), p.getZ(), p.Is3D() != 0);
    } else if (OGR_GT_IsSubClassOf(type, wkbGeometryCollection)) {
      for (const OGRGeometry* part : *geometry.toGeometryCollection()) add(*part);
    } else {
      ++other_;
    }
  }

  double height(double z, bool is_3d) const {
    if (z_) return *z_;
    if (is_3d) return z;
    throw InvalidInput(what_ + ": layer '" + name_ +
                       "' has no heights: its geometries are 2D. Name the field that holds them as z_field, "
                       "or give a 3D layer.");
  }

  void add_polygon(const OGRPolygon& polygon) {
    std::vector<std::vector<std::int32_t>> rings;
    for (const OGRLinearRing* ring : polygon) {
      int count = ring->getNumPoints();
      const auto same = [&](int a, int b) {
        return ring->getX(a) == ring->getX(b) && ring->getY(a) == ring->getY(b) &&
               ring->getZ(a) == ring->getZ(b);
      };
      if (count > 1 && same(0, count - 1)) --count;
      rings.emplace_back();
      for (int i = 0; i < count; ++i) {
        rings.back().push_back(static_cast<std::int32_t>(source_.tin.vertices.size()));
        source_.tin.vertices.push_back(
            {ring->getX(i), ring->getY(i), height(ring->getZ(i), ring->Is3D() != 0)});
      }
    }
    if (rings.empty()) {
      ++empty_;
      return;
    }
    push_values(faces_.polygons());
    faces_.add_rings(rings);
  }

  void add_point(double x, double y, double z, bool is_3d) {
    push_values(source_.survey.points.size());
    source_.survey.points.push_back({x, y, height(z, is_3d)});
  }

  void add_line(const OGRLineString& line) {
    std::vector<std::int32_t> breakline;
    for (int i = 0; i < line.getNumPoints(); ++i) {
      breakline.push_back(static_cast<std::int32_t>(source_.survey.points.size()));
      add_point(line.getX(i), line.getY(i), line.getZ(i), line.Is3D() != 0);
    }
    source_.survey.breaklines.push_back(std::move(breakline));
  }

  struct Field {
    int column;
    std::size_t attribute;
  };

  TinSource& source_;
  const TinReadOptions& options_;
  const std::string& what_;
  FaceCollector faces_;
  std::string name_;
  bool first_layer_ = true;
  std::vector<Field> fields_;
  int z_field_ = -1;
  std::vector<TinAttribute> attributes_;  // of polygons or points
  std::vector<float> values_;
  std::optional<double> z_;
  std::size_t empty_ = 0, other_ = 0;
};

std::vector<std::string> names_of(GDALDataset& dataset) {
  std::vector<std::string> names;
  for (OGRLayer* layer : dataset.GetLayers()) names.emplace_back(layer->GetName());
  return names;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "'" : ", '") + name + "'";
  return text;
}

}  // namespace

std::vector<std::string> vector_layers(const std::string& path) {
  const GDALDatasetUniquePtr dataset = gdal::open(path, GDAL_OF_VECTOR, "The TIN");
  const gdal::ErrorLog log;
  return names_of(*dataset);
}

TinSource read_vector_tin(const std::string& path, const TinReadOptions& options, const std::string& what,
                          Progress& progress) {
  const GDALDatasetUniquePtr dataset = gdal::open(path, GDAL_OF_VECTOR, "The TIN");
  const gdal::ErrorLog log;
  const std::vector<std::string> names = names_of(*dataset);
  std::vector<std::string> wanted = options.layers;
  if (wanted.empty()) {
    if (names.size() != 1) {
      throw InvalidInput(
          what + " has " + std::to_string(names.size()) + " layers" +
          (names.empty() ? "."
                         : ": " + listed(names) + ". Name one as layer, or several of points and lines."));
    }
    wanted = names;
  }
  TinSource source;
  Collector collector(source, options, what);
  for (const std::string& name : wanted) {
    OGRLayer* layer = dataset->GetLayerByName(name.c_str());
    if (layer == nullptr)
      throw InvalidInput(what + " has no layer '" + name + "'; there are " + listed(names) + ".");
    collector.add_layer(*layer, progress);
  }
  if (log.failed()) throw IoError(what + " cannot be read: " + log.message());
  collector.finish();
  return source;
}

}  // namespace sightbound
