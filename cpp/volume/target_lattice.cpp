// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/target_lattice.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/number_text.h"

namespace sightbound {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kLeastSpacing = 1e-3, kLargestLength = 1e6;  // metres; what is beyond is taken for a slip
constexpr double kOnEdge = 1e-9;  // of a face's edges: a centre on the seam of two faces belongs to both

void require_length(double value, const char* field) {
  if (value >= kLeastSpacing && value <= kLargestLength) return;  // false for a NaN
  throw InvalidInput(std::string(field) + " is " + number_text(value, 6) +
                     "; allowed are 0.001 to 1000000 m.");
}

// Height of the face over a plan place; NaN when it does not reach there or is vertical.
double height_over(const SurfaceFace& face, double x, double y) {
  const auto& [a, b, c] = face.corner;
  const double twice = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
  if (twice == 0) return kNone;
  const double v = ((x - a.x) * (c.y - a.y) - (c.x - a.x) * (y - a.y)) / twice;
  const double w = ((b.x - a.x) * (y - a.y) - (x - a.x) * (b.y - a.y)) / twice;
  if (!(v >= -kOnEdge && w >= -kOnEdge && v + w <= 1 + kOnEdge)) return kNone;
  return a.z + v * (b.z - a.z) + w * (c.z - a.z);
}

// What of a polygon lies where coordinate `axis` is at least (`above`) or at most `limit`: Sutherland and
// Hodgman.
std::vector<Xyz> cut_at(const std::vector<Xyz>& polygon, double Xyz::*axis, double limit, bool above) {
  const auto depth = [&](const Xyz& p) { return above ? p.*axis - limit : limit - p.*axis; };
  std::vector<Xyz> kept;
  for (std::size_t n = 0; n < polygon.size(); ++n) {
    const Xyz &a = polygon[n], &b = polygon[(n + 1) % polygon.size()];
    const double da = depth(a), db = depth(b);
    if (da >= 0) kept.push_back(a);
    if ((da < 0) != (db < 0)) kept.push_back(a + (da / (da - db)) * (b - a));
  }
  return kept;
}
std::vector<Xyz> cut_to(const Box3& plan, std::vector<Xyz> polygon) {
  for (double Xyz::*axis : {&Xyz::x, &Xyz::y})
    polygon = cut_at(cut_at(polygon, axis, plan.low.*axis, true), axis, plan.high.*axis, false);
  return polygon;
}

bool looks_up(const SurfaceFace& face) {
  const auto& [a, b, c] = face.corner;
  return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y) > 0;
}

TargetColumn column_of(const TerrainSpan& span, const TargetLattice& lattice) {
  TargetColumn column;
  column.ground = std::numeric_limits<float>::quiet_NaN();
  if (std::isnan(span.ground)) return column;
  column.ground = static_cast<float>(span.ground);
  const double h = lattice.height_spacing_m;
  column.first = static_cast<int>(std::ceil((span.ground - lattice.corner.z) / h - 0.5));
  column.last = static_cast<int>(std::floor((span.highest + lattice.ceiling_m - lattice.corner.z) / h - 0.5));
  return column;
}

TargetColumn target_on(const TerrainSpan& span, const TargetLattice&) {
  if (std::isnan(span.highest)) return {std::numeric_limits<float>::quiet_NaN(), 0, -1};
  return {static_cast<float>(span.highest), 0, 0};
}

double down_to(double value, double step) { return std::floor(value / step) * step; }

// Over the whole surface; the corner in plan, and the columns as `make` tells them from the terrain at their
// centres.
std::shared_ptr<const TargetLattice> with_columns(TargetLattice asked, const Surface& surface,
                                                  TargetColumn (*make)(const TerrainSpan&,
                                                                       const TargetLattice&),
                                                  const Workers& workers, Progress& progress) {
  auto lattice = std::make_shared<TargetLattice>(std::move(asked));
  const Box3& bounds = surface.bounds();
  lattice->frame = surface.frame();
  lattice->corner.x = down_to(bounds.low.x, lattice->spacing_m);
  lattice->corner.y = down_to(bounds.low.y, lattice->spacing_m);
  const double nx = std::ceil((bounds.high.x - lattice->corner.x) / lattice->spacing_m);
  const double ny = std::ceil((bounds.high.y - lattice->corner.y) / lattice->spacing_m);
  if (!(nx * ny < 2147483647.0)) {
    throw InvalidInput("target_spacing is " + number_text(lattice->spacing_m, 6) +
                       " m: " + number_text(nx * ny, 6) +
                       " columns of targets; at most 2147483647 are allowed. Give a larger one.");
  }
  lattice->nx = std::max(static_cast<int>(nx), 1);
  lattice->ny = std::max(static_cast<int>(ny), 1);
  lattice->columns.resize(static_cast<std::size_t>(lattice->nx) * static_cast<std::size_t>(lattice->ny));

  workers.for_each(static_cast<std::size_t>(lattice->ny), [&](std::size_t j) {
    std::vector<std::uint32_t> numbers;
    for (int i = 0; i < lattice->nx; ++i) {
      const Xyz centre = lattice->centre(i, static_cast<int>(j), 0);
      lattice->columns[lattice->number(i, static_cast<int>(j))] =
          make(terrain_over(surface, centre.x, centre.y, numbers), *lattice);
    }
    progress.advance(1.0 / lattice->ny);
  });
  return lattice;
}

}  // namespace

