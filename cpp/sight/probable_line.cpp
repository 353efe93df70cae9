// SPDX-License-Identifier: GPL-3.0-or-later
// Method. Places and heights are found once; then sixteen realisations at a time: draw the nodes along the
// line, from them the ground at its crossings, from these the ground half-way near the ends, and compare.
#include "sight/probable_line.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "sight/fresnel.h"

namespace sightbound {

namespace {

// Halves between the stops, half a cell apart, from either end: as many as the probable viewshed draws.
constexpr int kNearestSteps = 2, kNearSteps = 8, kDepthNearest = 2, kDepthNear = 1;
// In cells along the line. Draws of fine ground belong to an eighth; nearer places would share them.
constexpr double kFinest = 0.125;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

SIGHTBOUND_VECTOR
void add_part(const Lanes& node, float weight, Lanes& sum) {
  for (int l = 0; l < kLanes; ++l) sum.v[l] += weight * node.v[l];
}

SIGHTBOUND_VECTOR
void lower_by(float datum, const Lanes& height, Lanes& out) {
  for (int l = 0; l < kLanes; ++l) out.v[l] = height.v[l] - datum;
}

// Bits 0 to 15: the line lies below the ground; 16 to 31: its zone reaches it.
SIGHTBOUND_VECTOR
std::uint32_t below(const DoubtfulPlace& place, const Lanes& ground, const Lanes& eye, const Lanes& target) {
  std::uint32_t line = 0, zone = 0;
  for (int l = 0; l < kLanes; ++l) {
    const float clearance =
        place.line + place.with_eye * eye.v[l] + place.with_target * target.v[l] - ground.v[l];
    line |= clearance >= 0 ? 0u : 1u << l;
    zone |= clearance >= place.zone ? 0u : 1u << l;
  }
  return line | zone << kLanes;
}

struct Realised {
  Lanes eye, target;  // how far the ends' ground rises above the DEM
  std::vector<Lanes> nodes;
  std::vector<RayPlace> where;
};

void draw_nodes(const LineInDoubt& line, RealisedColumns& columns, Realised& drawn) {
  for (const NodeLine& needed : line.over.lines) {
    if (needed.to < needed.from) continue;
    const Lanes* nodes = columns.nodes(needed.major, needed.from, needed.to);
    for (int n = needed.from; n <= needed.to; ++n)
      lower_by(static_cast<float>(line.datum), nodes[n], drawn.nodes[at(needed.first + n - needed.from)]);
  }
}

void draw_ground(const LineInDoubt& line, const FineGround& fine, Realised& drawn) {
  const std::vector<NodePlace>& places = line.over.places;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const NodePlace& place = places[i];
    Lanes& ground = drawn.where[i].ground;
    std::fill_n(ground.v, kLanes, place.known ? 0 : std::numeric_limits<float>::quiet_NaN());
    for (std::size_t n = 0; n < at(place.nodes); ++n)
      add_part(drawn.nodes[at(place.index[n])], place.weight[n], ground);
  }
  for (std::size_t i = 0; i < line.fine.size(); ++i)
    drawn.where[places.size() + i] =
        fine.middle(drawn.where[at(line.fine[i].a)], drawn.where[at(line.fine[i].b)]);
  lower_by(static_cast<float>(line.eye_ground), drawn.where.front().ground, drawn.eye);
  lower_by(static_cast<float>(line.target_ground), drawn.where[places.size() - 1].ground, drawn.target);
}

}  // namespace

LineInDoubt::LineInDoubt(const Scene& scene, const Grid<float>& mean, const Eye& eye, const Target& target,
                         const LineDoubt& doubt)
    : over(mean, eye, target),
      base_row(eye.base_row),
      base_col(eye.base_col),
      datum(std::floor(eye.height)),
      eye_ground(doubt.eye_ground - datum),
      target_ground(doubt.target_ground - datum) {
  std::vector<bool> known;
  for (const NodePlace& place : over.places) {
    where.push_back({place.major, place.minor, place.share * over.distance, {}});
    known.push_back(place.known);
  }
  const int steps = static_cast<int>(over.stops.size()) - 1;
  for (int i = 0; i < steps; ++i) {
    const int from_end = std::min(i, steps - 1 - i);
    const int depth = from_end < kNearestSteps ? kDepthNearest : (from_end < kNearSteps ? kDepthNear : 0);
    halve(over.stops[at(i)], over.stops[at(i + 1)], depth);
  }
  for (const Halves& of : fine) known.push_back(known[at(of.a)] && known[at(of.b)]);

  const double drop = scene.bend * over.bulge, length = over.distance;
  for (std::size_t i = 0; i < where.size(); ++i) {
    DoubtfulPlace place;
    const double t = place.share = where[i].s / length;
    place.line =
        static_cast<float>(eye.height - datum + t * (target.height - eye.height) - drop * t * (1 - t));
    // Ends that do not move: measurement error near one lifts the ground under it too.
    const bool near_eye = t * length < scene.end_zone_m, near_target = (1 - t) * length < scene.end_zone_m;
    const bool both = doubt.ends_move || (near_eye && near_target);
    place.with_eye = static_cast<float>(both ? 1 - t : (near_eye ? 1 : 0));
    place.with_target = static_cast<float>(both ? t : (near_target ? 1 : 0));
    place.zone = static_cast<float>(doubt.zone_share * first_zone_radius(doubt.wavelength, length, t));
    place.judged = i != 0 && i + 1 != over.places.size() && (known[i] || !scene.see_across_nodata);
    places.push_back(place);
  }
}

void LineInDoubt::halve(int a, int b, int depth) {
  const RayPlace one = where[at(a)], other = where[at(b)];
  if (depth == 0 || std::abs(other.major - one.major) < 2 * kFinest) return;
  const int middle = static_cast<int>(where.size());
  where.push_back(
      {0.5 * (one.major + other.major), 0.5 * (one.minor + other.minor), 0.5 * (one.s + other.s), {}});
  fine.push_back({a, b});
  halve(a, middle, depth - 1);
  halve(middle, b, depth - 1);
}

LineCounts count_clear(const LineInDoubt& line, const OpenTerrain& terrain, int realisations,
                       RealisedColumns& columns) {
  LineCounts counts;
  counts.realisations = realisations;
  counts.blocked.resize(line.places.size());
  if (line.places.empty()) counts.clear = counts.zone_clear = realisations;
  Realised drawn;
  drawn.nodes.resize(at(line.over.nodes));
  drawn.where = line.where;
  for (int first = 0; first < realisations && !line.places.empty(); first += kLanes) {
    const auto from = static_cast<std::uint32_t>(first);
    const std::uint32_t used = (1u << std::min(kLanes, realisations - first)) - 1;
    columns.begin(from);
    draw_nodes(line, columns, drawn);
    draw_ground(line, {terrain, line.over.transposed, line.base_row, line.base_col, from}, drawn);
    std::uint32_t any = 0;
    for (std::size_t i = 0; i < line.places.size(); ++i) {
      if (!line.places[i].judged) continue;
      const std::uint32_t bits = below(line.places[i], drawn.where[i].ground, drawn.eye, drawn.target);
      if (bits == 0) continue;
      any |= bits;
      counts.blocked[i] += std::popcount(bits & used);
    }
    counts.clear += std::popcount(~any & used);
    counts.zone_clear += std::popcount(~(any >> kLanes) & used);
  }
  return counts;
}

}  // namespace sightbound
