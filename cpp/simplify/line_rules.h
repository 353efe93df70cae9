// SPDX-License-Identifier: GPL-3.0-or-later
// How far lines may stray in plan: break lines, and the outline where it may.
//
// A vertex of a line stays in its place or leaves. When it does, one edge takes the place of two, and strays
// from both by the vertex's distance h from it, either way: the two are nowhere further than h from the one
// (distance from an edge is a convex function), nor the one from the two (going along them, the nearest place
// of the edge runs from its one end to the other). So an edge that takes the place of two which have strayed
// by s1 and s2 strays by max(s1, s2) + h at most. This is kept with the
// edge, in steps of its line's tolerance, rounded up.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "simplify/edge_star.h"
#include "simplify/plan_mesh.h"

namespace sightbound {

class LineRules {
 public:
  // Nothing strays.
  LineRules() = default;
  // Tolerances in metres. `metres`: of a step by one column (x, y) and by one row, in plan.
  LineRules(double border_m, double break_line_m, const std::array<double, 4>& metres);

  bool outline_moves() const { return border_step_m_ > 0; }

  struct Edge {
    std::int32_t to;  // from vertex a
    PlanMesh::LineEdgeState state;
    bool advances = false;  // the outline, over the triangle that this edge makes with b
  };
  // What takes the place of the line's two edges at vertex b of the star, when b is drawn into a along it.
  // Nothing when b has to stay.
  std::optional<Edge> without_b(const PlanMesh&, const EdgeStar&) const;

 private:
  // How far off a place lies from an edge, metres; 0 only when it lies on it.
  double metres_off(const Point& b, const Point& from, const Point& to) const;

  std::array<double, 4> metres_{1, 0, 0, 1};
  double border_step_m_ = 0, break_line_step_m_ = 0;  // 0: nothing strays
};

}  // namespace sightbound
