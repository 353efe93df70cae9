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
  EXPECT_LT(check.steps().level.variance, 0.6);
  EXPECT_GT(check.steps().step.variance, 1.5);
}

TEST(SelfCheck, SelfAffineGroundIsTheSameOnLevelsAndSteps) {
  const SelfCheck check = check_of(grid_from(256, 256, [](int r, int c) { return hills(r, c, 0.8, 9); }));
  EXPECT_TRUE(check.steps().is_even());
}

// Most of the ground is bare; what stands on the rest is all the higher.
TEST(SelfCheck, LevelGroundThatIsMostlyBareHasHeavyTails) {
  const auto stands = [](int r, int c) { return noise(r / 3, c / 3, 5) < 0.15 ? 4 * noise(r, c, 6) : 0; };
  const SelfCheck check =
      check_of(grid_from(256, 256, [&](int r, int c) { return 0.02 * noise(r, c, 1) + stands(r, c); }));
  EXPECT_GT(check.steps().level.tail, 0.8);
  EXPECT_LT(check.steps().step.tail, check.steps().level.tail);
}

TEST(SelfCheck, GaussianGroundHasNormalTailsOnSmallDemsToo) {
  int normal = 0;
  for (const int side : {48, 64, 96, 128, 192, 256})
    normal += check_of(grid_from(side, side, [&](int r, int c) { return hills(r, c, 0.8, 9 + side); })).steps().is_normal();
  EXPECT_GE(normal, 5);  // by chance one may not
}

TEST(StepLaw, GoesFromLevelToStep) {
  const StepLaw steps{{0.25, 1.2}, {4, 0.2}};
  EXPECT_DOUBLE_EQ(steps.factor(0, 2), 0.5);
  EXPECT_NEAR(steps.factor(1e6, 2), 2, 1e-9);
  EXPECT_DOUBLE_EQ(steps.factor(2, 2), std::sqrt(0.5 * (0.25 + 4)));
  EXPECT_DOUBLE_EQ(steps.factor(NAN, 2), 1);
  EXPECT_DOUBLE_EQ(steps.factor(0, 0), 1);
  EXPECT_DOUBLE_EQ(steps.tail(0, 2), 1.2);
  EXPECT_DOUBLE_EQ(steps.tail(2, 2), 0.7);
  EXPECT_DOUBLE_EQ(steps.tail(NAN, 2), 0.2);
}

}  // namespace
}  // namespace sightbound