TerrainSpan terrain_over(const Surface& surface, double x, double y, std::vector<std::uint32_t>& numbers) {
  // Solids that are no height fields have undersides; DEMs may hold their corners in either turn.
  const bool only_tops = surface.sides() == Sides::kSolid && surface.metric() == Metric::kNormal;
  const Box3& bounds = surface.bounds();
  surface.faces_near({{x, y, bounds.low.z}, {x, y, bounds.high.z}}, numbers);
  TerrainSpan span;
  for (const std::uint32_t n : numbers) {
    const std::optional<SurfaceFace> face = surface.face(n);
    if (!face) continue;
    const double height = height_over(*face, x, y);
    if (std::isnan(height)) continue;
    span.highest = std::isnan(span.highest) ? height : std::max(span.highest, height);
    if (!only_tops || looks_up(*face))
      span.ground = std::isnan(span.ground) ? height : std::min(span.ground, height);
  }
  return span;
}

TerrainSpan terrain_within(const Surface& surface, const Box3& plan, std::vector<std::uint32_t>& numbers) {
  const Box3& bounds = surface.bounds();
  surface.faces_near({{plan.low.x, plan.low.y, bounds.low.z}, {plan.high.x, plan.high.y, bounds.high.z}},
                     numbers);
  TerrainSpan span;
  for (const std::uint32_t n : numbers) {
    const std::optional<SurfaceFace> face = surface.face(n);
    if (!face) continue;
    for (const Xyz& corner : cut_to(plan, {face->corner.begin(), face->corner.end()})) {
      span.ground = std::isnan(span.ground) ? corner.z : std::min(span.ground, corner.z);
      span.highest = std::isnan(span.highest) ? corner.z : std::max(span.highest, corner.z);
    }
  }
  return span;
}

std::size_t TargetLattice::targets() const {
  return std::transform_reduce(columns.begin(), columns.end(), std::size_t{0}, std::plus<>(),
                               [](const TargetColumn& c) { return static_cast<std::size_t>(c.size()); });
}

int TargetLattice::top_layer(const TargetColumn& column, double height_m) const {
  if (column.size() == 0) return column.first - 1;
  const double top = static_cast<double>(column.ground) + height_m - corner.z;
  return std::clamp(static_cast<int>(std::ceil(top / height_spacing_m)) - 1, column.first, column.last);
}

bool operator==(const TargetLattice& a, const TargetLattice& b) {
  const auto same = [](const TargetColumn& p, const TargetColumn& q) {
    return p.first == q.first && p.last == q.last &&
           (p.ground == q.ground || (std::isnan(p.ground) && std::isnan(q.ground)));
  };
  return a.frame.x == b.frame.x && a.frame.y == b.frame.y &&
         a.frame.metres_per_unit == b.frame.metres_per_unit && a.frame.crs_wkt == b.frame.crs_wkt &&
         a.corner == b.corner && a.spacing_m == b.spacing_m && a.height_spacing_m == b.height_spacing_m &&
         a.ceiling_m == b.ceiling_m && a.follows_ground == b.follows_ground && a.nx == b.nx && a.ny == b.ny &&
         std::equal(a.columns.begin(), a.columns.end(), b.columns.begin(), b.columns.end(), same);
}

std::shared_ptr<const TargetLattice> lattice_above(const Surface& surface, const LatticeOptions& options,
                                                   const Workers& workers, Progress& progress) {
  require_length(options.spacing_m, "target_spacing");
  require_length(options.ceiling_m, "target_ceiling");
  TargetLattice lattice;
  lattice.spacing_m = options.spacing_m;
  lattice.ceiling_m = options.ceiling_m;
  lattice.height_spacing_m = options.height_spacing_m != 0
                                 ? options.height_spacing_m
                                 : std::min(options.spacing_m, options.ceiling_m / 4);
  require_length(lattice.height_spacing_m, "target_height_spacing");
  if (lattice.height_spacing_m > options.ceiling_m) {
    throw InvalidInput("target_height_spacing is " + number_text(lattice.height_spacing_m, 6) +
                       " m, more than target_ceiling (" + number_text(options.ceiling_m, 6) +
                       " m): columns would have no target. Give at most the ceiling.");
  }
  lattice.corner.z = down_to(surface.bounds().low.z, lattice.height_spacing_m);
  return with_columns(std::move(lattice), surface, column_of, workers, progress);
}

std::shared_ptr<const TargetLattice> layer_above(const Surface& surface, double spacing_m, double height_m,
                                                 const Workers& workers, Progress& progress) {
  require_length(spacing_m, "target_spacing");
  require_length(height_m, "target_height");
  TargetLattice lattice;
  lattice.spacing_m = spacing_m;
  lattice.ceiling_m = lattice.corner.z = height_m;
  lattice.follows_ground = true;
  return with_columns(std::move(lattice), surface, target_on, workers, progress);
}

TargetLattice lattice_of(const Xyz& target, double ground) {
  TargetLattice lattice;
  lattice.corner = target;
  lattice.nx = lattice.ny = 1;
  lattice.columns = {{static_cast<float>(ground), 0, 0}};
  return lattice;
}

}  // namespace sightbound
