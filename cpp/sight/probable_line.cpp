// SPDX-License-Identifier: GPL-3.0-or-later
// Method. Places and heights are found once; then sixteen realisations at a time: draw the nodes along the
// line, from them the ground at its crossings, from these the ground half-way near the ends, and compare.
#include "sight/probable_line.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "sight/fresnel.h"

namespace sightbound {

namespace {

// Steps between the stops, half a cell long, from either end: as finely as the probable viewshed draws.
constexpr int kNearestSteps = 2, kNearSteps = 8;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

struct Realised {
  Lanes eye, target;  // how far the ends' ground rises above the DEM
  std::vector<Lanes> sources, nodes, ground;
};

SIGHTBOUND_VECTOR
void draw_ground(const LineInDoubt& line, std::uint32_t first, Realised& drawn) {
  for (std::size_t i = 0; i < line.sources.size(); ++i) draw(line.sources[i], first, drawn.sources[i]);
  const auto source = [&](int n) -> const Lanes& { return drawn.sources[at(n)]; };
  for (std::size_t i = 0; i < line.nodes.size(); ++i) {
    const LineNode& node = line.nodes[i];
    if (node.is_sample) {
      drawn.nodes[i] = source(node.a);
    } else {
      draw(node.draw, first,
           {source(node.a), source(node.b), source(node.c), source(node.d), source(node.e), source(node.f)},
           drawn.nodes[i]);
    }
  }
  const std::vector<NodePlace>& places = line.over.places;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto node = [&](std::size_t n) -> const Lanes& { return drawn.nodes[at(places[i].index[n])]; };
    const bool is_end = i == 0 || i + 1 == places.size();  // whose departure knows the steps around
    if (places[i].nodes == 2 && !is_end) {
      draw_on_way(line.across[i], line.steps, first, node(0), node(1), places[i].weight[1], drawn.ground[i]);
      continue;
    }
    Lanes between;
    for (int l = 0; l < kLanes; ++l)
      between.v[l] = places[i].known ? 0 : std::numeric_limits<float>::quiet_NaN();
    for (std::size_t n = 0; n < at(places[i].nodes); ++n) {
      for (int l = 0; l < kLanes; ++l) between.v[l] += places[i].weight[n] * node(n).v[l];
    }
    draw_about(
        line.across[i], first, [&](int l) { return between.v[l]; }, drawn.ground[i]);
  }
  for (std::size_t i = 0; i < line.fine.size(); ++i) {
    const FineHalf& half = line.fine[i];
    draw_on_way(half.draw, line.steps, first, drawn.ground[at(half.a)], drawn.ground[at(half.b)], 0.5f,
                drawn.ground[places.size() + i]);
  }
  const Lanes &eye = drawn.ground.front(), &target = drawn.ground[places.size() - 1];
  for (int l = 0; l < kLanes; ++l) {
    drawn.eye.v[l] = eye.v[l] - static_cast<float>(line.eye_ground);
    drawn.target.v[l] = target.v[l] - static_cast<float>(line.target_ground);
  }
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

}  // namespace

LineInDoubt::LineInDoubt(const Scene& scene, const OpenTerrain& terrain, const RealisedColumns& columns,
                         const Eye& eye, const Target& target, const LineDoubt& doubt)
    : over(terrain.mean, eye, target),
      normal(is_normal(terrain.error) && !terrain.shared),
      seed(terrain.seed),
      datum(std::floor(eye.height)),
      eye_ground(doubt.eye_ground - datum),
      target_ground(doubt.target_ground - datum) {
  if (over.places.empty()) return;
  find_nodes(columns);
  const FineGround ground(terrain, over.transposed, eye.base_row, eye.base_col);
  steps = ground.steps();
  normal = normal && steps.is_even();
  find_fine(ground);
  std::vector<bool> known;
  for (const NodePlace& place : over.places) known.push_back(place.known);
  for (const FineHalf& half : fine) known.push_back(known[at(half.a)] && known[at(half.b)]);

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
    place.unknown = !known[i];
    places.push_back(place);
  }
}

