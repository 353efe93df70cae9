// SPDX-License-Identifier: GPL-3.0-or-later
// The place of a set of triangles that is nearest to a place in space: a tree of boxes. Internal to verify.
//
// Build O(n log n), 56 bytes a triangle and its corners; a query some microseconds. Exact but for rounding.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "terrain/tin.h"

namespace sightbound {

using Triangle3 = std::array<Xyz, 3>;

// Of a triangle, which may be a line or a point; Ericson, Real-Time Collision Detection, 5.1.5.
Xyz nearest_place(const Triangle3& triangle, const Xyz& p);

class NearestFace {
 public:
  explicit NearestFace(std::vector<Triangle3> triangles);

  struct Found {
    double distance = 0;  // metres
    std::size_t face = 0;
    Xyz place;
  };
  // Of equally near faces the one with the lowest number. Any thread.
  Found nearest(const Xyz& p) const;

  const std::vector<Triangle3>& triangles() const { return triangles_; }

 private:
  struct Node {
    Box3 box;
    std::uint32_t first = 0, last = 0;   // order_[first, last)
    std::uint32_t lower = 0, upper = 0;  // nodes; 0 = a leaf
  };
  std::uint32_t grow(std::uint32_t first, std::uint32_t last);

  std::vector<Triangle3> triangles_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace sightbound
