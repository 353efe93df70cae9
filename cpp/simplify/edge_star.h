// SPDX-License-Identifier: GPL-3.0-or-later
// All triangles at the two ends of an edge, and what surrounds them: what a collapse of the edge replaces.
#pragma once

#include <array>
#include <cstdint>

#include "simplify/plan_mesh.h"

namespace sightbound {

// The ring is counterclockwise. It is closed when the edge's ends lie inside, else it runs from one neighbour
// on the outline to the other.
struct EdgeStar {
  static constexpr int kMostRing = 64;

  std::int32_t corner = 0;  // at one end of the edge, its next at the other
  std::int32_t a = 0, b = 0;
  bool closed = true;
  int size = 0;  // of the ring
  std::array<std::int32_t, kMostRing + 1> ring;
  std::array<Point, kMostRing + 1> at;  // of the ring; closed ones repeat the first
  Point place_a, place_b;
  // Sides (i, i + 1) of the ring in [b_begin, b_end) belong to triangles at b, the others to triangles at a;
  // the triangles of the edge itself have none.
  int b_begin = 0, b_end = 0;
  int left = 0, right = 0;  // the apices of the edge's triangles in the ring; right is -1 on the outline

  int sides() const { return closed ? size : size - 1; }
  bool belongs_to_b(int side) const { return side >= b_begin && side < b_end; }
};

// Vertex a is the end of the higher kind; of two of one kind, next(corner)'s when that is preferred. False
// when the edge must not be collapsed: b has to stay, or too much surrounds the edge. Where the ring meets
// itself, it encloses triangles whose area a collapse would make 0 in all: whoever asks for positive areas
// everywhere refuses it.
bool gather(const PlanMesh& mesh, std::int32_t corner, bool prefer_next, EdgeStar& star);

// The ring of a vertex inside, which is both a and b. False when it is too long.
bool gather_around(const PlanMesh& mesh, std::int32_t vertex, EdgeStar& star);

}  // namespace sightbound
