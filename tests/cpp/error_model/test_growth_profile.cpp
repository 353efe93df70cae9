// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <gtest/gtest.h>

#include "error_model/error_field.h"

namespace sightbound {
namespace {

TEST(GrowthProfile, GaussianWithoutARangeIsThePapers) {
  GrowthProfile profile;
  const double delta = 2.5, amplitude = delta / kZ95;
  EXPECT_DOUBLE_EQ(profile(0, amplitude), 0);
  EXPECT_DOUBLE_EQ(profile(0.3, amplitude), 1 - std::exp(-0.5 * delta * delta * 0.09));  // equations 3.3, 3.4
  EXPECT_DOUBLE_EQ(profile(1e6, amplitude), 1);
  EXPECT_DOUBLE_EQ(profile(1e6, 0), 0);  // nothing between the samples, however far
}

TEST(GrowthProfile, GaussianWithARangeForgetsTheAmplitude) {
  GrowthProfile profile;
  profile.range_m = 10;
  EXPECT_DOUBLE_EQ(profile(10, 1), 1 - std::exp(-0.5));
  EXPECT_DOUBLE_EQ(profile(10, 1), profile(10, 5));
}

TEST(GrowthProfile, StepBeginsAtTheRange) {
  GrowthProfile profile;
  profile.shape = GeologicShape::kStep;
  profile.range_m = 4;
  EXPECT_EQ(profile(std::nextafter(4.0, 0.0), 1), 0);
  EXPECT_EQ(profile(4, 1), 1);
}

TEST(GrowthProfile, GrowthIsOneHalfASpacingAway) {
  GrowthProfile profile;
  profile.shape = GeologicShape::kGrowth;
  profile.exponent = 1.3;
  profile.half_spacing_m = 5;
  EXPECT_EQ(profile(0, 1), 0);
  EXPECT_DOUBLE_EQ(profile(5, 1), 1);
  EXPECT_NEAR(profile(5 * std::sqrt(2.0), 1), std::pow(2, 0.25), 1e-14);  // the middle of a square
  EXPECT_DOUBLE_EQ(profile(2.5, 1), 0.75);                                // t (2 - t)
  profile.exponent = 0.6;
  EXPECT_DOUBLE_EQ(profile(2.5, 1), std::pow(0.75, 0.6));
}

TEST(GrowthProfile, NeverFallsWithDistance) {
  for (const auto shape : {GeologicShape::kGaussian, GeologicShape::kStep, GeologicShape::kGrowth}) {
    for (const double range : {0.0, 3.0}) {
      GrowthProfile profile{shape, range, 0.7, 5};
      double before = 0;
      for (double d = 0; d < 8; d += 0.01) {
        const double share = profile(d, 1.2);
        EXPECT_GE(share, before);
        before = share;
      }
    }
  }
}

}  // namespace
}  // namespace sightbound
