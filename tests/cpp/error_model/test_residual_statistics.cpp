// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "error_model/residual_statistics.h"

namespace sightbound {
namespace {

// n quantiles of a distribution of standard deviation `sigma`, evenly spread: the distribution without
// chance.
std::vector<double> ideal(Tails tails, double sigma, int n) {
  std::vector<double> values;
  for (int i = 0; i < n; ++i) values.push_back(sigma * one_sided_quantile((i + 0.5) / n, tails));
  return values;
}

TEST(ResidualStatistics, OfAFewNumbers) {
  const std::vector<double> r = {3, -1, 0, 1, 2};
  const ResidualStatistics found = statistics_of(r);
  EXPECT_EQ(found.count, 5u);
  EXPECT_DOUBLE_EQ(found.mean, 1);
  EXPECT_DOUBLE_EQ(found.median, 1);
  EXPECT_DOUBLE_EQ(found.rmse, std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(found.sd, std::sqrt(2.5));
  EXPECT_DOUBLE_EQ(found.nmad, kNormalOfMad);  // |r - 1| = 0 1 1 2 2
  EXPECT_NEAR(found.skewness, 0, 1e-15);
  EXPECT_NEAR(found.excess_kurtosis, 34.0 / 5 / 4 - 3, 1e-12);
  EXPECT_DOUBLE_EQ(found.le90, 3);
  EXPECT_DOUBLE_EQ(found.le90_unbiased, 2);
  EXPECT_EQ(found.outliers, 0u);
}

TEST(ResidualStatistics, OutliersLieBeyondFiveNmad) {
  std::vector<double> r = ideal(Tails::kNormal, 1, 999);
  r.push_back(50);
  r.push_back(-50);
  EXPECT_EQ(statistics_of(r).outliers, 2u);
  EXPECT_NEAR(statistics_of(r).nmad, 1, 0.01);
}

TEST(ResidualStatistics, EqualResidualsHaveNoSpread) {
  const ResidualStatistics found = statistics_of(std::vector<double>(12, 0.25));
  EXPECT_EQ(found.median, 0.25);
  EXPECT_EQ(found.sd, 0);
  EXPECT_EQ(found.nmad, 0);
  EXPECT_EQ(found.excess_kurtosis, 0);
  EXPECT_EQ(found.outliers, 0u);
}

TEST(Quantile, OfDrawsHoldsTheNextWithItsProbability) {
  const std::vector<double> nine = {1, 2, 3, 4, 5, 6, 7, 8, 9};  // ten gaps for the next, equally likely
  EXPECT_DOUBLE_EQ(quantile(nine, 0.5), 5);
  EXPECT_DOUBLE_EQ(quantile(nine, 0.9), 9);
  EXPECT_DOUBLE_EQ(quantile(nine, 0.85), 8.5);
  EXPECT_DOUBLE_EQ(quantile(nine, 0.99), 9);
  EXPECT_DOUBLE_EQ(quantile(nine, 0.01), 1);
  EXPECT_DOUBLE_EQ(quantile(std::vector<double>{4}, 0.9), 4);
}

TEST(Tails, AreThoseThatTheResidualsWereDrawnFrom) {
  for (const Tails tails : {Tails::kNormal, Tails::kLaplace, Tails::kStudent}) {
    for (const int n : {100, 2000}) {
      const std::vector<double> sizes = sorted_sizes(ideal(tails, 3.7, n));
      EXPECT_EQ(tails_of(sizes), tails) << name_of(tails) << " " << n;
      EXPECT_NEAR(scale_of(sizes, tails), 3.7, n == 100 ? 0.2 : 0.02) << name_of(tails) << " " << n;
    }
  }
}

TEST(Tails, OfFewOrEqualResidualsAreNormal) {
  EXPECT_EQ(tails_of(sorted_sizes(ideal(Tails::kLaplace, 1, 99))), Tails::kNormal);
  EXPECT_EQ(tails_of(std::vector<double>(200, 0.0)), Tails::kNormal);
}

TEST(Scale, IsNotMovedByAFewBlunders) {
  std::vector<double> r = ideal(Tails::kNormal, 2, 1000);
  for (int i = 0; i < 20; ++i) r.push_back(500);
  EXPECT_NEAR(scale_of(sorted_sizes(r), Tails::kNormal), 2, 0.25);
}

}  // namespace
}  // namespace sightbound
