// SPDX-License-Identifier: GPL-3.0-or-later
// A CRS is peeled down to its horizontal part (compound -> first member, bound -> source) and connected to
// longitude and latitude in degrees on its own datum: the inverse of its projection and nothing else, so no
// grids and no network.
#include "io/crs.h"

#include <array>
#include <cmath>
#include <memory>
#include <mutex>
#include <numbers>
#include <utility>
#include <vector>

#include <cpl_string.h>
#include <ogr_spatialref.h>
#include <ogr_srs_api.h>
#include <proj.h>

#include "base/error.h"
#include "io/gdal_support.h"

namespace sightbound {

namespace {

struct ContextDelete {
  void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
};
struct PjDelete {
  void operator()(PJ* object) const { proj_destroy(object); }
};
using Context = std::unique_ptr<PJ_CONTEXT, ContextDelete>;
using Pj = std::unique_ptr<PJ, PjDelete>;

Context new_context() {
  Context context(proj_context_create());
  proj_log_level(context.get(), PJ_LOG_NONE);
  proj_context_set_enable_network(context.get(), 0);
  const CPLStringList paths(OSRGetPROJSearchPaths());  // where GDAL found proj.db
  if (paths.Count() > 0) proj_context_set_search_paths(context.get(), paths.Count(), paths.List());
  return context;
}

[[noreturn]] void refuse(const std::string& crs, const std::string& why) {
  throw InvalidInput("The CRS " + why + ": '" + crs.substr(0, 200) +
                     "'. Assign a projected or geographic CRS.");
}

Pj parse(PJ_CONTEXT* context, const std::string& crs) {
  Pj parsed(proj_create(context, crs.c_str()));
  if (!parsed || !proj_is_crs(parsed.get())) refuse(crs, "cannot be understood");
  return parsed;
}

Pj without_bound(PJ_CONTEXT* context, Pj crs) {
  while (crs && proj_get_type(crs.get()) == PJ_TYPE_BOUND_CRS)
    crs.reset(proj_get_source_crs(context, crs.get()));
  return crs;
}

struct Parts {
  Pj horizontal, vertical;  // vertical may be empty
};

Parts take_apart(PJ_CONTEXT* context, const std::string& crs) {
  Parts parts;
  parts.horizontal = without_bound(context, parse(context, crs));
  if (parts.horizontal && proj_get_type(parts.horizontal.get()) == PJ_TYPE_COMPOUND_CRS) {
    parts.vertical = without_bound(context, Pj(proj_crs_get_sub_crs(context, parts.horizontal.get(), 1)));
    parts.horizontal = without_bound(context, Pj(proj_crs_get_sub_crs(context, parts.horizontal.get(), 0)));
  }
  if (!parts.horizontal) refuse(crs, "cannot be understood");
  return parts;
}

struct AxisUnit {
  double factor = 1;  // to metres or radians
  std::string name, category;
};

std::optional<AxisUnit> axis_unit(PJ_CONTEXT* context, PJ* crs, int axis) {
  const Pj system(proj_crs_get_coordinate_system(context, crs));
  if (!system || axis >= proj_cs_get_axis_count(context, system.get())) return {};
  AxisUnit unit;
  const char* name = nullptr;
  const char* authority = nullptr;
  const char* code = nullptr;
  if (!proj_cs_get_axis_info(context, system.get(), axis, nullptr, nullptr, nullptr, &unit.factor, &name,
                             &authority, &code)) {
    return {};
  }
  if (name != nullptr) unit.name = name;
  const char* category = nullptr;
  if (authority != nullptr && code != nullptr && *authority != '\0' &&
      proj_uom_get_info_from_database(context, authority, code, nullptr, nullptr, &category) &&
      category != nullptr) {
    unit.category = category;
  }
  return unit;
}

bool is_angle(const AxisUnit& unit) {
  if (!unit.category.empty()) return unit.category == "angular";
  for (const char* name : {"deg", "grad", "gon", "rad", "arc"}) {
    if (unit.name.find(name) != std::string::npos) return true;
  }
  return false;
}

// Longitude and latitude of a horizontal CRS, on its own datum, and the unit they come in.
struct ToGeographic {
  Pj transformation;
  double degrees_per_unit = 1;
};

ToGeographic to_geographic(PJ_CONTEXT* context, PJ* horizontal) {
  Pj geographic(proj_crs_get_geodetic_crs(context, horizontal));
  // A derived geographic CRS (rotated pole) stands on another.
  while (geographic) {
    Pj base(proj_get_source_crs(context, geographic.get()));
    if (!base) break;
    geographic = std::move(base);
  }
  if (!geographic) return {};
  const auto type = proj_get_type(geographic.get());
  const std::optional<AxisUnit> unit = axis_unit(context, geographic.get(), 0);
  if ((type != PJ_TYPE_GEOGRAPHIC_2D_CRS && type != PJ_TYPE_GEOGRAPHIC_3D_CRS) || !unit) return {};
  const Pj direct(proj_create_crs_to_crs_from_pj(context, horizontal, geographic.get(), nullptr, nullptr));
  if (!direct) return {};
  const double degrees = unit->factor * 180 / std::numbers::pi;
  return {Pj(proj_normalize_for_visualization(context, direct.get())),
          std::abs(degrees - 1) < 1e-12 ? 1.0 : degrees};
}

// PROJ's objects serve one thread at a time: each call borrows a copy, made when all are in use.
class LonLatPool {
 public:
  LonLatPool(Context context, ToGeographic model) : context_(std::move(context)), model_(std::move(model)) {}

