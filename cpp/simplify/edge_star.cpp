// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/edge_star.h"

#include <utility>

namespace sightbound {

namespace {

// May a vertex be drawn into one that is of no lower kind?
bool may_go(VertexKind kind, bool outline_edge) {
  switch (kind) {
    case VertexKind::kInside:
      return true;
    case VertexKind::kOutline:
      return outline_edge;
    default:
      return false;
  }
}

// The same edge seen from its other side; kNone when that is outside.
std::int32_t turned(const PlanMesh& mesh, std::int32_t corner) {
  const std::int32_t apex = mesh.opposite(PlanMesh::previous(corner));
  return apex == PlanMesh::kNone ? PlanMesh::kNone : PlanMesh::next(apex);
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

}  // namespace

bool gather(const PlanMesh& mesh, std::int32_t corner, bool prefer_next, EdgeStar& star) {
  constexpr std::int32_t kNone = PlanMesh::kNone;
  std::int32_t other = turned(mesh, corner);
  const bool outline_edge = other == kNone;
  const auto kind = [&](std::int32_t c) { return mesh.kind(mesh.vertex(c)); };
  bool a_is_next = false;  // of an edge of the outline, whose only triangle fixes the direction
  const VertexKind one = kind(corner), next = kind(PlanMesh::next(corner));
  if (next > one || (next == one && prefer_next)) {
    if (outline_edge) {
      a_is_next = true;
    } else {
      std::swap(corner, other);
    }
  }
  const std::int32_t from = mesh.vertex(corner), to = mesh.vertex(PlanMesh::next(corner));
  star.corner = corner;
  star.a = a_is_next ? to : from;
  star.b = a_is_next ? from : to;
  if (!may_go(mesh.kind(star.b), outline_edge)) return false;

  const std::int32_t left = mesh.vertex(PlanMesh::previous(corner));
  star.size = 0;
  const auto push = [&](std::int32_t v) { star.ring[static_cast<std::size_t>(star.size++)] = v; };
  if (outline_edge) {
    // w ... left round `to`, left ... u round `from`.
    star.closed = false;
    const std::int32_t first = mesh.first_corner(to);
    push(mesh.vertex(PlanMesh::next(first)));
    int middle = 0;
    if (star.ring[0] != left) {
      if (!append(mesh, first, left, star)) return false;
      middle = star.size - 1;
    }
    star.left = middle;
    star.right = -1;
    if (!append(mesh, mesh.counterclockwise(corner), kNone, star)) return false;
    star.b_begin = a_is_next ? middle : 0;
    star.b_end = a_is_next ? star.size - 1 : middle;
    if (star.size < 2) return false;  // a triangle on its own
  } else {
    const std::int32_t right = mesh.vertex(PlanMesh::previous(other));
    if (left == right) return false;
    // Round b from right to left, between what is round a.
    const std::int32_t first = mesh.first_corner(star.a);
    star.closed = mesh.opposite(PlanMesh::previous(first)) != kNone;
    if (star.closed) {
      push(left);
      if (!append(mesh, mesh.counterclockwise(corner), right, star)) return false;
    } else {
      push(mesh.vertex(PlanMesh::next(first)));
      if (star.ring[0] != right && !append(mesh, first, right, star)) return false;
    }
    star.b_begin = star.size - 1;
    if (!append(mesh, mesh.counterclockwise(other), left, star)) return false;
    star.b_end = star.left = star.size - 1;
    star.right = star.b_begin;
    if (star.closed) {
      --star.size;  // left has come round
      star.left = 0;
    } else if (!append(mesh, mesh.counterclockwise(corner), kNone, star)) {
      return false;
    }
    // Left alone on the outline, an apex would vanish with its triangle.
    const std::int32_t beside_left = mesh.opposite(corner),
                       beside_left_b = mesh.opposite(PlanMesh::next(corner));
    const std::int32_t beside_right = mesh.opposite(other),
                       beside_right_b = mesh.opposite(PlanMesh::next(other));
    if (beside_left == kNone && beside_left_b == kNone) return false;
    if (beside_right == kNone && beside_right_b == kNone) return false;
  }
  // Neighbours of both ends are the two apices alone: the ring meets itself nowhere.
  const int only_b_begin = outline_edge && !a_is_next ? 0 : star.b_begin + 1;
  const int only_b_end = a_is_next ? star.size : star.b_end;
  for (int i = only_b_begin; i < only_b_end; ++i) {
    const std::int32_t v = star.ring[static_cast<std::size_t>(i)];
    for (int j = 0; j < star.size; ++j) {
      if (j != i && star.ring[static_cast<std::size_t>(j)] == v) return false;
    }
  }
  for (int i = 0; i < star.size; ++i)
    star.at[static_cast<std::size_t>(i)] = mesh.place(star.ring[static_cast<std::size_t>(i)]);
  if (star.closed) star.at[static_cast<std::size_t>(star.size)] = star.at[0];
  star.place_a = mesh.place(star.a);
  star.place_b = mesh.place(star.b);
  return true;
}

}  // namespace sightbound
