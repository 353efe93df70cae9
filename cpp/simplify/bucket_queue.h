// SPDX-License-Identifier: GPL-3.0-or-later
// A queue by cost, to an eighth of a power of two: nothing is compared, nothing is moved.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sightbound {

// Costs are 0 or more.
inline constexpr int kCostShift = 20;  // keeps sign, exponent and 3 bits of a float
inline constexpr std::size_t kCostClasses = std::size_t{1} << (31 - kCostShift);

template <class T>
class BucketQueue {
 public:
  // Of one bucket the last in is the first out.
  void push(float cost, const T& item) {
    const std::size_t n = std::bit_cast<std::uint32_t>(cost) >> kCostShift;
    buckets_[n].push_back(item);
    lowest_ = std::min(lowest_, n);
  }
  // False when there is none left in the first `classes` buckets.
  bool pop(T& item, std::size_t classes = kCostClasses) {
    while (lowest_ < classes && buckets_[lowest_].empty()) ++lowest_;
    if (lowest_ >= classes) return false;
    item = buckets_[lowest_].back();
    buckets_[lowest_].pop_back();
    return true;
  }
  std::size_t size(std::size_t cost_class) const { return buckets_[cost_class].size(); }
  template <class F>
  void for_each(const F& f) const {
    for (std::size_t n = lowest_; n < buckets_.size(); ++n) {
      for (const T& item : buckets_[n]) f(item);
    }
  }

 private:
  std::array<std::vector<T>, kCostClasses> buckets_;
  std::size_t lowest_ = 0;
};

}  // namespace sightbound
