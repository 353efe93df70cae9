// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "error_model/error_model.h"
#include "error_model/normal_pair.h"

namespace sightbound {
namespace {

// X = x; Y given x is normal about rho x: the other integral, by Simpson's rule in many steps.
double by_steps(double h, double k, double rho) {
  const double rest = std::sqrt(1 - rho * rho), from = -10, to = std::min(h, 10.0);
  if (to <= from) return 0;
  constexpr int kSteps = 20000;
  double sum = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double x = from + (to - from) * i / kSteps;
    const double f = std::exp(-0.5 * x * x) * normal_cdf((rho * x - k) / rest);
    sum += f * (i == 0 || i == kSteps ? 1 : (i % 2 == 1 ? 4 : 2));
  }
  return sum * (to - from) / kSteps / 3 / std::sqrt(2 * std::numbers::pi);
}

TEST(NormalPair, IsTheOtherIntegral) {
  for (const double rho : {-0.95, -0.4, 0.0, 0.3, 0.8, 0.99, 0.9999}) {
    for (const double h : {-4.0, -2.5, -0.5, 0.0, 1.0, 3.0}) {
      for (const double k : {-4.0, -2.6, -2.4999, -0.5, 0.2, 2.0}) {
        const double expected = by_steps(h, k, rho);
        EXPECT_NEAR(below_while_above(h, k, rho), expected, 1e-9 + 1e-5 * expected)
            << h << ' ' << k << ' ' << rho;
      }
    }
  }
}

TEST(NormalPair, KnowsItsLimits) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_NEAR(below_while_above(-1, 0.5, 0), normal_cdf(-1) * normal_cdf(-0.5), 1e-14);
  EXPECT_EQ(below_while_above(-2, -2, 1), 0);
  EXPECT_NEAR(below_while_above(-1, -2, 1), normal_cdf(-1) - normal_cdf(-2), 1e-16);
  EXPECT_EQ(below_while_above(-kInfinity, 0, 0.5), 0);
  EXPECT_EQ(below_while_above(kInfinity, 0, 0.5), 0.5);
  EXPECT_EQ(below_while_above(0, kInfinity, 0.5), 0);
  EXPECT_EQ(below_while_above(0, -kInfinity, 0.5), 0.5);
}

}  // namespace
}  // namespace sightbound
