// SPDX-License-Identifier: GPL-3.0-or-later
// Where the samples around a place stand level, little lies between them, however rough their surroundings: a
// roof is flat up to its edge. Where they step, much may.
//
//   h = g^2 / (1 + g^2),  g = half the range of the samples around / sigma
//   variance = sigma^2 (level + step g^2) / (1 + g^2)     linear in h, from level ground to steps
//   scale of a draw = E^q / rms,  q likewise, E exponential: most roofs have nothing on them, a few a chimney
//
// q = 0 is normal, 1/2 Laplace's distribution (Andrews and Mallows 1974). On self-affine ground both
// variances are 1 and both q are 0; in cities level ground had 0.3 to 0.9 and q = 1 to 1.5, steps 1.4 to 2.4
// and q = 0 to 0.2 (docs/concepts/error_model.md).
#pragma once

#include <algorithm>
#include <cmath>

namespace sightbound {

struct StepLaw {
  struct Ground {
    double variance = 1, tail = 0;  // tail: q
  };
  static constexpr double kLargestTail = 1.5;

  Ground level, step;
  bool has_tails = false;  // else what is drawn has those of the error model

  // h; that of a step where nothing is known (NaN).
  static double share_of_step(double half_range_m, double sigma_m) {
    const double g2 = half_range_m * half_range_m, s2 = sigma_m * sigma_m, share = g2 / (s2 + g2);
    return std::isnan(share) ? 1 : share;
  }
  // Of sigma; 1 where nothing is known.
  double factor(double half_range_m, double sigma_m) const {
    if (has_one_variance()) return 1;
    const double g2 = half_range_m * half_range_m, s2 = sigma_m * sigma_m;
    const double factor = (level.variance * s2 + step.variance * g2) / (s2 + g2);
    return std::isnan(factor) ? 1 : std::sqrt(factor);
  }
  double tail(double half_range_m, double sigma_m) const {
    return level.tail + (step.tail - level.tail) * share_of_step(half_range_m, sigma_m);
  }

  // sigma^2 counts the same everywhere.
  bool has_one_variance() const { return level.variance == 1 && step.variance == 1; }
  bool has_one_tail() const { return level.tail == step.tail; }
  bool is_normal() const { return level.tail == 0 && step.tail == 0; }  // of its tails
  // Where the ground steps makes no difference.
  bool is_even() const { return has_one_variance() && has_one_tail(); }
  double largest_factor() const { return std::sqrt(std::max(level.variance, step.variance)); }
};

}  // namespace sightbound
