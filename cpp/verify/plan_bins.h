// SPDX-License-Identifier: GPL-3.0-or-later
// The faces of a simplified TIN, sorted into square bins of the plan.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "verify/plan_face.h"

namespace sightbound {

// About as many bins as faces. 150 bytes a face, and 4 for each bin that its box meets.
class PlanBins {
 public:
  // Keeps the faces. Those without width are in no bin. What is no wider than `rim` may come of the rounding
  // of coordinates and is no defect.
  PlanBins(std::vector<PlanFace> faces, double rim);

  const std::vector<PlanFace>& faces() const { return faces_; }
  double rim() const { return rim_; }

  // visit(number) for each face whose box meets the box, once each, in an order that depends on the box
  // alone.
  template <class Visit>
  void each_near(const PlanBox& box, const Visit& visit) const {
    const Range across = range(box.low.x, box.high.x, origin_.x, cols_),
                down = range(box.low.y, box.high.y, origin_.y, rows_);
    for (int j = down.first; j <= down.last; ++j) {
      for (int i = across.first; i <= across.last; ++i) {
        const std::size_t bin =
            static_cast<std::size_t>(j) * static_cast<std::size_t>(cols_) + static_cast<std::size_t>(i);
        for (std::size_t n = begins_[bin]; n < begins_[bin + 1]; ++n) {
          const PlanBox& other = faces_[numbers_[n]].box;
          if (!other.meets(box)) continue;
          // Of the bins that both are in only the first one tells.
          if (i == std::max(across.first, column(other.low.x)) && j == std::max(down.first, row(other.low.y)))
            visit(static_cast<std::size_t>(numbers_[n]));
        }
      }
    }
  }

 private:
  struct Range {
    int first, last;
  };
  static int clamped(double value, int count) {
    return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(count - 1)));
  }
  int column(double x) const { return clamped((x - origin_.x) / side_, cols_); }
  int row(double y) const { return clamped((y - origin_.y) / side_, rows_); }
  Range range(double low, double high, double from, int count) const {
    return {clamped((low - from) / side_, count), clamped((high - from) / side_, count)};
  }

  std::vector<PlanFace> faces_;
  double rim_;
  Xy origin_;
  double side_ = 1;
  int cols_ = 1, rows_ = 1;
  std::vector<std::size_t> begins_;     // of each bin in numbers_
  std::vector<std::uint32_t> numbers_;  // of faces
};

}  // namespace sightbound
