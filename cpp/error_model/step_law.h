// SPDX-License-Identifier: GPL-3.0-or-later
// Where the samples around a place stand level, little lies between them, however rough their surroundings: a
// roof is flat up to its edge. Where they step, much may.
//
//   variance = sigma^2 (level + step g^2) / (1 + g^2),  g = half the range of the samples around / sigma
//
// Both are 1 on self-affine ground; in cities level was 0.3-0.5 and step 2-2.6
// (docs/concepts/error_model.md).
#pragma once

#include <algorithm>
#include <cmath>

namespace sightbound {

struct StepVariance {
  double level = 1, step = 1;

  // Of sigma; 1 where nothing is known (NaN).
  double factor(double half_range_m, double sigma_m) const {
    if (is_even()) return 1;
    const double g2 = half_range_m * half_range_m, s2 = sigma_m * sigma_m;
    const double factor = (level * s2 + step * g2) / (s2 + g2);
    return std::isnan(factor) ? 1 : std::sqrt(factor);
  }
  // sigma^2 counts the same everywhere.
  bool is_even() const { return level == 1 && step == 1; }
  double largest_factor() const { return std::sqrt(std::max(level, step)); }
};

}  // namespace sightbound
