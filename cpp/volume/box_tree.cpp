// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/box_tree.h"

#include <cmath>

namespace sightbound {

namespace {

// Every third bit of the result, from 21 bits.
std::uint64_t spread(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffffu;
  x = (x | x << 16) & 0x1f0000ff0000ffu;
  x = (x | x << 8) & 0x100f00f00f00f00fu;
  x = (x | x << 4) & 0x10c30c30c30c30c3u;
  return (x | x << 2) & 0x1249249249249249u;
}

Box3 nothing() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
}

void enlarge(Box3& box, const Box3& other) {
  box.low = {std::min(box.low.x, other.low.x), std::min(box.low.y, other.low.y),
             std::min(box.low.z, other.low.z)};
  box.high = {std::max(box.high.x, other.high.x), std::max(box.high.y, other.high.y),
              std::max(box.high.z, other.high.z)};
}

}  // namespace

BoxTree::BoxTree(std::size_t count, const std::function<Box3(std::size_t)>& box_of) {
  if (count == 0) return;
  Box3 all = nothing();
  for (std::size_t item = 0; item < count; ++item) enlarge(all, box_of(item));
  const Xyz size = all.high - all.low;
  const double scale = 0x1fffff / std::max({size.x, size.y, size.z, 1e-9});  // one scale: cells stay cubes
  std::vector<std::pair<std::uint64_t, std::uint32_t>> codes(count);
  for (std::size_t item = 0; item < count; ++item) {
    const Box3 box = box_of(item);
    const Xyz middle = 0.5 * (box.low + box.high) - all.low;
    codes[item] = {spread(static_cast<std::uint64_t>(middle.x * scale)) |
                       spread(static_cast<std::uint64_t>(middle.y * scale)) << 1 |
                       spread(static_cast<std::uint64_t>(middle.z * scale)) << 2,
                   static_cast<std::uint32_t>(item)};
  }
  std::sort(codes.begin(), codes.end());
  order_.reserve(count);
  for (const auto& code : codes) order_.push_back(code.second);

  std::vector<Box3> level;
  for (std::size_t from = 0; from < count; from += kFan) {
    level.push_back(nothing());
    for (std::size_t i = from; i < std::min(from + kFan, count); ++i)
      enlarge(level.back(), box_of(order_[i]));
  }
  levels_.push_back(std::move(level));
  while (levels_.back().size() > 1) {
    const std::vector<Box3>& below = levels_.back();
    std::vector<Box3> above;
    for (std::size_t from = 0; from < below.size(); from += kFan) {
      above.push_back(nothing());
      for (std::size_t i = from; i < std::min(from + kFan, below.size()); ++i)
        enlarge(above.back(), below[i]);
    }
    levels_.push_back(std::move(above));
  }
}

std::size_t BoxTree::bytes() const {
  std::size_t boxes = 0;
  for (const auto& level : levels_) boxes += level.size();
  return boxes * sizeof(Box3) + order_.size() * sizeof(order_[0]);
}

double BoxTree::distance(const Box3& box, const Xyz& place) {
  const double x = std::max({box.low.x - place.x, place.x - box.high.x, 0.0});
  const double y = std::max({box.low.y - place.y, place.y - box.high.y, 0.0});
  const double z = std::max({box.low.z - place.z, place.z - box.high.z, 0.0});
  return std::sqrt(x * x + y * y + z * z);
}

}  // namespace sightbound
