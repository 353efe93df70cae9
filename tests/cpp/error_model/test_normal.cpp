// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"
#include "error_model/error_model.h"

namespace sightbound {
namespace {

TEST(Normal, QuantilesAreThoseOfTheTables) {
  // 16 digits from Mathematica-grade tables: two-sided 50, 68.27, 90, 95, 99, 99.9 %.
  EXPECT_NEAR(two_sided_quantile(0.5), 0.6744897501960817, 1e-15);
  EXPECT_NEAR(two_sided_quantile(0.6826894921370859), 1.0, 1e-14);
  EXPECT_NEAR(two_sided_quantile(0.90), 1.6448536269514722, 1e-14);
  EXPECT_NEAR(two_sided_quantile(0.95), 1.959963984540054, 1e-14);
  EXPECT_NEAR(two_sided_quantile(0.99), 2.5758293035489004, 1e-14);
  EXPECT_NEAR(two_sided_quantile(0.999), 3.2905267314919255, 1e-13);
  EXPECT_DOUBLE_EQ(two_sided_quantile(0.95), kZ95);
}

TEST(Normal, QuantileInvertsTheDistributionEverywhere) {
  for (double c = 0.001; c < 1; c += 0.001) {
    EXPECT_NEAR(2 * normal_cdf(two_sided_quantile(c)) - 1, c, 4e-15) << c;
  }
  for (double tail = 1e-3; tail > 1e-15; tail /= 10) {
    const double k = two_sided_quantile(1 - tail);
    EXPECT_NEAR(2 * normal_cdf(-k) / (1 - (1 - tail)), 1, 1e-12) << tail;
  }
}

TEST(Normal, QuantileRefusesWhatIsNoConfidence) {
  for (const double c : {0.0, 1.0, -0.5, 95.0, std::nan("")})
    EXPECT_THROW(two_sided_quantile(c), InvalidInput) << c;
}

TEST(Normal, CdfHoldsInTheTails) {
  EXPECT_DOUBLE_EQ(normal_cdf(0), 0.5);
  EXPECT_NEAR(normal_cdf(-3.29) / 0.0005009369137857222, 1, 1e-13);
  EXPECT_NEAR(normal_cdf(-8) / 6.220960574271785e-16, 1, 1e-12);
}

TEST(Accuracy, MeasuresBecomeOneStandardDeviation) {
  EXPECT_DOUBLE_EQ(vertical_sigma(2, VerticalMeasure::kRmse), 2);
  EXPECT_NEAR(vertical_sigma(1.6448536269514722, VerticalMeasure::kLe90), 1, 1e-15);
  EXPECT_NEAR(vertical_sigma(1.959963984540054, VerticalMeasure::kLe95), 1, 1e-15);
  EXPECT_DOUBLE_EQ(horizontal_sigma(2, HorizontalMeasure::kRmse), 2);
  EXPECT_NEAR(horizontal_sigma(2.145966026289347, HorizontalMeasure::kCe90), 1, 1e-15);
  EXPECT_NEAR(horizontal_sigma(2.447746830680816, HorizontalMeasure::kCe95), 1, 1e-15);
}

}  // namespace
}  // namespace sightbound
