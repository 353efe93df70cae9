// SPDX-License-Identifier: GPL-3.0-or-later
// How far a place is from the planes of the original faces that a vertex stands for: the sum of area times
// squared distance (Garland and Heckbert 1997). It only orders collapses and proposes places.
//
//   cost(p) = p'Ap + 2 b'p + c,  p seen from the vertex, in metres; A symmetric
#pragma once

#include "terrain/tin.h"

namespace sightbound {

class TinQuadric {
 public:
  // The plane through `place` (seen from the vertex) with that unit normal.
  void add_plane(const Xyz& normal, const Xyz& place, double weight);
  void add(const TinQuadric&);
  // The same, seen from a vertex that lies `step` from this one.
  TinQuadric moved(const Xyz& step) const;

  double cost(const Xyz& p) const;
  // Least cost of all; where a plane or a line of places has that, the one of them nearest to `preferred`.
  Xyz optimum(const Xyz& preferred) const;

 private:
  Xyz row(const Xyz& p) const;  // Ap

  double xx_ = 0, xy_ = 0, xz_ = 0, yy_ = 0, yz_ = 0, zz_ = 0;
  Xyz b_;
  double c_ = 0;
};

}  // namespace sightbound