  void transform(std::span<double> x, std::span<double> y) {
    Worker worker = borrow();
    proj_trans_generic(worker.transformation.get(), PJ_FWD, x.data(), sizeof(double), x.size(), y.data(),
                       sizeof(double), y.size(), nullptr, 0, 0, nullptr, 0, 0);
    if (model_.degrees_per_unit != 1) {
      for (double& longitude : x) longitude *= model_.degrees_per_unit;
      for (double& latitude : y) latitude *= model_.degrees_per_unit;
    }
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(worker));
  }

 private:
  struct Worker {
    Context context;
    Pj transformation;
  };

  Worker borrow() {
    const std::lock_guard lock(mutex_);
    Worker worker;
    if (idle_.empty()) {
      worker.context = new_context();
      worker.transformation.reset(proj_clone(worker.context.get(), model_.transformation.get()));
    } else {
      worker = std::move(idle_.back());
      idle_.pop_back();
    }
    return worker;
  }

  std::mutex mutex_;
  Context context_;
  ToGeographic model_;
  std::vector<Worker> idle_;
};

Ellipsoid ellipsoid_of(PJ_CONTEXT* context, PJ* horizontal, const std::string& crs) {
  const Pj found(proj_get_ellipsoid(context, horizontal));
  double semi_major = 0, inverse_flattening = 0;
  if (!found || !proj_ellipsoid_get_parameters(context, found.get(), &semi_major, nullptr, nullptr,
                                               &inverse_flattening)) {
    refuse(crs, "has no ellipsoid");
  }
  return {semi_major, inverse_flattening == 0 ? 0 : 1 / inverse_flattening};
}

Georeference plane_of_local_crs(PJ_CONTEXT* context, PJ* horizontal, const std::string& crs,
                                const Geotransform& geotransform) {
  const std::optional<AxisUnit> unit = axis_unit(context, horizontal, 0);
  if (!unit || is_angle(*unit)) refuse(crs, "has no map coordinates");
  std::array<double, 6> g = geotransform.coefficients();
  for (double& coefficient : g) coefficient *= unit->factor;
  return Georeference(Geotransform(g));
}

}  // namespace

namespace {

bool looks_like_degrees(const Geotransform& geotransform, int rows, int cols) {
  constexpr double kLargestCell = 0.1;  // degrees; coarser global grids are no DEMs one looks around in
  const auto& g = geotransform.coefficients();
  if (std::hypot(g[1], g[4]) >= kLargestCell || std::hypot(g[2], g[5]) >= kLargestCell) return false;
  for (const double row : {0.0, rows - 1.0}) {
    for (const double col : {0.0, cols - 1.0}) {
      const Xy p = geotransform.of_sample(col, row);
      if (std::abs(p.x) > 360 || std::abs(p.y) > 90) return false;
    }
  }
  return true;
}

// A projected CRS given to a raster in degrees makes cells of millimetres, far from where the CRS is meant
// for.
void refuse_degrees_as_lengths(PJ_CONTEXT* context, PJ* horizontal, const DemSource& dem,
                               const Georeference& georeference) {
  if (proj_get_type(horizontal) != PJ_TYPE_PROJECTED_CRS) return;
  if (!looks_like_degrees(dem.geotransform(), dem.rows(), dem.cols())) return;
  double west = 0, south = 0, east = 0, north = 0;
  const char* area = nullptr;
  if (!proj_get_area_of_use(context, horizontal, &west, &south, &east, &north, &area) || west < -360) return;
  const LonLat middle = georeference.lon_lat((dem.cols() - 1) / 2.0, (dem.rows() - 1) / 2.0);
  const double beyond_west = std::fmod(std::fmod(middle.lon - west, 360) + 360, 360);
  // 0 for a worldwide CRS: near its origin, in the Gulf of Guinea, there is no terrain.
  const double width = std::fmod(std::fmod(east - west, 360) + 360, 360);
  if (beyond_west <= width && middle.lat >= south && middle.lat <= north) return;
  const char* name = proj_get_name(horizontal);
  throw InvalidInput(
      "The DEM's coordinates look like degrees (within 360 and 90, cells below 0.1), but its CRS '" +
      std::string(name != nullptr ? name : "") +
      "' measures lengths and is not meant for the place they would be. Assign the right CRS, EPSG:4326 for "
      "example.");
}

}  // namespace

