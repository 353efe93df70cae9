// SPDX-License-Identifier: GPL-3.0-or-later
// How far a vertex is from the planes of the original triangles that it stands for: the sum of area times
// squared height (Garland and Heckbert 1997, with heights for distances). It only orders collapses and
// proposes places.
#pragma once

#include "simplify/plan_mesh.h"

namespace sightbound {

// Relative to a place that its owner knows: the vertex.
struct Quadric {
  float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0, x = 0, y = 0, z = 0, one = 0;

  // The plane through a, b, c, seen from `here`.
  void add_triangle(const Point& a, const Point& b, const Point& c, const Point& here);
  // Of the same place.
  Quadric& operator+=(const Quadric& other);
};

// The sum of those of two vertices.
class QuadricSum {
 public:
  QuadricSum(const Quadric& q, const Point& q_place, const Quadric& r, const Point& r_place);

  // Least cost of all.
  Point optimum() const;
  // The best height at a place in plan.
  double best_height(double x, double y) const;
  double cost(const Point& p) const;
  // As seen from the vertex that the two become.
  Quadric seen_from(const Point& here) const;

 private:
  void add(const Quadric& q, const Point& place);

  Point middle_;
  double xx_ = 0, xy_ = 0, xz_ = 0, yy_ = 0, yz_ = 0, zz_ = 0, x_ = 0, y_ = 0, z_ = 0, one_ = 0;
};

}  // namespace sightbound
