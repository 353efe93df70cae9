// SPDX-License-Identifier: GPL-3.0-or-later
// Polygons in the DEM's CRS, burnt in ascending order of their value so that the largest is what stays on
// overlap; a cell belongs to the polygon that holds its centre (the sample).
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <gdal_alg.h>
#include <ogrsf_frmts.h>

#include "base/error.h"
#include "io/crs.h"
#include "io/error_rasters.h"
#include "io/gdal_support.h"
#include "io/grid_dataset.h"

namespace sightbound {

namespace {

constexpr const char* kWhat = "The terrain types";

using Geometry = std::unique_ptr<OGRGeometry>;
using Transformation = std::unique_ptr<OGRCoordinateTransformation>;

struct Polygon {
  double metres;
  Geometry shape;
};

std::string named(const TerrainTypes& types) { return std::string(kWhat) + " '" + types.path + "'"; }

template <class Names>
std::string listed(const Names& names) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "'" : ", '") + name + "'";
  return text;
}

OGRLayer& layer_of(GDALDataset& dataset, const TerrainTypes& types) {
  OGRLayer* layer = types.layer.empty() ? dataset.GetLayer(0) : dataset.GetLayerByName(types.layer.c_str());
  if (layer == nullptr) {
    std::vector<std::string> names;
    for (OGRLayer* other : dataset.GetLayers()) names.emplace_back(other->GetName());
    throw InvalidInput(named(types) + ": there is no layer '" + types.layer + "'; the file has " +
                       (names.empty() ? "none" : listed(names)) + ".");
  }
  if (layer->GetFeatureCount() == 0) {
    throw InvalidInput(named(types) + ": the layer '" + layer->GetName() + "' is empty; it needs polygons.");
  }
  return *layer;
}

int field_of(OGRLayer& layer, const TerrainTypes& types) {
  const int field = layer.GetLayerDefn()->GetFieldIndex(types.field.c_str());
  if (field >= 0) return field;
  std::vector<std::string> names;
  const OGRFeatureDefn& definition = *layer.GetLayerDefn();
  for (int i = 0; i < definition.GetFieldCount(); ++i)
    names.emplace_back(definition.GetFieldDefn(i)->GetNameRef());
  throw InvalidInput(named(types) + ": there is no field '" + types.field + "'; the layer has " +
                     (names.empty() ? "none" : listed(names)) + ".");
}

// Values of features: metres, or classes looked up in the table.
class Values {
 public:
  Values(const TerrainTypes& types, OGRFieldType type)
      : types_(types),
        table_(types.table.empty() ? default_terrain_table() : types.table),
        // Whole numbers beside a table of one's own are codes of classes (a land-cover map's).
        classes_(type == OFTString ||
                 (!types.table.empty() && (type == OFTInteger || type == OFTInteger64))) {
    if (type != OFTString && type != OFTInteger && type != OFTInteger64 && type != OFTReal) {
      throw InvalidInput(named(types) + ": the field '" + types.field + "' holds neither numbers nor text.");
    }
  }

  // Empty for an unknown class, which is remembered.
  std::optional<double> of(const OGRFeature& feature, int field) {
    const std::string where =
        named(types_) + ": feature " + std::to_string(feature.GetFID()) + ", field '" + types_.field + "'";
    if (!feature.IsFieldSetAndNotNull(field)) {
      throw InvalidInput(where + " is NULL; give every polygon a value or remove it.");
    }
    double metres = 0;
    if (classes_) {
      const std::string name = feature.GetFieldAsString(field);
      const auto found = table_.find(name);
      if (found == table_.end()) {
        unknown_.insert(name);
        return {};
      }
      metres = found->second;
    } else {
      metres = feature.GetFieldAsDouble(field);
    }
    if (!std::isfinite(metres) || metres < 0) {
      throw InvalidInput(where + " is " + std::to_string(metres) + "; give 0 or more metres.");
    }
    return metres;
  }

