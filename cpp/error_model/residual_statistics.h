// SPDX-License-Identifier: GPL-3.0-or-later
// What a set of residuals (DEM minus truth, metres) says in figures.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "error_model/tails.h"

namespace sightbound {

inline constexpr double kOutlierNmads = 5;                 // farther from the median is told of as an outlier
inline constexpr double kNormalOfMad = 1.482602218505602;  // 1 / the normal quantile at 0.75

struct ResidualStatistics {
  std::size_t count = 0;
  double mean = 0, median = 0;  // bias
  double rmse = 0, sd = 0;      // about 0; about the mean
  double nmad = 0;              // 1.4826 median |r - median|: sd of normal residuals, deaf to outliers
  double le90 = 0, le95 = 0;    // quantiles of |r|
  double le90_unbiased = 0, le95_unbiased = 0;  // quantiles of |r - median|
  double skewness = 0, excess_kurtosis = 0;     // 0 for a normal distribution
  std::size_t outliers = 0;                     // counted, never dropped
};

// O(n log n). At least two residuals, all finite.
ResidualStatistics statistics_of(std::span<const double> residuals);

// The value below which the next draw falls with probability p, as far as n draws can tell: place (n + 1) p
// among them in order, between neighbours linear, at most the largest (Hyndman & Fan 1996, definition 6).
// `sorted` is not empty.
double quantile(std::span<const double> sorted, double p);

// Standard deviation from the 90 % quantile of |r|: on it the three kinds of tails agree within 5 %, and a
// few gross errors do not move it. `sorted` are the |r| in order.
double scale_of(std::span<const double> sorted, Tails tails);

// The kind of tails whose quantiles at 50, 90, 95 and 99 % the |r| follow best, whatever their size; the
// first of them tells Laplace from Student. Normal for fewer than kFewestForTails, which have no 99 %
// quantile.
inline constexpr std::size_t kFewestForTails = 100;
Tails tails_of(std::span<const double> sorted);

// |values| in order.
std::vector<double> sorted_sizes(std::span<const double> values);

}  // namespace sightbound
