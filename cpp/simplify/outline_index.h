// SPDX-License-Identifier: GPL-3.0-or-later
// Where vertices of the outline are: whether the outline may advance without running over another part.
//
// It advances over a triangle a b n, where a - b - n are edges of the outline. An edge that enters the
// triangle elsewhere comes in across a - n, crosses neither of the other two, and so ends in it: no other
// vertex of the outline in the triangle, no edge in it.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "simplify/plan_mesh.h"

namespace sightbound {

class OutlineIndex {
 public:
  void add(std::int32_t vertex, const Point& at) { bins_[bin(step(at.x), step(at.y))].push_back(vertex); }
  // Is there another vertex in the closed triangle of these three? Those that went or moved on do not count.
  bool any_in(const PlanMesh& mesh, std::int32_t a, std::int32_t b, std::int32_t n) const;

 private:
  static std::int64_t step(double cells) { return static_cast<std::int64_t>(cells) / 8; }
  static std::int64_t bin(std::int64_t x, std::int64_t y) { return (y << 32) + x; }

  std::unordered_map<std::int64_t, std::vector<std::int32_t>> bins_;
};

}  // namespace sightbound
