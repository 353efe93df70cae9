// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/tin_source.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "io/crs.h"
#include "io/tin_crs.h"
#include "io/vertical_unit.h"
#include "terrain/tin_cleaning.h"
#include "terrain/triangulate_polygon.h"

namespace sightbound {

namespace {

// Factors from the source's lengths to units of the CRS in plan and to metres of height.
struct Placement {
  std::string crs_wkt;
  double plan = 1, height = 1;
  std::vector<std::string> notes;
};

std::vector<Xyz>& places_of(TinSource& source) {
  return source.survey.points.empty() ? source.tin.vertices : source.survey.points;
}

bool may_be_degrees(const std::vector<Xyz>& places) {
  return std::all_of(places.begin(), places.end(),
                     [](const Xyz& p) { return std::abs(p.x) <= 360 && std::abs(p.y) <= 90; });
}

// The CRS that holds, as WKT; in degrees only when the coordinates say so too.
std::string choose_crs(TinSource& source, const TinReadOptions& options, const std::string& what,
                       Placement& placement) {
  if (!options.crs.empty()) {
    std::string wkt = crs_from_text(options.crs);
    if (wkt.empty()) {
      throw InvalidInput("crs is '" + options.crs.substr(0, 200) +
                         "', which cannot be understood; give EPSG:32633 or the like, or WKT.");
    }
    return wkt;
  }
  if (source.crs.empty()) {
    placement.notes.push_back(what + " has no CRS: its coordinates are taken as metres on a plane.");
    return {};
  }
  std::string wkt = crs_from_text(source.crs);
  if (wkt.empty()) {
    placement.notes.push_back("The CRS of the file cannot be understood and was left out: '" +
                              source.crs.substr(0, 200) + "'.");
    return {};
  }
  if (!crs_units(wkt).horizontal_m && !may_be_degrees(places_of(source))) {
    placement.notes.push_back(
        "The file says its CRS is in degrees (" + source.crs.substr(0, 60) +
        "), but its coordinates cannot be: the CRS was left out and they are taken as metres. Give the "
        "right one as crs.");
    return {};
  }
  return wkt;
}

bool is_foot(double metres) { return metres > 0.3 && metres < 0.31; }
bool same(double a, double b) { return std::abs(a - b) <= 1e-9 * std::abs(a); }

// Heights are metres here: the CRS must not say otherwise.
std::string with_heights_in_metres(const std::string& crs_wkt) {
  const CrsUnits units = crs_units(crs_wkt);
  return units.vertical_m && !same(*units.vertical_m, 1) ? horizontal_crs(crs_wkt) : crs_wkt;
}

Placement place(TinSource& source, const TinReadOptions& options, const std::string& what) {
  Placement placement;
  placement.crs_wkt = choose_crs(source, options, what, placement);
  const double crs_metres = metres_per_plan_unit(placement.crs_wkt);
  const CrsUnits units = crs_units(placement.crs_wkt);
  if (source.unit) {
    // Software writes "foot" for either foot; the CRS knows which, and far from its origin the difference is
    // metres.
    const bool which_foot = !placement.crs_wkt.empty() && is_foot(source.unit->metres) && is_foot(crs_metres);
    placement.plan = which_foot ? 1 : source.unit->metres / crs_metres;
    if (!same(placement.plan, 1)) {
      placement.notes.push_back(
          "Coordinates converted from " + source.unit->name + " to " +
          (placement.crs_wkt.empty() ? "metres." : "the unit of the CRS (" + units.horizontal_name + ")."));
    }
  }
  if (source.unit && options.vertical_unit == VerticalUnit::kAuto) {
    placement.height = source.unit->metres;
    if (!same(placement.height, 1)) {
      placement.notes.push_back("Heights converted from " + source.unit->name +
                                " to metres, as the file says.");
    }
  } else {
    VerticalScale scale = choose_vertical_unit(options.vertical_unit, units, "");
    placement.height = scale.metres_per_unit;
    for (std::string& note : scale.notes) placement.notes.push_back(std::move(note));
  }
  placement.crs_wkt = with_heights_in_metres(placement.crs_wkt);
  return placement;
}

// Of points, to vertices; NaN where breaklines cross.
std::vector<float> picked(const std::vector<float>& values, const std::vector<std::int32_t>& points) {
  std::vector<float> out;
  out.reserve(points.size());
  for (const std::int32_t p : points) {
    out.push_back(p == Triangulation::kCrossing ? std::nanf("") : values[static_cast<std::size_t>(p)]);
  }
  return out;
}

void triangulate_survey(TinSource& source, double longest_edge, Progress& progress) {
  const auto check = [&](const std::string& name, std::size_t found) {
    if (found == source.survey.points.size()) return;
    throw InvalidInput(name + " has " + std::to_string(found) + " values for " +
                       std::to_string(source.survey.points.size()) + " points; give one each.");
  };
  Tin& tin = source.tin;
  if (!tin.sigma_v.empty()) check("sigma_v", tin.sigma_v.size());
  for (const TinAttribute& one : tin.vertex_attributes)
    check("attribute '" + one.name + "'", one.values.size());
  Triangulation made = triangulate(source.survey, {.longest_edge = longest_edge}, progress);
  source.survey = {};
  tin.vertices = std::move(made.tin.vertices);
  tin.faces = std::move(made.tin.faces);
  if (!tin.sigma_v.empty()) tin.sigma_v = picked(tin.sigma_v, made.points);
  for (TinAttribute& one : tin.vertex_attributes) one.values = picked(one.values, made.points);
  for (std::string& note : made.tin.notes) tin.notes.push_back(std::move(note));
}

}  // namespace

void TinSource::add_survey(std::vector<Xyz> points, const std::vector<std::vector<Xyz>>& breaklines) {
  const std::size_t given = points.size();
  survey.points = std::move(points);
  for (const auto& line : breaklines) {
    survey.breaklines.emplace_back();
    for (const Xyz& corner : line) {
      survey.breaklines.back().push_back(static_cast<std::int32_t>(survey.points.size()));
      survey.points.push_back(corner);
    }
  }
  // Lists of wrong length keep it, for the complaint.
  const auto lengthen = [&](std::vector<float>& values) {
    if (values.size() == given) values.resize(survey.points.size(), std::nanf(""));
  };
  if (!tin.sigma_v.empty()) lengthen(tin.sigma_v);
  for (TinAttribute& one : tin.vertex_attributes) lengthen(one.values);
}

Tin make_tin(TinSource source, const TinReadOptions& options, const std::string& what, Progress& progress) {
  Placement placement = place(source, options, what);
  if (placement.plan != 1 || placement.height != 1) {
    for (Xyz& p : places_of(source)) p = {p.x * placement.plan, p.y * placement.plan, p.z * placement.height};
    for (float& sigma : source.tin.sigma_v) sigma *= static_cast<float>(placement.height);
  }
  for (const float sigma : source.tin.sigma_v) {
    if (sigma < 0 || std::isinf(sigma)) {
      throw InvalidInput(what + ": sigma_v holds " + std::to_string(sigma) +
                         "; it must be 0 or more, or NaN where it is not known.");
    }
  }
  Tin& tin = source.tin;
  tin.notes.insert(tin.notes.begin(), placement.notes.begin(), placement.notes.end());
  const double plan_metres = metres_per_plan_unit(placement.crs_wkt);
  if (!source.survey.points.empty()) {
    if (!(options.longest_edge > 0)) {
      throw InvalidInput("longest_edge is " + std::to_string(options.longest_edge) +
                         "; it must be a positive length in metres.");
    }
    triangulate_survey(source, options.longest_edge / plan_metres, progress);
  }
  progress.check();
  Tin made = clean(std::move(tin), what);
  progress.check();
  set_origin(made, plan_metres);
  made.crs_wkt = std::move(placement.crs_wkt);
  return made;
}

RegularTin tin_of_dem(const DemSource& dem, const MemoryBudget& budget, Progress& progress) {
  RegularTin made = regular_tin(dem, metres_per_plan_unit(dem.crs_wkt()), budget, progress);
  made.tin.crs_wkt = with_heights_in_metres(made.tin.crs_wkt);
  return made;
}

void FaceCollector::push(const Face& face) {
  tin_.faces.push_back(face);
  if (cut_) polygon_of_face_.push_back(static_cast<std::int32_t>(polygons_));
}

Xyz FaceCollector::place_of(std::int32_t vertex) const {
  if (vertex < 0 || static_cast<std::size_t>(vertex) >= tin_.vertices.size()) {
    throw InvalidInput(what_ + ": face " + std::to_string(polygons_) + " (counted from 0) has vertex " +
                       std::to_string(vertex) + "; there are vertices 0 to " +
                       std::to_string(tin_.vertices.size()) + " - 1. The mesh is damaged: export it again.");
  }
  return tin_.vertices[static_cast<std::size_t>(vertex)];
}

void FaceCollector::add(std::span<const std::int32_t> corners) {
  if (corners.size() < 3) {
    throw InvalidInput(what_ + ": face " + std::to_string(polygons_) + " (counted from 0) has " +
                       std::to_string(corners.size()) + " corners; a face needs three or more.");
  }
  if (corners.size() > 3) {
    add_rings({std::vector<std::int32_t>(corners.begin(), corners.end())});
    return;
  }
  push({corners[0], corners[1], corners[2]});
  ++polygons_;
}

void FaceCollector::add_rings(const std::vector<std::vector<std::int32_t>>& rings) {
  std::vector<std::int32_t> vertices;
  std::vector<std::vector<Xyz>> places;
  for (const auto& ring : rings) {
    places.emplace_back();
    for (const std::int32_t v : ring) {
      vertices.push_back(v);
      places.back().push_back(place_of(v));
    }
  }
  // Until now each polygon was one face.
  if (!cut_ && !(rings.size() == 1 && vertices.size() == 3)) {
    for (std::size_t f = 0; f < tin_.faces.size(); ++f)
      polygon_of_face_.push_back(static_cast<std::int32_t>(f));
    cut_ = true;
  }
  const auto faces = triangulate_polygon(places);
  if (!faces) {
    ++refused_;
  } else {
    if (vertices.size() == 4) ++quads_;
    if (vertices.size() > 4) ++larger_;
    for (const Face& f : *faces) {
      const auto at = [&](std::size_t i) { return vertices[static_cast<std::size_t>(f[i])]; };
      push({at(0), at(1), at(2)});
    }
  }
  ++polygons_;
}

void FaceCollector::finish(std::vector<TinAttribute> polygon_attributes) {
  for (TinAttribute& one : polygon_attributes) {
    if (one.values.size() != polygons_) {
      throw InvalidInput(what_ + ": face attribute '" + one.name + "' has " +
                         std::to_string(one.values.size()) + " values; it must have " +
                         std::to_string(polygons_) + ", one each.");
    }
    if (cut_) {
      std::vector<float> values;
      values.reserve(polygon_of_face_.size());
      for (const std::int32_t p : polygon_of_face_) values.push_back(one.values[static_cast<std::size_t>(p)]);
      one.values = std::move(values);
    }
    tin_.face_attributes.push_back(std::move(one));
  }
  if (quads_ > 0) {
    tin_.notes.push_back(std::to_string(quads_) +
                         " faces of four corners cut in two along their shorter diagonal.");
  }
  if (larger_ > 0)
    tin_.notes.push_back(std::to_string(larger_) + " faces of more than four corners cut into triangles.");
  if (refused_ > 0) {
    tin_.notes.push_back(std::to_string(refused_) +
                         " faces left out: their outlines cross themselves or have no area.");
  }
}

}  // namespace sightbound
