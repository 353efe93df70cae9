// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "error_model/fractal_surface.h"

namespace sightbound {
namespace {

TEST(FractalSurface, SamplesScaleWithTheirExponent) {
  for (const double h : {0.3, 0.7, 1.2}) {
    const FractalSurface surface = fractal_surface(h, CellContent::kSamples);
    EXPECT_DOUBLE_EQ(surface.per_residual, std::exp2(-h));
    EXPECT_EQ(surface.node, 0);
    EXPECT_EQ(surface.points, 1);
    EXPECT_DOUBLE_EQ(apparent_exponent(h, CellContent::kSamples), h);
  }
}

// Brownian surfaces (H = 1/2) have |p - q| for covariance of increments: a case to write down by hand.
TEST(FractalSurface, OfABrownianSurfaceIsWhatHandsReckon) {
  // -sum a_i b_j d_ij. A side's middle about its two samples: distances 1/2 to each, 1 between them.
  const double edge = 2 * 2 * 0.5 * 0.5 - 2 * 0.25 * 1;
  // A centre about its four: sqrt(1/2) to each; between them four sides of 1 and two diagonals.
  const double centre = 2 * 4 * 0.25 * std::sqrt(0.5) - 2 * (1.0 / 16) * (4 * 1 + 2 * std::sqrt(2.0));
  const FractalSurface surface = fractal_surface(0.5, CellContent::kSamples);
  // The guide takes off a little; what is left is below the plain ratio, and not by much.
  const double ratio = std::sqrt(centre / edge);
  EXPECT_LT(surface.centre.spread, ratio);
  EXPECT_GT(surface.centre.spread, 0.97 * ratio);
}

TEST(FractalSurface, SmoothGroundIsGuessedLikeACubic) {
  // Four equidistant values of a cubic: the middle is (9 (b + c) - (a + d)) / 16, a gain of 1/8; a little more
  // for rougher ground.
  EXPECT_NEAR(fractal_surface(1.89, CellContent::kSamples).row_edge.gain, 0.133, 0.005);
  EXPECT_LT(fractal_surface(1.6, CellContent::kSamples).row_edge.spread, 0.5);
}

TEST(FractalSurface, LongCellsKnowLessAlongTheirLength) {
  const FractalSurface tall = fractal_surface(0.9, CellContent::kSamples, 2);
  EXPECT_GT(tall.col_edge.spread, tall.row_edge.spread);  // although its centres are nearer
  const FractalSurface square = fractal_surface(0.9, CellContent::kSamples, 1);
  EXPECT_NEAR(square.col_edge.spread, square.row_edge.spread, 1e-9);
}

TEST(FractalSurface, IsContinuousAcrossOne) {
  for (const auto content : {CellContent::kSamples, CellContent::kMeans}) {
    const FractalSurface below = fractal_surface(0.99, content), above = fractal_surface(1.01, content);
    EXPECT_NEAR(below.centre.spread, above.centre.spread, 0.02);
    EXPECT_NEAR(below.row_edge.gain, above.row_edge.gain, 0.005);
    EXPECT_NEAR(below.node, above.node, 0.02);
  }
}

TEST(FractalSurface, MeansComeBackFromTheirApparentExponent) {
  for (const double h : {0.2, 0.6, 1.0, 1.5}) {
    const double apparent = apparent_exponent(h, CellContent::kMeans);
    EXPECT_GT(apparent, h + 0.05);
    EXPECT_NEAR(exponent_from_apparent(apparent, CellContent::kMeans), h, 0.006);  // H = 1 is stepped around
    // Far above the cell their means are as good as samples.
    EXPECT_LT(std::abs(apparent_exponent(h, CellContent::kMeans, 3) - h), apparent - h);
  }
}

TEST(FractalSurface, SharpeningAMeanLeavesLessThanTheMeanItself) {
  for (const double h : {0.3, 0.8, 1.3}) {
    const FractalSurface surface = fractal_surface(h, CellContent::kMeans);
    EXPECT_GT(surface.sample.gain, 0);
    EXPECT_LT(surface.sample.spread, surface.node);
    EXPECT_LT(surface.node, 1);
  }
}

}  // namespace
}  // namespace sightbound