  void refuse_unknown() const {
    if (unknown_.empty()) return;
    std::vector<std::string> known;
    for (const auto& [name, metres] : table_) known.push_back(name);
    throw InvalidInput(named(types_) + ": the field '" + types_.field +
                       "' holds classes that the table does not know: " + listed(unknown_) + ". Known are " +
                       listed(known) + ". Add them to the table or correct them.");
  }

 private:
  const TerrainTypes& types_;
  std::map<std::string, double> table_;
  bool classes_;
  std::set<std::string> unknown_;
};

// From the layer's CRS to the DEM's; empty when they are taken to be the same.
struct Crossing {
  OGRSpatialReference layer, dem;
  Transformation forward;
};

std::unique_ptr<Crossing> crossing_of(OGRLayer& layer, const DemSource& dem, const TerrainTypes& types) {
  const OGRSpatialReference* crs = layer.GetSpatialRef();
  if (crs == nullptr || crs->IsEmpty() || dem.crs_wkt().empty()) return {};
  auto crossing = std::make_unique<Crossing>();
  crossing->layer.importFromWkt(horizontal_crs(gdal::crs_wkt_of(crs)).c_str());
  crossing->dem.importFromWkt(horizontal_crs(dem.crs_wkt()).c_str());
  crossing->layer.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  crossing->dem.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const gdal::ErrorLog log;
  crossing->forward.reset(OGRCreateCoordinateTransformation(&crossing->layer, &crossing->dem));
  if (!crossing->forward) {
    throw InvalidInput(named(types) + " cannot be brought into the DEM's CRS: " + log.message());
  }
  return crossing;
}

// Leaves only features near the window to be read, when the window's box can be expressed in the layer's CRS.
void filter_to(OGRLayer& layer, const Crossing* crossing, const DemSource& dem, const Window& window) {
  OGREnvelope box;
  for (const double row : {window.row - 0.5, window.row_end() - 0.5}) {
    for (const double col : {window.col - 0.5, window.col_end() - 0.5}) {
      const Xy corner = dem.geotransform().of_sample(col, row);
      box.Merge(corner.x, corner.y);
    }
  }
  if (crossing != nullptr) {
    const gdal::ErrorLog log;
    const Transformation back(crossing->forward->GetInverse());
    constexpr int kPointsPerEdge = 21;
    OGREnvelope in_layer;
    if (!back || !back->TransformBounds(box.MinX, box.MinY, box.MaxX, box.MaxY, &in_layer.MinX,
                                        &in_layer.MinY, &in_layer.MaxX, &in_layer.MaxY, kPointsPerEdge)) {
      return;
    }
    if (in_layer.MinX > in_layer.MaxX) return;  // across the date line
    const double margin = 0.01 * std::max(in_layer.MaxX - in_layer.MinX, in_layer.MaxY - in_layer.MinY);
    box = in_layer;
    box.MinX -= margin, box.MinY -= margin, box.MaxX += margin, box.MaxY += margin;
  }
  layer.SetSpatialFilterRect(box.MinX, box.MinY, box.MaxX, box.MaxY);
}

Geometry shape_of(OGRFeature& feature, const Crossing* crossing, const TerrainTypes& types) {
  Geometry shape(feature.StealGeometry());
  if (!shape || shape->IsEmpty()) return {};
  if (OGR_GT_IsNonLinear(shape->getGeometryType())) shape.reset(shape->getLinearGeometry());
  const OGRwkbGeometryType kind = shape ? wkbFlatten(shape->getGeometryType()) : wkbUnknown;
  const std::string where = named(types) + ": feature " + std::to_string(feature.GetFID());
  if (kind != wkbPolygon && kind != wkbMultiPolygon)
    throw InvalidInput(where + " is no polygon; give polygons.");
  if (crossing != nullptr) {
    const gdal::ErrorLog log;
    if (shape->transform(crossing->forward.get()) != OGRERR_NONE) {
      throw InvalidInput(where + " cannot be brought into the DEM's CRS: " + log.message());
    }
  }
  return shape;
}

