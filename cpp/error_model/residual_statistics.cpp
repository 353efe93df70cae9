// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_model/residual_statistics.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

namespace sightbound {

namespace {

double centred_moment(std::span<const double> values, double about, int power) {
  double sum = 0;
  for (const double value : values) sum += std::pow(value - about, power);
  return sum / static_cast<double>(values.size());
}

// How unlike the two are in shape: the spread of the logarithms of (quantile of |r| / quantile of the tails).
double misfit(std::span<const double> sorted, Tails tails) {
  double sum = 0, squares = 0;
  int count = 0;
  for (const double c : {0.5, 0.9, 0.95, 0.99}) {
    const double ratio = std::log(quantile(sorted, c) / two_sided_quantile(c, tails));
    sum += ratio, squares += ratio * ratio, ++count;
  }
  return squares - sum * sum / count;
}

}  // namespace

double quantile(std::span<const double> sorted, double p) {
  const double place = p * (static_cast<double>(sorted.size()) + 1) - 1;
  const double last = static_cast<double>(sorted.size()) - 1;
  const double inside = std::clamp(place, 0.0, last);
  const auto below = static_cast<std::size_t>(inside);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (inside - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

std::vector<double> sorted_sizes(std::span<const double> values) {
  std::vector<double> sizes(values.begin(), values.end());
  for (double& value : sizes) value = std::abs(value);
  std::sort(sizes.begin(), sizes.end());
  return sizes;
}

double scale_of(std::span<const double> sorted, Tails tails) {
  return quantile(sorted, 0.9) / two_sided_quantile(0.9, tails);
}

Tails tails_of(std::span<const double> sorted) {
  if (sorted.size() < kFewestForTails || quantile(sorted, 0.5) <= 0) return Tails::kNormal;
  Tails best = Tails::kNormal;
  double least = std::numeric_limits<double>::infinity();
  for (const Tails tails : {Tails::kNormal, Tails::kLaplace, Tails::kStudent}) {
    const double apart = misfit(sorted, tails);
    if (apart < least) least = apart, best = tails;
  }
  return best;
}

ResidualStatistics statistics_of(std::span<const double> residuals) {
  std::vector<double> sorted(residuals.begin(), residuals.end());
  std::sort(sorted.begin(), sorted.end());
  ResidualStatistics out;
  out.count = sorted.size();
  const auto n = static_cast<double>(out.count);
  out.mean = centred_moment(sorted, 0, 1);
  out.median = quantile(sorted, 0.5);
  out.rmse = std::sqrt(centred_moment(sorted, 0, 2));
  const double variance = centred_moment(sorted, out.mean, 2);
  out.sd = std::sqrt(variance * n / (n - 1));
  if (variance > 0) {
    out.skewness = centred_moment(sorted, out.mean, 3) / std::pow(variance, 1.5);
    out.excess_kurtosis = centred_moment(sorted, out.mean, 4) / (variance * variance) - 3;
  }
  const std::vector<double> sizes = sorted_sizes(sorted);
  out.le90 = quantile(sizes, 0.9);
  out.le95 = quantile(sizes, 0.95);
  for (double& value : sorted) value -= out.median;
  const std::vector<double> apart = sorted_sizes(sorted);
  out.nmad = kNormalOfMad * quantile(apart, 0.5);
  out.le90_unbiased = quantile(apart, 0.9);
  out.le95_unbiased = quantile(apart, 0.95);
  const double limit = kOutlierNmads * out.nmad;
  out.outliers = static_cast<std::size_t>(apart.end() - std::upper_bound(apart.begin(), apart.end(), limit));
  return out;
}

}  // namespace sightbound
