// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <gtest/gtest.h>

#include "error_model/rounding.h"
#include "support/terrains.h"

namespace sightbound {
namespace {

using testing::grid_from;
using testing::hills;
using testing::kNan;
using testing::noise;

double step_of(const Grid<float>& block) {
  RoundingDetector detector;
  detector.add(block);
  return detector.step_m();
}

// Hills rounded to `step`, `base` metres up; as a file of such units holds them.
Grid<float> rounded_hills(double step, double base = 0) {
  return grid_from(64, 64,
                   [=](int r, int c) { return step * std::round((base + hills(r, c, 1, 3)) / step); });
}

TEST(Rounding, StepsInUseAreFound) {
  for (const double step : {1.0, 0.5, 0.1, 0.01, 0.3048, 0.03048}) {
    EXPECT_NEAR(step_of(rounded_hills(step)), step, 1e-12) << step;
  }
  EXPECT_DOUBLE_EQ(step_of(rounded_hills(1, 3500)), 1);
  EXPECT_DOUBLE_EQ(step_of(rounded_hills(0.1, 3500)), 0.1);
  EXPECT_DOUBLE_EQ(step_of(rounded_hills(1, -3500)), 1);
}

TEST(Rounding, FeetScaledAsFloatsAreFeet) {
  const auto foot = static_cast<float>(0.3048), us_foot = static_cast<float>(1200.0 / 3937.0);
  EXPECT_NEAR(step_of(grid_from(
                  64, 64, [=](int r, int c) { return std::round(float(3000 + hills(r, c, 1, 3))) * foot; })),
              0.3048, 1e-9);
  EXPECT_NEAR(
      step_of(grid_from(64, 64,
                        [=](int r, int c) { return std::round(float(3000 + hills(r, c, 1, 3))) * us_foot; })),
      1200.0 / 3937.0, 1e-9);
}

TEST(Rounding, UnroundedHeightsAreNotRounded) {
  EXPECT_EQ(step_of(grid_from(64, 64, [](int r, int c) { return hills(r, c, 1, 3); })), 0);
  EXPECT_EQ(step_of(grid_from(64, 64, [](int r, int c) { return 8000 + hills(r, c, 1, 3); })), 0);
}

TEST(Rounding, OneUnroundedHeightIsEnough) {
  Grid<float> z = rounded_hills(1);
  z.at(32, 32) += 0.37f;
  EXPECT_EQ(step_of(z), 0);
}

TEST(Rounding, IdealShapesWithWholeMetresAreNotRounded) {
  EXPECT_EQ(step_of(Grid<float>(64, 64, 100.0f)), 0);
  EXPECT_EQ(step_of(grid_from(64, 64, [](int r, int c) { return c + 2 * r; })), 0);            // plane
  EXPECT_EQ(step_of(grid_from(64, 64, [](int, int c) { return c < 32 ? 0 : 10; })), 0);        // step
  EXPECT_EQ(step_of(grid_from(64, 64, [](int, int c) { return 50 - std::abs(c - 31); })), 0);  // ridge
}

TEST(Rounding, HolesAreSkipped) {
  Grid<float> z = rounded_hills(1);
  for (int r = 0; r < 64; ++r) {
    for (int c = 0; c < 64; ++c) {
      if (noise(r, c, 1) < 0.2) z.at(r, c) = kNan;
    }
  }
  EXPECT_EQ(step_of(z), 1);
  EXPECT_EQ(step_of(Grid<float>(64, 64, kNan)), 0);
}

TEST(Rounding, SdIsThatOfAUniformError) {
  RoundingDetector detector;
  detector.add(rounded_hills(1));
  EXPECT_NEAR(detector.sd_m(), 0.288675, 1e-6);
}

}  // namespace
}  // namespace sightbound
