// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/tin_outline.h"

#include <algorithm>
#include <cmath>

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

}  // namespace

TinOutline::TinOutline(const TinMesh& mesh, double tolerance_m, bool in_plan)
    : mesh_(mesh), tolerance_(tolerance_m), in_plan_(in_plan), kinds_(at(mesh.vertices())) {
  for (std::int32_t v = 0; v < mesh.vertices(); ++v) not_manifold_ += !look_at(v);
}

// The edges opposite to a vertex must make one ring, or one line from outline to outline.
bool TinOutline::look_at(std::int32_t vertex) {
  std::vector<std::array<std::int32_t, 2>> opposite;
  mesh_.for_each_face(vertex, [&](std::int32_t f, std::int32_t c) {
    opposite.push_back({mesh_.face(f)[at((c + 1) % 3)], mesh_.face(f)[at((c + 2) % 3)]});
  });
  TinVertexKind& kind = kinds_[at(vertex)];
  kind = TinVertexKind::kFixed;
  if (opposite.empty()) return false;
  const auto used = [&](std::int32_t v) {
    return std::count_if(opposite.begin(), opposite.end(),
                         [v](const auto& edge) { return edge[0] == v || edge[1] == v; });
  };
  std::vector<std::int32_t> ends;
  for (const auto& edge : opposite) {
    for (const std::int32_t v : edge) {
      const auto times = used(v);
      if (times > 2) return false;
      if (times == 1) ends.push_back(v);
    }
  }
  if (ends.size() != 0 && ends.size() != 2) return false;
  // One piece?
  std::int32_t here = ends.empty() ? opposite[0][0] : ends[0];
  std::size_t passed = 0;
  std::vector<bool> seen(opposite.size());
  for (bool on = true; on;) {
    on = false;
    for (std::size_t i = 0; i < opposite.size() && !on; ++i) {
      if (seen[i] || (opposite[i][0] != here && opposite[i][1] != here)) continue;
      here = opposite[i][0] == here ? opposite[i][1] : opposite[i][0];
      seen[i] = on = true;
      ++passed;
    }
  }
  if (passed != opposite.size()) return false;
  if (ends.empty()) {
    kind = TinVertexKind::kInside;
    return true;
  }
  const Neighbours neighbours{{ends[0], ends[1]}, {ends[0], ends[1]}};
  if (is_corner(vertex, neighbours)) return true;
  kind = TinVertexKind::kOutline;
  outline_.emplace(vertex, neighbours);
  return true;
}

bool TinOutline::is_corner(std::int32_t vertex, const Neighbours& neighbours) const {
  const Xyz before = place(vertex) - place(neighbours.now[0]),
            after = place(neighbours.now[1]) - place(vertex);
  return !(dot(before, after) >= kCornerTurn * length(before) * length(after));
}

bool TinOutline::near(std::int32_t vertex, std::int32_t from, std::int32_t to) const {
  const Xyz p = place(vertex), a = place(from), b = place(to);
  if (tolerance_ > 0) return squared_distance(p, a, b) <= tolerance_ * tolerance_;
  return on_one_line(p, a, b) && dot(a - p, b - p) <= 0;
}

bool TinOutline::may_go(std::int32_t gone, std::int32_t kept) const {
  const auto found = outline_.find(gone);
  if (found == outline_.end()) return false;
  const Neighbours& ends = found->second;
  const std::size_t side = ends.now[0] == kept ? 0 : 1;
  const std::int32_t other = ends.now[1 - side];
  if (ends.now[side] != kept || other == kept) return false;
  if (!near(gone, other, kept)) return false;
  // What went before, to either side: vertices with two neighbours, so that the way along them is known.
  for (std::size_t s = 0; s < 2; ++s) {
    std::int32_t before = gone, here = ends.original[s];
    while (here != ends.now[s]) {
      if (!near(here, other, kept)) return false;
      const auto& around = outline_.at(here).original;
      const std::int32_t next = around[0] == before ? around[1] : around[0];
      before = here;
      here = next;
    }
  }
  return true;
}

void TinOutline::went(std::int32_t gone, std::int32_t kept) {
  const Neighbours& ends = outline_.at(gone);
  const std::int32_t other = ends.now[0] == kept ? ends.now[1] : ends.now[0];
  const auto link = [&](std::int32_t from, std::int32_t to) {
    const auto found = outline_.find(from);
    if (found == outline_.end()) return;
    for (std::int32_t& now : found->second.now) {
      if (now == gone) now = to;
    }
  };
  link(kept, other);
  link(other, kept);
}

}  // namespace sightbound
