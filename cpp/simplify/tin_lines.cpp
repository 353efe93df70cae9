// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/tin_lines.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "base/error.h"
#include "terrain/exact_planes.h"

namespace sightbound {

namespace {

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

double squared_distance(const Xyz& p, const Xyz& from, const Xyz& to) {
  const Xyz along = to - from;
  const double length2 = dot(along, along);
  const double t = length2 > 0 ? std::clamp(dot(p - from, along) / length2, 0.0, 1.0) : 0;
  const Xyz off = p - (from + t * along);
  return dot(off, off);
}

// The edges opposite to a vertex must make one ring, or one line from outline to outline: its ends (none of a
// ring), or nothing. O(n log n) in the faces around.
std::optional<std::vector<std::int32_t>> ends_around(const TinMesh& mesh, std::int32_t vertex) {
  std::vector<TinEdge> opposite;
  std::vector<std::pair<std::int32_t, std::size_t>> by_end;  // and the edge's number
  mesh.for_each_face(vertex, [&](std::int32_t f, std::int32_t c) {
    const Face& face = mesh.face(f);
    const TinEdge edge{face[at((c + 1) % 3)], face[at((c + 2) % 3)]};
    for (const std::int32_t end : edge) by_end.emplace_back(end, opposite.size());
    opposite.push_back(edge);
  });
  if (opposite.empty()) return {};
  std::sort(by_end.begin(), by_end.end());
  std::vector<std::int32_t> ends;
  for (std::size_t i = 0; i < by_end.size();) {
    std::size_t next = i;
    while (next < by_end.size() && by_end[next].first == by_end[i].first) ++next;
    if (next - i > 2) return {};
    if (next - i == 1) ends.push_back(by_end[i].first);
    i = next;
  }
  if (ends.size() != 0 && ends.size() != 2) return {};
  // One piece?
  std::int32_t here = ends.empty() ? opposite[0][0] : ends[0];
  std::size_t passed = 0;
  std::vector<bool> seen(opposite.size());
  for (bool on = true; on;) {
    on = false;
    auto entry = std::lower_bound(by_end.begin(), by_end.end(), std::pair(here, std::size_t{0}));
    for (; entry != by_end.end() && entry->first == here && !on; ++entry) {
      const std::size_t edge = entry->second;
      if (seen[edge]) continue;
      here = opposite[edge][0] == here ? opposite[edge][1] : opposite[edge][0];
      seen[edge] = on = true;
      ++passed;
      break;
    }
  }
  if (passed != opposite.size()) return {};
  return ends;
}

}  // namespace

TinLines::TinLines(const TinMesh& mesh, const std::vector<TinEdge>& break_lines, const TinLineRules& rules,
                   Progress& progress)
    : mesh_(mesh), rules_(rules), kinds_(at(mesh.vertices()), TinVertexKind::kInside) {
  NeighboursOf along;
  find_outline(along, progress);
  add_break_lines(break_lines, along);
  decide(along);
}

void TinLines::find_outline(NeighboursOf& along, Progress& progress) {
  for (std::int32_t v = 0; v < mesh_.vertices(); ++v) {
    if (v % 4096 == 0) progress.check();
    const auto ends = ends_around(mesh_, v);
    if (!ends) {
      kinds_[at(v)] = TinVertexKind::kFixed;
      ++not_manifold_;
      continue;
    }
    for (const std::int32_t end : *ends) {
      along[v].push_back(end);
      edges_.emplace(key(v, end), TinEdgeKind::kOutline);
    }
  }
}

void TinLines::add_break_lines(const std::vector<TinEdge>& break_lines, NeighboursOf& along) {
  for (const TinEdge& edge : break_lines) {
    const auto is_vertex = [this](std::int32_t v) { return v >= 0 && v < mesh_.vertices(); };
    if (!is_vertex(edge[0]) || !is_vertex(edge[1]) || edge[0] == edge[1] ||
        !mesh_.is_edge(edge[0], edge[1])) {
      throw InvalidInput("break_lines has the edge " + std::to_string(edge[0]) + " to " +
                         std::to_string(edge[1]) + ", which the TIN has not.");
    }
    const auto [there, is_new] = edges_.emplace(key(edge[0], edge[1]), TinEdgeKind::kBreak);
    if (there->second == TinEdgeKind::kOutline) breaks_of_outline_.insert(there->first);
    if (!is_new) continue;
    along[edge[0]].push_back(edge[1]);
    along[edge[1]].push_back(edge[0]);
  }
}

void TinLines::decide(const NeighboursOf& along) {
  for (const auto& [vertex, neighbours] : along) {
    TinVertexKind& kind = kinds_[at(vertex)];
    if (kind == TinVertexKind::kFixed) continue;
    if (neighbours.size() != 2 || is_corner(vertex, neighbours)) {
      kind = TinVertexKind::kFixed;
      continue;
    }
    // Along the outline a break line keeps to the tolerances of both; where it begins or ends it stays.
    const auto breaks =
        std::count_if(neighbours.begin(), neighbours.end(),
                      [&, v = vertex](std::int32_t end) { return breaks_of_outline_.contains(key(v, end)); });
    if (breaks == 1) {
      kind = TinVertexKind::kFixed;
      continue;
    }
    const bool outline = edge(vertex, neighbours[0]) == TinEdgeKind::kOutline;
    kind = outline ? TinVertexKind::kOutline : TinVertexKind::kBreak;
    double tolerance = outline ? rules_.outline_tolerance_m : rules_.break_tolerance_m;
    if (breaks == 2) tolerance = std::min(tolerance, rules_.break_tolerance_m);
    const std::array<std::int32_t, 2> both{neighbours[0], neighbours[1]};
    neighbours_.emplace(vertex, Neighbours{both, both, tolerance});
  }
}

bool TinLines::is_corner(std::int32_t vertex, const std::vector<std::int32_t>& neighbours) const {
  const Xyz before = place(vertex) - place(neighbours[0]), after = place(neighbours[1]) - place(vertex);
  return !(dot(before, after) >= kCornerTurn * length(before) * length(after));
}

bool TinLines::near(std::int32_t vertex, std::int32_t from, std::int32_t to, double tolerance) const {
  const Xyz p = place(vertex), a = place(from), b = place(to);
  if (tolerance > 0) return squared_distance(p, a, b) <= tolerance * tolerance;
  return on_one_line(p, a, b) && dot(a - p, b - p) <= 0;
}

bool TinLines::may_go(std::int32_t gone, std::int32_t kept) const {
  const auto found = neighbours_.find(gone);
  if (found == neighbours_.end()) return false;
  const Neighbours& ends = found->second;
  const std::size_t side = ends.now[0] == kept ? 0 : 1;
  const std::int32_t other = ends.now[1 - side];
  if (ends.now[side] != kept || other == kept) return false;
  if (edge(other, kept) != TinEdgeKind::kNone) return false;  // two lines would become one
  const double tolerance = ends.tolerance;
  if (!near(gone, other, kept, tolerance)) return false;
  if (tolerance == 0) return true;  // what went before lies on the same straight piece
  // What went before, to either side: vertices with two neighbours, so that the way along them is known.
  for (std::size_t s = 0; s < 2; ++s) {
    std::int32_t before = gone, here = ends.original[s];
    while (here != ends.now[s]) {
      if (!near(here, other, kept, tolerance)) return false;
      const auto& around = neighbours_.at(here).original;
      const std::int32_t next = around[0] == before ? around[1] : around[0];
      before = here;
      here = next;
    }
  }
  return true;
}

void TinLines::went(std::int32_t gone, std::int32_t kept) {
  const Neighbours& ends = neighbours_.at(gone);
  const std::int32_t other = ends.now[0] == kept ? ends.now[1] : ends.now[0];
  edges_.emplace(key(other, kept), edge(gone, kept));
  edges_.erase(key(gone, kept));
  edges_.erase(key(gone, other));
  const auto link = [&](std::int32_t from, std::int32_t to) {
    const auto found = neighbours_.find(from);
    if (found == neighbours_.end()) return;
    for (std::int32_t& now : found->second.now) {
      if (now == gone) now = to;
    }
  };
  link(kept, other);
  link(other, kept);
}

}  // namespace sightbound
