// SPDX-License-Identifier: GPL-3.0-or-later
// Collapses that leave the surface exactly as it is: no envelope has a say in them, not even one of no
// thickness.
#pragma once

#include <optional>

#include "simplify/edge_star.h"

namespace sightbound {

// Decided without rounding, for places on the lattice of steps (plan_mesh.h).
bool coplanar(const Point& a, const Point& b, const Point& c, const Point& d);

// The end of the edge that the other one may be drawn into: around that one all triangles lie in one plane,
// or in two that meet in a straight line through the edge. `only_a`: a is the end that has to stay.
std::optional<Point> place_without_change(const EdgeStar& star, bool only_a);

}  // namespace sightbound
