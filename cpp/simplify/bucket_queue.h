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

template <class T>
class BucketQueue {
 public:
  // Costs are 0 or more. Of one bucket the last in is the first out.
  void push(float cost, const T& item) {
    const std::size_t n = std::bit_cast<std::uint32_t>(cost) >> kShift;
    buckets_[n].push_back(item);
    lowest_ = std::min(lowest_, n);
  }
  // False when there is none left.
  bool pop(T& item) {
    while (lowest_ < buckets_.size() && buckets_[lowest_].empty()) ++lowest_;
    if (lowest_ == buckets_.size()) return false;
    item = buckets_[lowest_].back();
    buckets_[lowest_].pop_back();
    return true;
  }

 private:
  static constexpr int kShift = 20;  // keeps sign, exponent and 3 bits of a float
  std::array<std::vector<T>, (std::size_t{1} << (31 - kShift))> buckets_;
  std::size_t lowest_ = 0;
};

}  // namespace sightbound
