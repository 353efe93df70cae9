// SPDX-License-Identifier: GPL-3.0-or-later
// The vertical envelope: how far the new surface may be from the original, certified with its interior.
//
// A new triangle and the original ones under it cut each other into convex pieces. On each piece new height,
// original height and tolerance are linear, so that all of it lies in the envelope when its corners do. These
// are samples, corners of the new triangle, and places where its edges cross columns, rows and diagonals. At
// each of them the new height is linear in the height of the one vertex that moves: an interval for it.
#pragma once

#include <limits>

#include "simplify/edge_star.h"
#include "simplify/original.h"

namespace sightbound {

struct HeightInterval {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();

  double missing() const { return low - high; }  // positive when empty
};

class Envelope {
 public:
  // `original` must outlive this.
  explicit Envelope(const Original& original);

  // The heights that p (of which x and y count) may have so that the triangles from it to the sides of the
  // star's ring lie in the envelope; the ring's own edges are taken to lie in it already. Stops when more
  // than `most` is missing, with what it has found by then. O(samples covered).
  HeightInterval heights_for(const EdgeStar& star, const Point& p, double most) const;
  // The same where vertex a stays what it is: only the triangles that were at b are new. Those at a may reach
  // beyond the window.
  HeightInterval heights_at_a(const EdgeStar& star, double most) const;

  double tolerance_near(const Point& p) const { return original_.tolerance_near(p); }

 private:
  // Of the ring's sides from `begin` to `end`.
  template <bool kVarying>
  HeightInterval find(const EdgeStar& star, const Point& p, int begin, int end, double most) const;
  template <bool kVarying>
  void narrow_along(const Point& v, const Point& p, HeightInterval& z) const;
  template <bool kVarying>
  void narrow_inside(const Point& a, const Point& b, const Point& p, double most, HeightInterval& z) const;

  const Original& original_;
  double margin_;  // Original::margin()
};

struct Deviation {
  double metres = 0, ratio = 0;  // to the tolerance at the same place; 0 where both are 0
};

// The largest of a triangle's, rounded up. O(samples covered).
Deviation deviation_of(const Original& original, const Point& a, const Point& b, const Point& c);

}  // namespace sightbound