void refuse_degrees_without_crs(const Geotransform& geotransform, int rows, int cols) {
  if (!looks_like_degrees(geotransform, rows, cols)) return;
  throw InvalidInput(
      "The DEM has no CRS and its coordinates look like degrees (within 360 and 90, cells below 0.1): as "
      "metres its "
      "cells would be centimetres wide. Assign its CRS, EPSG:4326 for example.");
}

Georeference georeference_of(const DemSource& dem) {
  if (dem.crs_wkt().empty()) {
    refuse_degrees_without_crs(dem.geotransform(), dem.rows(), dem.cols());
    return Georeference(dem.geotransform());
  }
  const std::string& crs = dem.crs_wkt();
  Context context = new_context();
  const Parts parts = take_apart(context.get(), crs);
  switch (proj_get_type(parts.horizontal.get())) {
    case PJ_TYPE_VERTICAL_CRS:
    case PJ_TYPE_GEOCENTRIC_CRS:
    case PJ_TYPE_TEMPORAL_CRS:
      refuse(crs, "has no map coordinates");
    case PJ_TYPE_OTHER_CRS:
    case PJ_TYPE_ENGINEERING_CRS:
      return plane_of_local_crs(context.get(), parts.horizontal.get(), crs, dem.geotransform());
    default:
      break;
  }
  const Ellipsoid ellipsoid = ellipsoid_of(context.get(), parts.horizontal.get(), crs);
  ToGeographic model = to_geographic(context.get(), parts.horizontal.get());
  if (!model.transformation) refuse(crs, "cannot be converted to longitude and latitude");
  Context own = new_context();  // outlives this call, unlike the one that the parts live in
  model.transformation.reset(proj_clone(own.get(), model.transformation.get()));
  auto pool = std::make_shared<LonLatPool>(std::move(own), std::move(model));
  Georeference georeference(dem.geotransform(), ellipsoid,
                            [pool](std::span<double> x, std::span<double> y) { pool->transform(x, y); });
  refuse_degrees_as_lengths(context.get(), parts.horizontal.get(), dem, georeference);
  return georeference;
}

bool same_crs(const std::string& a, const std::string& b) {
  if (a == b) return true;
  const gdal::ErrorLog log;
  OGRSpatialReference first, second;
  if (first.SetFromUserInput(a.c_str()) != OGRERR_NONE || second.SetFromUserInput(b.c_str()) != OGRERR_NONE)
    return false;
  const char* const options[] = {"CRITERION=EQUIVALENT", "IGNORE_DATA_AXIS_TO_SRS_AXIS_MAPPING=YES", nullptr};
  return first.IsSame(&second, options) != 0;
}

CrsUnits crs_units(const std::string& crs) {
  CrsUnits units;
  if (crs.empty()) return units;
  const Context context = new_context();
  const Parts parts = take_apart(context.get(), crs);
  if (const auto unit = axis_unit(context.get(), parts.horizontal.get(), 0)) {
    units.horizontal_name = unit->name;
    if (!is_angle(*unit)) units.horizontal_m = unit->factor;
  }
  const auto vertical = parts.vertical ? axis_unit(context.get(), parts.vertical.get(), 0)
                                       : axis_unit(context.get(), parts.horizontal.get(), 2);
  if (vertical) {
    units.vertical_name = vertical->name;
    units.vertical_m = vertical->factor;
  }
  return units;
}

std::string horizontal_crs(const std::string& crs) {
  if (crs.empty()) return {};
  const gdal::ErrorLog log;
  OGRSpatialReference reference;
  if (reference.SetFromUserInput(crs.c_str()) != OGRERR_NONE) refuse(crs, "cannot be understood");
  reference.StripVertical();
  reference.DemoteTo2D(nullptr);
  return gdal::crs_wkt_of(&reference);
}

}  // namespace sightbound
