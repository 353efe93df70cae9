// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <gtest/gtest.h>

#include "error_model/residual_growth.h"
#include "error_model/self_check.h"
#include "support/terrains.h"

namespace sightbound {
namespace {

using testing::grid_from;
using testing::hills;
using testing::noise;

SelfCheck check_of(const Grid<float>& ground) {
  Progress progress;
  ResidualGrowth growth;
  growth.add(ground);
  SelfCheck check(growth.exponent(1), growth.rms(0));
  check.add(ground, progress);
  check.finish();
  return check;
}

TEST(SelfCheck, OfGaussianGroundIsNormalAndHolds) {
  const SelfCheck check = check_of(grid_from(256, 256, [](int r, int c) { return hills(r, c, 0.8, 9); }));
  EXPECT_GT(check.places(), 10000u);
  EXPECT_NEAR(check.scale(), 1, 0.2);
  EXPECT_LT(check.quantile(0.5), check.quantile(0.95));
}

TEST(SelfCheck, FindsHeavyTails) {
  // Level ground with a sudden rise here and there.
  const SelfCheck check = check_of(grid_from(256, 256, [](int r, int c) {
    return 0.05 * noise(r, c, 1) + (noise(r, c, 2) < 0.01 ? 5 * noise(r, c, 3) : 0);
  }));
  EXPECT_NE(check.tails(), Tails::kNormal);
}

TEST(SelfCheck, FlatRoofsAreFlatUpToTheirEdges) {
  // Blocks of six samples and a little, each of its own height.
  const auto block = [](int r, int c) {
    return 10 * noise(static_cast<int>(r / 6.3), static_cast<int>(c / 6.3), 4);
  };
  const SelfCheck check =
      check_of(grid_from(256, 256, [&](int r, int c) { return block(r, c) + 0.05 * noise(r, c, 1); }));
  EXPECT_LT(check.steps().level, 0.6);
  EXPECT_GT(check.steps().step, 1.5);
}

TEST(SelfCheck, SelfAffineGroundIsTheSameOnLevelsAndSteps) {
  const SelfCheck check = check_of(grid_from(256, 256, [](int r, int c) { return hills(r, c, 0.8, 9); }));
  EXPECT_TRUE(check.steps().is_even());
}

TEST(StepVariance, GoesFromLevelToStep) {
  const StepVariance steps{0.25, 4};
  EXPECT_DOUBLE_EQ(steps.factor(0, 2), 0.5);
  EXPECT_NEAR(steps.factor(1e6, 2), 2, 1e-9);
  EXPECT_DOUBLE_EQ(steps.factor(2, 2), std::sqrt(0.5 * (0.25 + 4)));
  EXPECT_DOUBLE_EQ(steps.factor(NAN, 2), 1);
  EXPECT_DOUBLE_EQ(steps.factor(0, 0), 1);
}

}  // namespace
}  // namespace sightbound