void LineInDoubt::find_nodes(const RealisedColumns& columns) {
  std::map<std::pair<int, int>, int> found;  // by half cells
  const auto source = [&](int major, int minor, const SampleDraw& draw) {
    const auto [place, is_new] = found.try_emplace({major, minor}, static_cast<int>(sources.size()));
    if (is_new) sources.push_back(draw);
    return place->second;
  };
  const auto sample = [&](int m, int n) {
    SampleDraw draw = columns.sample(m, n);
    draw.mean -= static_cast<float>(datum);
    return source(2 * m, 2 * n, draw);
  };
  const auto centre = [&](int major, int minor) {
    return source(major, minor, columns.centre(major, minor));
  };
  for (const NodeLine& line : over.lines) {
    for (int minor = line.from; minor <= line.to; ++minor) {
      nodes.push_back(columns.node_of(line.major, minor, sample, centre));
    }
  }
}

void LineInDoubt::find_fine(const FineGround& ground) {
  const std::size_t last = over.places.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    const NodePlace& place = over.places[i];
    where.push_back({place.major, place.minor, place.share * over.distance});
    if (i == 0 || i == last) {
      const auto share = [](double samples) { return 2 * samples - std::floor(2 * samples); };
      across.push_back(ground.inside(where[i], share(place.major), share(place.minor)));
    } else {
      const NodeStep step{kNodeStep * (place.node[1].major - place.node[0].major),
                          kNodeStep * (place.node[1].minor - place.node[0].minor)};
      across.push_back(
          ground.across(where[i], step, place.nodes == 2 ? static_cast<double>(place.weight[1]) : 0));
    }
  }
  const auto halve = [&](int a, int b, const FinePlace& place) {
    const RayPlace one = where[at(a)], other = where[at(b)];
    fine.push_back({a, b, place.draw});
    where.push_back(
        {0.5 * (one.major + other.major), 0.5 * (one.minor + other.minor), 0.5 * (one.s + other.s)});
    return static_cast<int>(where.size()) - 1;
  };
  const int last_stop = static_cast<int>(over.stops.size()) - 1;
  for (int i = 0; i < last_stop; ++i) {
    const int from_end = std::min(i, last_stop - 1 - i), a = over.stops[at(i)], b = over.stops[at(i + 1)];
    const Fineness fineness = from_end < kNearestSteps ? Fineness::kQuarters
                              : from_end < kNearSteps  ? Fineness::kHalves
                                                       : Fineness::kNone;
    if (fineness == Fineness::kNone) continue;
    FinePlaces between;
    ground.between(where[at(a)], where[at(b)], 0, fineness, between);
    const int middle = halve(a, b, between[0]);
    if (fineness == Fineness::kHalves) continue;
    halve(a, middle, between[1]);
    halve(middle, b, between[2]);
  }
}

LineCounts count_clear(const LineInDoubt& line, int realisations) {
  LineCounts counts;
  counts.realisations = realisations;
  counts.blocked.resize(line.places.size());
  if (line.places.empty()) counts.clear = counts.zone_clear = realisations;
  Realised drawn;
  drawn.sources.resize(line.sources.size());
  drawn.nodes.resize(line.nodes.size());
  drawn.ground.resize(line.places.size());
  for (int first = 0; first < realisations && !line.places.empty(); first += kLanes) {
    const std::uint32_t used = (1u << std::min(kLanes, realisations - first)) - 1;
    draw_ground(line, static_cast<std::uint32_t>(first), drawn);
    const std::uint32_t hidden =
                            ~std::uint32_t{open_holes(line.seed, static_cast<std::uint32_t>(first))} & 0xFFFF,
                        closed = hidden | hidden << kLanes;
    std::uint32_t any = 0;
    for (std::size_t i = 0; i < line.places.size(); ++i) {
      if (!line.places[i].judged) continue;
      const std::uint32_t bits =
          line.places[i].unknown ? closed : below(line.places[i], drawn.ground[i], drawn.eye, drawn.target);
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
