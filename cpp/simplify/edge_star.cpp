// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/edge_star.h"

namespace sightbound {

namespace {

// May a vertex be drawn into one that is of no lower kind?
bool may_go(VertexKind kind, bool outline_edge, bool line_edge) {
  switch (kind) {
    case VertexKind::kInside:
      return true;
    case VertexKind::kOutline:
      return outline_edge;
    case VertexKind::kOnLine:
      return outline_edge || line_edge;
    default:
      return false;
  }
}

// Goes round a vertex from `corner` on and appends what lies ahead, until `end` has been appended or the
// outline is met.
bool append(const PlanMesh& mesh, std::int32_t corner, std::int32_t end, EdgeStar& star) {
  while (corner != PlanMesh::kNone) {
    const std::int32_t v = mesh.vertex(PlanMesh::previous(corner));
    if (star.size == EdgeStar::kMostRing) return false;
    star.ring[static_cast<std::size_t>(star.size++)] = v;
    if (v == end) return true;
    corner = mesh.counterclockwise(corner);
  }
  return end == PlanMesh::kNone;
}

// Of an edge of the outline, from `from` to `to`: w ... left round `to`, left ... u round `from`.
bool ring_of_outline_edge(const PlanMesh& mesh, std::int32_t from, EdgeStar& star) {
  const std::int32_t to = PlanMesh::next(from), left = mesh.vertex(PlanMesh::previous(from));
  const std::int32_t first = mesh.first_corner(mesh.vertex(to));
  star.closed = false;
  star.ring[0] = mesh.vertex(PlanMesh::next(first));
  star.size = 1;
  if (star.ring[0] != left && !append(mesh, first, left, star)) return false;
  star.left = star.size - 1;
  star.right = -1;
  if (!append(mesh, mesh.counterclockwise(from), PlanMesh::kNone, star)) return false;
  const bool b_first = star.b == mesh.vertex(to);
  star.b_begin = b_first ? 0 : star.left;
  star.b_end = b_first ? star.left : star.size - 1;
  return star.size > 1;  // else a triangle on its own
}

// Of an edge with triangles on both sides, whose end b lies inside: right ... left round b, between what is
// round a.
bool ring_of_inner_edge(const PlanMesh& mesh, std::int32_t at_a, EdgeStar& star) {
  const std::int32_t right_apex = mesh.opposite(PlanMesh::previous(at_a)), at_b = PlanMesh::next(right_apex);
  const std::int32_t left = mesh.vertex(PlanMesh::previous(at_a)), right = mesh.vertex(right_apex);
  const std::int32_t first = mesh.first_corner(star.a);
  star.closed = mesh.clockwise(first) != PlanMesh::kNone;
  star.ring[0] = star.closed ? left : mesh.vertex(PlanMesh::next(first));
  star.size = 1;
  const std::int32_t from = star.closed ? mesh.counterclockwise(at_a) : first;
  if (star.ring[0] != right && !append(mesh, from, right, star)) return false;
  star.right = star.b_begin = star.size - 1;
  if (!append(mesh, mesh.counterclockwise(at_b), left, star)) return false;
  star.left = star.b_end = star.size - 1;
  if (!star.closed) return append(mesh, mesh.counterclockwise(at_a), PlanMesh::kNone, star);
  --star.size;  // left has come round
  star.left = 0;
  return true;
}

void look_up_places(const PlanMesh& mesh, EdgeStar& star) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(star.size); ++i) star.at[i] = mesh.place(star.ring[i]);
  if (star.closed) star.at[static_cast<std::size_t>(star.size)] = star.at[0];
  star.place_a = mesh.place(star.a);
  star.place_b = mesh.place(star.b);
}

}  // namespace

bool gather(const PlanMesh& mesh, std::int32_t corner, bool prefer_next, EdgeStar& star) {
  const std::int32_t one = mesh.vertex(corner), other = mesh.vertex(PlanMesh::next(corner));
  const bool a_is_next =
      mesh.kind(other) > mesh.kind(one) || (mesh.kind(other) == mesh.kind(one) && prefer_next);
  star.corner = corner;
  star.a = a_is_next ? other : one;
  star.b = a_is_next ? one : other;
  const std::int32_t beyond = mesh.opposite(PlanMesh::previous(corner));  // the other triangle's apex
  const bool outline_edge = beyond == PlanMesh::kNone;
  const bool line_edge = mesh.line(PlanMesh::previous(corner)).break_line;
  if (!may_go(mesh.kind(star.b), outline_edge, line_edge)) return false;
  if (outline_edge) {
    if (!ring_of_outline_edge(mesh, corner, star)) return false;
  } else if (!ring_of_inner_edge(mesh, a_is_next ? PlanMesh::next(beyond) : corner, star)) {
    return false;
  }
  look_up_places(mesh, star);
  return true;
}

bool gather_around(const PlanMesh& mesh, std::int32_t vertex, EdgeStar& star) {
  const std::int32_t corner = mesh.corner_of(vertex), first = mesh.vertex(PlanMesh::next(corner));
  star.a = star.b = vertex;
  star.closed = true;
  star.size = 0;
  if (!append(mesh, corner, first, star)) return false;
  look_up_places(mesh, star);
  return true;
}

}  // namespace sightbound
