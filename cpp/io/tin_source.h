// SPDX-License-Identifier: GPL-3.0-or-later
// What a file (or the caller's arrays) says of a TIN, and making a Tin of it.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "io/raster_dem.h"
#include "terrain/regular_tin.h"
#include "terrain/tin.h"
#include "terrain/triangulate.h"

namespace sightbound {

struct TinReadOptions {
  // Surfaces of a LandXML file, layers of a vector source; empty = the only one. Several layers of points and
  // lines make one TIN.
  std::vector<std::string> layers = {};
  std::string crs = {};                              // EPSG:32633, WKT ...; wins over the file's
  VerticalUnit vertical_unit = VerticalUnit::kAuto;  // of heights and sigma_v
  std::string z_field = {};  // of vector layers: heights are in this field instead of the geometry
  // Of triangulated points: no face with a longer edge in plan, metres.
  double longest_edge = std::numeric_limits<double>::infinity();
};

struct TinSource {
  Tin tin;  // coordinates, sigma_v and heights in the source's own units; crs_wkt not used
  // Points to triangulate, instead of vertices and faces; sigma_v and vertex_attributes of `tin` are then
  // those of the points.
  SurveyedPoints survey;
  // Points, and polylines whose corners become points too (NaN in sigma_v and vertex_attributes of `tin`,
  // which are those of the points). To be called once, after these are set.
  void add_survey(std::vector<Xyz> points, const std::vector<std::vector<Xyz>>& breaklines);

  std::string crs;  // any text; empty = none
  struct Unit {
    double metres = 1;
    std::string name;
  };
  std::optional<Unit> unit;  // of x, y and z, where the source says so itself (LandXML)
};

// Converts units, triangulates, cleans (tin_cleaning.h), sets the origin. `what` begins messages ("The TIN
// 'a.ply'"). A CRS of the source in degrees is refused when its coordinates may be degrees; else, and when it
// cannot be understood, it is dropped with a note. Throws InvalidInput, Cancelled.
Tin make_tin(TinSource, const TinReadOptions&, const std::string& what, Progress&);

// regular_tin() of a DEM with its CRS checked: degrees are refused (InvalidInput), a vertical part in other
// units than metres left out.
RegularTin tin_of_dem(const DemSource&, const MemoryBudget&, Progress&);

// Polygons of a mesh as they are read, cut into triangles.
class FaceCollector {
 public:
  // `tin` must have its vertices before the first add() of more than three corners.
  explicit FaceCollector(Tin& tin, std::string what) : tin_(tin), what_(std::move(what)) {}

  // Corners in order round the polygon. Throws InvalidInput when one of more than three is out of range
  // (clean() checks triangles), or when there are fewer than three.
  void add(std::span<const std::int32_t> corners);
  // A polygon with holes: rings of vertices already there, the outer one first.
  void add_rings(const std::vector<std::vector<std::int32_t>>& rings);
  // Values of polygons given in order become those of their triangles; tells in notes of what was cut or left
  // out.
  void finish(std::vector<TinAttribute> polygon_attributes);

  std::size_t polygons() const { return polygons_; }

 private:
  void push(const Face& face);
  Xyz place_of(std::int32_t vertex) const;

  Tin& tin_;
  std::string what_;
  bool cut_ = false;                           // false while every polygon is one triangle
  std::vector<std::int32_t> polygon_of_face_;  // when cut
  std::size_t polygons_ = 0, quads_ = 0, larger_ = 0, refused_ = 0;
};

}  // namespace sightbound
