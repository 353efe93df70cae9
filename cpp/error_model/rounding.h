// SPDX-License-Identifier: GPL-3.0-or-later
// Are heights rounded to a step (integer metres, feet, decimetres)?
#pragma once

#include <cstddef>
#include <vector>

#include "terrain/grid.h"

namespace sightbound {

// Takes blocks of heights in metres, then tells the step. A step is claimed only when every height looked at
// is a multiple of it (to the precision of a float), neighbours differ by exactly one step somewhere, and the
// heights are no ideal plane or terrace, for which integers are no rounding.
class RoundingDetector {
 public:
  void add(const Grid<float>& block);

  double step_m() const;  // 0 = not rounded
  // Standard deviation of the rounding: step / sqrt(12).
  double sd_m() const;

 private:
  bool fits(double step) const;

  std::vector<float> heights_;         // every kRowStride-th row's
  double least_difference_ = 0;        // between neighbours, of those above 0
  double largest_height_ = 0;          // absolute
  std::size_t uneven_ = 0, bent_ = 0;  // triples in a row that are not all equal; of those, not on a line
};

}  // namespace sightbound
