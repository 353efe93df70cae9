// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/view_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/number_text.h"
#include "io/crs.h"
#include "jobs/option_names.h"
#include "jobs/plan_cells.h"
#include "volume/target_lattice.h"

namespace sightbound {

namespace {

constexpr int kPlacesAcross = 8;           // an area, where no spacing is given
constexpr double kMeanRadius = 6371008.8;  // of the Earth, as where there is no CRS (earth/georeference.h)

std::string name_of(const ViewVolume& view, std::size_t index) {
  return view.name.empty() ? "View " + std::to_string(index + 1) : "View '" + view.name + "'";
}

bool is_place(const ViewVolume& view) { return view.rings.size() == 1 && view.rings[0].size() == 1; }

void validate(const ViewVolume& view, const std::string& name) {
  if (view.rings.empty() || view.rings[0].empty())
    throw InvalidInput(name + " has no outline; give one place, or a polygon's corners.");
  for (const std::vector<Xy>& ring : view.rings) {
    if (ring.size() < 3 && !is_place(view)) {
      throw InvalidInput(name + (ring.size() == 2 ? " has two corners" : " has a ring of too few corners") +
                         "; give one place, or at least three corners of a polygon.");
    }
    for (const Xy& corner : ring) {
      if (!std::isfinite(corner.x) || !std::isfinite(corner.y))
        throw InvalidInput(name + " has a corner that is not finite.");
    }
  }
  for (const double height : {view.height_from, view.height_to}) {
    if (!(std::abs(height) <= 1e5))
      throw InvalidInput(name + ": height is " + number_text(height) + "; allowed are -100000 to 100000 m.");
  }
  if (view.height_from > view.height_to) {
    throw InvalidInput(name + ": the height range begins at " + number_text(view.height_from) +
                       " m and ends at " + number_text(view.height_to) + " m; give the lower one first.");
  }
}

Rings local_rings(const VolumeFrame& frame, const ViewVolume& view) {
  Rings rings;
  for (const std::vector<Xy>& ring : view.rings) {
    rings.emplace_back();
    for (const Xy& corner : ring) rings.back().push_back(frame.from_crs({corner.x, corner.y, 0}));
  }
  return rings;
}

// A height to look from, and those it stands for.
struct ViewHeight {
  double at, from, to;
};

std::vector<ViewHeight> heights_of(const ViewVolume& view, double spacing_m) {
  const double range = view.height_to - view.height_from;
  if (range == 0) return {{view.height_from, view.height_from, view.height_from}};
  const int steps = static_cast<int>(std::min(std::ceil(range / spacing_m), 1e6));
  std::vector<ViewHeight> heights;
  for (int n = 0; n <= steps; ++n) {
    const double at = view.height_from + range * n / steps, half = range / steps / 2;
    heights.push_back({at, std::max(at - half, view.height_from), std::min(at + half, view.height_to)});
  }
  return heights;
}

// The places of one view, one above the other over each of its cells. How many cells are off the terrain.
std::size_t add_places(const Surface& surface, const std::vector<PlanCell>& cells,
                       const std::vector<ViewHeight>& heights, HeightReference reference,
                       std::vector<ViewPlace>& places) {
  std::vector<std::uint32_t> numbers;
  std::size_t off = 0;
  for (const PlanCell& cell : cells) {
    const double ground = terrain_over(surface, cell.place.x, cell.place.y, numbers).highest;
    if (std::isnan(ground)) {
      ++off;
      continue;
    }
    const bool above = reference == HeightReference::kGround, wide = !(cell.box.low == cell.box.high);
    const TerrainSpan within =
        wide ? terrain_within(surface, cell.box, numbers) : TerrainSpan{ground, ground};
    const double base = above ? ground : 0;
    // The middle of a square may lie on the seam of two faces.
    const double low = above ? std::min(within.ground, ground) : 0,
                 high = above ? std::max(within.highest, ground) : 0;
    for (const ViewHeight& height : heights) {
      places.push_back({{cell.place.x, cell.place.y, base + height.at},
                        {{cell.box.low.x, cell.box.low.y, low + height.from},
                         {cell.box.high.x, cell.box.high.y, high + height.to}}});
    }
  }
  return off;
}

std::string to_json(const ViewVolume& view, HeightReference reference, std::size_t places) {
  nlohmann::ordered_json json;
  if (!view.name.empty()) json["name"] = view.name;
  auto rings = nlohmann::ordered_json::array();
  for (const std::vector<Xy>& ring : view.rings) {
    rings.push_back(nlohmann::ordered_json::array());
    for (const Xy& corner : ring) rings.back().push_back({corner.x, corner.y});
  }
  json["outline"] = rings[0];
  if (rings.size() > 1) json["further_rings"] = std::vector(rings.begin() + 1, rings.end());
  json["height"] = {view.height_from, view.height_to};
  json["height_reference"] = name_of(reference);
  json["places"] = places;
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace

ViewPlaces view_places(const Surface& surface, const std::vector<ViewVolume>& views,
                       HeightReference reference, double spacing_m, double least_m) {
  if (views.empty()) throw InvalidInput("views is empty; give at least one place to look from.");
  if (!(spacing_m >= 0 && spacing_m <= 1e6))
    throw InvalidInput("view_spacing is " + number_text(spacing_m) +
                       "; allowed are 0 (chosen) to 1000000 m.");
  ViewPlaces out;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const ViewVolume& view = views[v];
    const std::string name = name_of(view, v);
    validate(view, name);
    const Rings rings = local_rings(surface.frame(), view);
    const Box3 box = box_of(rings);
    const double side = std::max(box.high.x - box.low.x, box.high.y - box.low.y);
    const double spacing = spacing_m > 0 ? spacing_m : std::max(side / kPlacesAcross, least_m);
    const std::vector<PlanCell> cells = is_place(view) ? std::vector<PlanCell>{{{box.low.x, box.low.y}, box}}
                                                       : plan_cells(rings, spacing, name);
    const std::size_t before = out.places.size();
    const std::size_t off = add_places(surface, cells, heights_of(view, spacing), reference, out.places);
    if (out.places.size() == before) {
      throw InvalidInput(name + " (" + number_text(view.rings[0][0].x) + ", " +
                         number_text(view.rings[0][0].y) +
                         ") is not on the terrain of the volume; give places within it, in its CRS.");
    }
    if (off > 0) {
      out.warnings.push_back(name + ": " + std::to_string(off) + " of " + std::to_string(cells.size()) +
                             " places are not on the terrain and were left out.");
    }
    out.as_json.push_back(to_json(view, reference, out.places.size() - before));
  }
  return out;
}

GroundBend ground_bend(const Surface& surface, double refraction) {
  const double share = (1 - refraction) / 2;
  const GroundBend of_sphere{share / kMeanRadius, 0, share / kMeanRadius};
  const VolumeFrame& frame = surface.frame();
  if (frame.crs_wkt.empty()) return of_sphere;
  // Three places a kilometre apart, as a DEM of two by two samples has them.
  const Xyz middle = frame.to_crs(0.5 * (surface.bounds().low + surface.bounds().high));
  const double step_m = 1000, step = step_m / frame.metres_per_unit;
  static constexpr std::array<float, 4> kFlat{};
  const ArrayDem dem({kFlat.data(), 2, 2, std::numeric_limits<double>::quiet_NaN(), 1, nullptr},
                     Geotransform({middle.x, step, 0, middle.y, 0, -step}), frame.crs_wkt);
  const Georeference georeference = georeference_of(dem);
  if (georeference.is_plane()) return of_sphere;
  const double radian = std::numbers::pi / 180;
  const LonLat o = georeference.lon_lat(0, 0), x = georeference.lon_lat(1, 0), y = georeference.lon_lat(0, 1);
  const double sine = std::sin(o.lat * radian), a = georeference.ellipsoid().semi_major_m;
  const double e2 = georeference.ellipsoid().flattening * (2 - georeference.ellipsoid().flattening);
  const double across = a / std::sqrt(1 - e2 * sine * sine);        // radii of curvature: east,
  const double along = across * (1 - e2) / (1 - e2 * sine * sine);  // north
  const double per_lon =
      across * std::cos(o.lat * radian) * radian / step_m;  // metres a degree, over the step
  const double per_lat = along * radian / step_m;
  // East and north metres of a plan metre along x, and along y (rows run south).
  const double ex = std::remainder(x.lon - o.lon, 360.0) * per_lon, nx = (x.lat - o.lat) * per_lat;
  const double ey = -std::remainder(y.lon - o.lon, 360.0) * per_lon, ny = -(y.lat - o.lat) * per_lat;
  return {share * (ex * ex / across + nx * nx / along), share * (ex * ey / across + nx * ny / along),
          share * (ey * ey / across + ny * ny / along)};
}

}  // namespace sightbound
