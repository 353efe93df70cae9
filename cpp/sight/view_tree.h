// SPDX-License-Identifier: GPL-3.0-or-later
// The places that a volume viewshed looks from, in a tree of boxes: what is proven of a box is proven of
// every place in it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "terrain/tin.h"

namespace sightbound {

// A part of a view volume, and the place in it that stands for it. A point is its own cell.
struct ViewPlace {
  Xyz place;
  Box3 cell;

  static ViewPlace point(const Xyz& place) { return {place, {place, place}}; }
  bool is_point() const { return cell.low == cell.high; }
};

class ViewTree {
 public:
  struct Node {
    Box3 box, places;                  // around the cells; around the places
    std::size_t first = 0, last = 0;   // places [first, last)
    std::size_t lower = 0, upper = 0;  // nodes; 0 = a leaf, one place
    bool is_leaf() const { return lower == 0; }
    double side() const { return std::max(box.high.x - box.low.x, box.high.y - box.low.y); }
  };

  // At least one place.
  explicit ViewTree(std::vector<ViewPlace> places);

  const std::vector<ViewPlace>& places() const { return places_; }
  const Node& root() const { return nodes_[0]; }
  const Node& node(std::size_t number) const { return nodes_[number]; }

 private:
  std::size_t grow(std::size_t first, std::size_t last);

  std::vector<ViewPlace> places_;
  std::vector<Node> nodes_;
};

}  // namespace sightbound
