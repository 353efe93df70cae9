// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/line_rules.h"

#include <algorithm>
#include <cmath>

namespace sightbound {

namespace {

// Where a break line goes on from a vertex inside, coming from `from`.
std::int32_t next_on_line(const PlanMesh& mesh, std::int32_t v, std::int32_t from) {
  const std::int32_t first = mesh.first_corner(v);
  std::int32_t corner = first;
  do {
    const std::int32_t w = mesh.vertex(PlanMesh::next(corner));
    if (w != from && mesh.line(PlanMesh::previous(corner)).break_line) return w;
    corner = mesh.counterclockwise(corner);
  } while (corner != first);
  return PlanMesh::kNone;
}

// The corner opposite to the edge between two vertices; kNone where there is none.
std::int32_t across(const PlanMesh& mesh, std::int32_t v, std::int32_t w) {
  const std::int32_t corner = mesh.edge(v, w);
  return corner == PlanMesh::kNone ? PlanMesh::kNone : PlanMesh::previous(corner);
}

// Samples of the rim of a block are the next block's too, those in between perhaps that one's alone: an edge
// along it would not meet the next block's. All of them stay, so that what stays is asked.
bool may_lie_along_a_rim(const PlanMesh& mesh, std::int32_t v, std::int32_t w) {
  const bool stay = mesh.kind(v) >= VertexKind::kFixed && mesh.kind(w) >= VertexKind::kFixed;
  return stay && (mesh.step_x(v) == mesh.step_x(w) || mesh.step_y(v) == mesh.step_y(w));
}

}  // namespace

LineRules::LineRules(double border_m, double break_line_m, const std::array<double, 4>& metres)
    : metres_(metres),
      border_step_m_(border_m / PlanMesh::kMostStrayed),
      break_line_step_m_(break_line_m / PlanMesh::kMostStrayed) {}

std::optional<LineRules::Edge> LineRules::without_b(const PlanMesh& mesh, const EdgeStar& star) const {
  const bool outline = star.right < 0;
  Edge edge{};
  if (outline) {
    const bool b_is_first = star.b_begin == 0;  // along the outline
    edge.to = star.ring[b_is_first ? 0 : static_cast<std::size_t>(star.size) - 1];
    // What moves along a straight piece has to go before the piece is bent.
    if (mesh.kind(edge.to) == VertexKind::kOutline) return {};
    const Point n = mesh.place(edge.to);
    edge.advances =
        (b_is_first ? area2(star.place_a, star.place_b, n) : area2(n, star.place_b, star.place_a)) < 0;
    // Over a hole of three edges it would close it. (Where it draws back, what goes lies in the star.)
    if (edge.advances && mesh.edge(star.a, edge.to) != PlanMesh::kNone) return {};
  } else {
    edge.to = next_on_line(mesh, star.b, star.a);
    if (edge.to == PlanMesh::kNone) return {};
    const std::int32_t there = across(mesh, star.a, edge.to);
    if (there != PlanMesh::kNone && mesh.line(there).break_line) return {};
  }
  if (may_lie_along_a_rim(mesh, star.a, edge.to)) return {};
  const auto one = mesh.line(PlanMesh::previous(star.corner)),
             other = mesh.line(across(mesh, star.b, edge.to));
  const double off = metres_off(star.place_b, star.place_a, mesh.place(edge.to));
  const double step = outline ? border_step_m_ : break_line_step_m_;
  if (off > 0 && !(step > 0)) return {};
  constexpr double kRounding = 1 + 1e-9;
  const double strayed =
      std::max(one.strayed, other.strayed) + (off > 0 ? std::ceil(kRounding * off / step) : 0);
  if (strayed > PlanMesh::kMostStrayed) return {};
  edge.state = {!outline, static_cast<std::int32_t>(strayed)};
  return edge;
}

double LineRules::metres_off(const Point& b, const Point& from, const Point& to) const {
  const auto in_metres = [&](const Point& p, const Point& q) {
    const double x = q.x - p.x, y = q.y - p.y;
    return std::array<double, 2>{x * metres_[0] + y * metres_[2], x * metres_[1] + y * metres_[3]};
  };
  const auto way = in_metres(from, to), off = in_metres(from, b);
  const double along = off[0] * way[0] + off[1] * way[1], length2 = way[0] * way[0] + way[1] * way[1];
  const double t = std::clamp(along / length2, 0.0, 1.0);
  if (t > 0 && t < 1 && area2(from, b, to) == 0) return 0;
  return std::hypot(off[0] - t * way[0], off[1] - t * way[1]);
}

}  // namespace sightbound
