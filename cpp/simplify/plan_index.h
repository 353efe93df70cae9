// SPDX-License-Identifier: GPL-3.0-or-later
// Which faces of a TIN may lie over or under a box in plan.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "terrain/tin.h"

namespace sightbound {

class PlanIndex {
 public:
  explicit PlanIndex(const Tin&);

  // f(face) for each face whose own box meets this one, and for some more; some several times.
  template <class F>
  void for_near(const Xyz& low, const Xyz& high, const F& f) const {
    for (std::size_t y = bin(low.y - low_.y); y <= bin(high.y - low_.y); ++y) {
      for (std::size_t x = bin(low.x - low_.x); x <= bin(high.x - low_.x); ++x) {
        const std::size_t n = y * side_ + x;
        for (std::size_t i = begin_[n]; i < begin_[n + 1]; ++i) f(faces_[i]);
      }
    }
  }

 private:
  std::size_t bin(double metres) const {
    const double bins = metres / size_;
    return bins > 0 ? std::min(static_cast<std::size_t>(bins), side_ - 1) : 0;
  }

  Xyz low_;
  double size_ = 1;  // of a bin
  std::size_t side_ = 1;
  std::vector<std::size_t> begin_;  // of each bin, in faces_
  std::vector<std::int32_t> faces_;
};

}  // namespace sightbound
