// SPDX-License-Identifier: GPL-3.0-or-later
// How much terrain a collapse moves: the sum of squared volumes between a new vertex and the triangles it
// replaces (Lindstrom and Turk 1998), from the mesh as it is now. It only orders collapses and proposes
// places.
#pragma once

#include "simplify/edge_star.h"

namespace sightbound {

class Quadric {
 public:
  // Of the triangles at both ends of the star's edge.
  explicit Quadric(const EdgeStar& star);

  // Least cost of all.
  Point optimum() const;
  // The best height at a place in plan.
  double best_height(double x, double y) const;
  double cost(const Point& p) const;

 private:
  void add(const Point& apex, const Point& b, const Point& c);

  Point origin_;
  double xx_ = 0, xy_ = 0, xz_ = 0, yy_ = 0, yz_ = 0, zz_ = 0, x_ = 0, y_ = 0, z_ = 0, one_ = 0;
};

}  // namespace sightbound