std::vector<Polygon> polygons_of(OGRLayer& layer, int field, const Crossing* crossing,
                                 const TerrainTypes& types, Progress& progress) {
  Values values(types, layer.GetLayerDefn()->GetFieldDefn(field)->GetType());
  std::vector<Polygon> polygons;
  layer.ResetReading();
  while (true) {
    const gdal::ErrorLog log;
    const std::unique_ptr<OGRFeature> feature(layer.GetNextFeature());
    if (log.failed()) throw IoError(named(types) + " cannot be read: " + log.message());
    if (!feature) break;
    const std::optional<double> metres = values.of(*feature, field);
    Geometry shape = shape_of(*feature, crossing, types);
    if (metres && shape) polygons.push_back({*metres, std::move(shape)});
    progress.check();
  }
  values.refuse_unknown();
  std::stable_sort(polygons.begin(), polygons.end(),
                   [](const Polygon& a, const Polygon& b) { return a.metres < b.metres; });
  return polygons;
}

// Rows of the grid that a polygon may touch, [first, end).
struct Rows {
  double first, end;
};
Rows rows_of(const Polygon& polygon, const Geotransform& geotransform) {
  OGREnvelope box;
  polygon.shape->getEnvelope(&box);
  Rows rows{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const double x : {box.MinX, box.MaxX}) {
    for (const double y : {box.MinY, box.MaxY}) {
      const double row = geotransform.to_raster(x, y).y;
      rows = {std::min(rows.first, row - 1), std::max(rows.end, row + 2)};
    }
  }
  return rows;
}

// Strip by strip, each with the polygons that touch it.
void burn(const std::vector<Polygon>& polygons, Grid<float>& grid, const Geotransform& geotransform,
          const TerrainTypes& types, Progress& progress) {
  constexpr int kStripCells = 2'000'000;  // some 20 ms: the grain of cancelling
  const int strip_rows = std::clamp(kStripCells / grid.cols(), 1, grid.rows());
  std::vector<Rows> touched;
  for (const Polygon& polygon : polygons) touched.push_back(rows_of(polygon, geotransform));

  for (int row = 0; row < grid.rows(); row += strip_rows) {
    progress.check();
    const int rows = std::min(strip_rows, grid.rows() - row);
    std::vector<OGRGeometryH> shapes;
    std::vector<double> metres;
    for (std::size_t i = 0; i < polygons.size(); ++i) {
      if (touched[i].end <= row || touched[i].first >= row + rows) continue;
      shapes.push_back(OGRGeometry::ToHandle(polygons[i].shape.get()));
      metres.push_back(polygons[i].metres);
    }
    if (shapes.empty()) continue;
    const gdal::ErrorLog log;
    const GDALDatasetUniquePtr target = gdal::dataset_over(grid, geotransform, row, rows);
    const int band = 1;
    gdal::ProgressBridge bridge(progress);
    const CPLErr failed = GDALRasterizeGeometries(
        GDALDataset::ToHandle(target.get()), 1, &band, static_cast<int>(shapes.size()), shapes.data(),
        nullptr, nullptr, metres.data(), nullptr, gdal::ProgressBridge::call, &bridge);
    bridge.rethrow();
    if (failed != CE_None)
      throw IoError(named(types) + " cannot be burnt into the DEM's grid: " + log.message());
  }
}

}  // namespace

Grid<float> terrain_type_variation(const TerrainTypes& types, const DemSource& dem, const Window& window,
                                   Progress& progress) {
  const GDALDatasetUniquePtr dataset = gdal::open(types.path, GDAL_OF_VECTOR, kWhat);
  OGRLayer& layer = layer_of(*dataset, types);
  const int field = field_of(layer, types);
  const std::unique_ptr<Crossing> crossing = crossing_of(layer, dem, types);
  filter_to(layer, crossing.get(), dem, window);
  const std::vector<Polygon> polygons = polygons_of(layer, field, crossing.get(), types, progress);
  if (polygons.empty()) {
    throw InvalidInput(named(types) +
                       ": no polygon lies in the part of the DEM that is used; check the layer's CRS.");
  }
  Grid<float> out(window.rows, window.cols, std::numeric_limits<float>::quiet_NaN());
  burn(polygons, out, dem.geotransform().of_window(window), types, progress);
  return out;
}

}  // namespace sightbound
