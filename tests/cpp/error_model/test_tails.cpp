// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"
#include "error_model/error_model.h"
#include "error_model/tails.h"

namespace sightbound {
namespace {

constexpr Tails kAll[] = {Tails::kNormal, Tails::kLaplace, Tails::kStudent};

TEST(Tails, NormalIsTheNormalDistributionToTheLastBit) {
  for (double c = 0.01; c < 1; c += 0.01) {
    EXPECT_EQ(two_sided_quantile(c, Tails::kNormal), two_sided_quantile(c));
    EXPECT_EQ(cdf(5 * c - 3, Tails::kNormal), normal_cdf(5 * c - 3));
  }
}

// Student: tables of t with 5 degrees of freedom (two-sided 90, 95, 99, 99.9 %), divided by sqrt(5 / 3).
TEST(Tails, QuantilesAreThoseOfTheTables) {
  const double sd = std::sqrt(5.0 / 3);
  EXPECT_NEAR(two_sided_quantile(0.90, Tails::kStudent), 2.0150483733330238 / sd, 1e-13);
  EXPECT_NEAR(two_sided_quantile(0.95, Tails::kStudent), 2.5705818356363155 / sd, 1e-13);
  EXPECT_NEAR(two_sided_quantile(0.99, Tails::kStudent), 4.0321429835552281 / sd, 1e-13);
  EXPECT_NEAR(two_sided_quantile(0.999, Tails::kStudent), 6.8688266258811105 / sd, 2e-13);
  EXPECT_NEAR(two_sided_quantile(0.95, Tails::kLaplace), std::log(20.0) / std::sqrt(2.0), 1e-14);
}

TEST(Tails, QuantileInvertsTheDistributionEverywhere) {
  for (const Tails tails : kAll) {
    for (double c = 0.001; c < 1; c += 0.001) {
      EXPECT_NEAR(2 * cdf(two_sided_quantile(c, tails), tails) - 1, c, 4e-15) << name_of(tails) << c;
    }
    for (double tail = 1e-3; tail > 1e-15; tail /= 10) {
      const double k = two_sided_quantile(1 - tail, tails);
      EXPECT_NEAR(2 * cdf(-k, tails) / (1 - (1 - tail)), 1, 1e-12) << name_of(tails) << tail;
    }
    for (const double p : {1e-9, 0.001, 0.3, 0.5, 0.8, 0.9995}) {
      EXPECT_NEAR(cdf(one_sided_quantile(p, tails), tails) / p, 1, 1e-13 + 1e-16 / p) << name_of(tails) << p;
    }
  }
}

// Simpson over the upper half, k = tan(a): the variance is 1, and F(k) + F(-k) = 1.
TEST(Tails, UnitVarianceAndSymmetry) {
  for (const Tails tails : kAll) {
    constexpr int kSteps = 20000;
    double sum = 0;  // Int 2 * 2 k (1 - F(k)) dk = variance
    for (int i = 0; i < kSteps; ++i) {
      const double a = (i + 0.5) * std::acos(0.0) / kSteps, k = std::tan(a);
      sum += 4 * k * cdf(-k, tails) * (1 + k * k) * std::acos(0.0) / kSteps;
    }
    EXPECT_NEAR(sum, 1, 1e-6) << name_of(tails);
    for (const double k : {0.0, 0.3, 1.0, 2.9, 3.1, 8.0}) {
      EXPECT_NEAR(cdf(k, tails) + cdf(-k, tails), 1, 1e-15) << name_of(tails) << k;
    }
  }
}

TEST(Tails, FarOutTheSeriesAndTheClosedFormMeet) {
  const double join = std::sqrt(15.0) / std::sqrt(5.0 / 3);  // sin a = 1/2
  const double below = cdf(-join * (1 + 1e-12), Tails::kStudent),
               above = cdf(-join * (1 - 1e-12), Tails::kStudent);
  EXPECT_NEAR(below / above, 1, 2e-11);
  EXPECT_LT(below, above);
  // The leading term, (8 / 3 pi) 5^(5/2) / 5 t^-5, a thousand sd out.
  const double t = 1000 * std::sqrt(5.0 / 3);
  EXPECT_NEAR(cdf(-1000, Tails::kStudent) / (8 / (3 * std::acos(-1.0)) * std::pow(5, 1.5) * std::pow(t, -5)),
              1, 2e-5);
}

TEST(Tails, NamesComeBackAndOthersAreRefused) {
  for (const Tails tails : kAll) EXPECT_EQ(tails_from(name_of(tails)), tails);
  EXPECT_THROW(tails_from("cauchy"), InvalidInput);
  for (const Tails tails : kAll) {
    for (const double c : {0.0, 1.0, -0.5, 95.0, std::nan("")}) {
      EXPECT_THROW(two_sided_quantile(c, tails), InvalidInput) << c;
    }
  }
}

}  // namespace
}  // namespace sightbound
