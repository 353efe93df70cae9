// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/view_tree.h"

#include <tuple>
#include <utility>

namespace sightbound {

namespace {

Box3 around(const Box3& a, const Box3& b) {
  return {{std::min(a.low.x, b.low.x), std::min(a.low.y, b.low.y), std::min(a.low.z, b.low.z)},
          {std::max(a.high.x, b.high.x), std::max(a.high.y, b.high.y), std::max(a.high.z, b.high.z)}};
}

}  // namespace

ViewTree::ViewTree(std::vector<ViewPlace> places) : places_(std::move(places)) {
  nodes_.reserve(2 * places_.size());
  grow(0, places_.size());
}

// Halves along the longest side.
std::size_t ViewTree::grow(std::size_t first, std::size_t last) {
  Node node;
  node.first = first, node.last = last;
  node.box = places_[first].cell;
  node.places = {places_[first].place, places_[first].place};
  for (std::size_t n = first + 1; n < last; ++n) {
    node.box = around(node.box, places_[n].cell);
    node.places = around(node.places, {places_[n].place, places_[n].place});
  }
  const std::size_t number = nodes_.size();
  nodes_.push_back(node);
  if (last - first == 1) return number;

  const Xyz size = node.box.high - node.box.low;
  double Xyz::*const axis = size.x >= size.y && size.x >= size.z ? &Xyz::x
                            : size.y >= size.z                   ? &Xyz::y
                                                                 : &Xyz::z;
  const std::size_t middle = first + (last - first) / 2;
  const auto at = [&](std::size_t n) { return places_.begin() + static_cast<std::ptrdiff_t>(n); };
  std::sort(at(first), at(last), [&](const ViewPlace& a, const ViewPlace& b) {
    const auto key = [&](const ViewPlace& v) {
      return std::tuple(v.place.*axis, v.place.x, v.place.y, v.place.z);
    };
    return key(a) < key(b);
  });
  const std::size_t lower = grow(first, middle), upper = grow(middle, last);
  nodes_[number].lower = lower, nodes_[number].upper = upper;
  return number;
}

}  // namespace sightbound
