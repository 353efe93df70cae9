// SPDX-License-Identifier: GPL-3.0-or-later
// A fixed set of boxes, found by place: sorted along a Morton curve of their middles, eight to a node, level
// upon level.
//
// 5 bytes a box and some; built in O(n log n). Queries visit the nodes they must; answers do not depend on
// how it was built.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "terrain/tin.h"

namespace sightbound {

class BoxTree {
 public:
  BoxTree() = default;
  // Items [0, count).
  BoxTree(std::size_t count, const std::function<Box3(std::size_t)>& box_of);

  // Calls f(item) for the items of all groups of eight whose common box `wanted(box)`; so also for some
  // others.
  template <class Wanted, class F>
  void visit(const Wanted& wanted, const F& f) const {
    if (!levels_.empty()) visit_node(levels_.size() - 1, 0, wanted, f);
  }

  // The item with the least distance(item), the lowest of several; distance() must be at least that of the
  // item's box.
  struct Nearest {
    std::size_t item = 0;
    double distance = std::numeric_limits<double>::infinity();
  };
  template <class Distance>
  Nearest nearest(const Xyz& place, const Distance& distance) const {
    Nearest best;
    if (!levels_.empty()) search(levels_.size() - 1, 0, place, distance, best);
    return best;
  }

  std::size_t bytes() const;

  // Distance from a place to a box, 0 within.
  static double distance(const Box3& box, const Xyz& place);

 private:
  static constexpr std::size_t kFan = 8;

  template <class Wanted, class F>
  void visit_node(std::size_t level, std::size_t node, const Wanted& wanted, const F& f) const {
    if (!wanted(levels_[level][node])) return;
    const std::size_t below = level == 0 ? order_.size() : levels_[level - 1].size();
    for (std::size_t i = kFan * node; i < std::min(kFan * (node + 1), below); ++i) {
      if (level == 0) {
        f(static_cast<std::size_t>(order_[i]));
      } else {
        visit_node(level - 1, i, wanted, f);
      }
    }
  }

  template <class Distance>
  void search(std::size_t level, std::size_t node, const Xyz& place, const Distance& distance_of,
              Nearest& best) const {
    if (level == 0) {
      for (std::size_t i = kFan * node; i < std::min(kFan * (node + 1), order_.size()); ++i) {
        const std::size_t item = order_[i];
        const double d = distance_of(item);
        if (d < best.distance || (d == best.distance && item < best.item)) best = {item, d};
      }
      return;
    }
    std::array<std::pair<double, std::size_t>, kFan> children;
    std::size_t count = 0;
    for (std::size_t i = kFan * node; i < std::min(kFan * (node + 1), levels_[level - 1].size()); ++i) {
      children[count++] = {distance(levels_[level - 1][i], place), i};
    }
    std::sort(children.begin(), children.begin() + static_cast<std::ptrdiff_t>(count));
    for (std::size_t c = 0; c < count && children[c].first <= best.distance; ++c) {
      search(level - 1, children[c].second, place, distance_of, best);
    }
  }

  std::vector<std::uint32_t> order_;
  std::vector<std::vector<Box3>> levels_;  // [0]: of eight items each
};

}  // namespace sightbound
