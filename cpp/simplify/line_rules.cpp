// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/line_rules.h"

#include <algorithm>
#include <cmath>

namespace sightbound {

namespace {

constexpr std::int32_t kSteps = PlanMesh::kMostLine - 1;  // of the larger tolerance

// How far edges round `v` have strayed: 0 where they have not, and where the outline is as it was.
std::int32_t strayed(std::int32_t line) { return std::max(line, 1) - 1; }

// Where a line goes on from a vertex inside, coming from `from`.
std::int32_t next_on_line(const PlanMesh& mesh, std::int32_t v, std::int32_t from) {
  const std::int32_t first = mesh.first_corner(v);
  std::int32_t corner = first;
  do {
    const std::int32_t w = mesh.vertex(PlanMesh::next(corner));
    if (w != from && mesh.line(PlanMesh::previous(corner)) != 0) return w;
    corner = mesh.counterclockwise(corner);
  } while (corner != first);
  return PlanMesh::kNone;
}

// Of the edge between two vertices; kNone where there is none.
std::int32_t line_between(const PlanMesh& mesh, std::int32_t v, std::int32_t w) {
  const std::int32_t corner = mesh.edge(v, w);
  return corner == PlanMesh::kNone ? PlanMesh::kNone : mesh.line(PlanMesh::previous(corner));
}

}  // namespace

LineRules::LineRules(double border_m, double break_line_m, const std::array<double, 4>& metres)
    : metres_(metres) {
  const double largest = std::max(border_m, break_line_m);
  if (!(largest > 0)) return;
  step_m_ = largest / kSteps;
  const auto most = [&](double tolerance) { return static_cast<std::int32_t>(tolerance / step_m_); };
  most_border_ = most(border_m);
  most_break_line_ = most(break_line_m);
}

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
    if (edge.advances && mesh.edge(star.a, edge.to) != PlanMesh::kNone) return {};  // it would close a hole
  } else {
    edge.to = next_on_line(mesh, star.b, star.a);
    if (edge.to == PlanMesh::kNone || line_between(mesh, star.a, edge.to) > 0) return {};
  }
  // An edge along the rim of a block would not meet the next block's.
  if (mesh.kind(star.a) == VertexKind::kRim && mesh.kind(edge.to) == VertexKind::kRim) return {};
  const std::int32_t before = std::max(strayed(mesh.line(PlanMesh::previous(star.corner))),
                                       strayed(line_between(mesh, star.b, edge.to)));
  const std::int32_t most = outline ? most_border_ : most_break_line_,
                     more = steps(star.place_b, star.place_a, mesh.place(edge.to));
  if (more > most - before) return {};
  edge.line = 1 + before + more;
  return edge;
}

// By how much a place lies off an edge, rounded up; 0 only when it lies on it.
std::int32_t LineRules::steps(const Point& b, const Point& from, const Point& to) const {
  const auto in_metres = [&](const Point& p, const Point& q) {
    const double x = q.x - p.x, y = q.y - p.y;
    return std::array<double, 2>{x * metres_[0] + y * metres_[2], x * metres_[1] + y * metres_[3]};
  };
  const auto way = in_metres(from, to), off = in_metres(from, b);
  const double along = off[0] * way[0] + off[1] * way[1], length2 = way[0] * way[0] + way[1] * way[1];
  const double t = std::clamp(along / length2, 0.0, 1.0);
  if (t > 0 && t < 1 && area2(from, b, to) == 0) return 0;
  constexpr double kRounding = 1 + 1e-9;
  const double steps = std::ceil(kRounding * std::hypot(off[0] - t * way[0], off[1] - t * way[1]) / step_m_);
  return steps < PlanMesh::kMostLine ? static_cast<std::int32_t>(steps) : PlanMesh::kMostLine;
}

}  // namespace sightbound
