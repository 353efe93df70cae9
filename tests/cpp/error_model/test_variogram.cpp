// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "error_model/variogram.h"
#include "support/terrains.h"

namespace sightbound {
namespace {

using testing::grid_from;
using testing::kNan;
using testing::noise;

std::vector<LagBin> ideal(double nugget, double sill, double length) {
  std::vector<LagBin> bins;
  for (double d = 10; d < 1500; d *= 1.4)
    bins.push_back({d, nugget + sill * (1 - std::exp(-d / length)), 5000});
  return bins;
}

TEST(Variogram, FitFindsNuggetSillAndLength) {
  for (const double length : {15.0, 60.0, 300.0}) {
    const Variogram found = fit_variogram(ideal(0.5, 2, length), 2000);
    EXPECT_NEAR(found.length, length, 0.02 * length);
    EXPECT_NEAR(found.nugget, 0.5, 0.05) << length;
    EXPECT_NEAR(found.sill, 2, 0.05) << length;
    EXPECT_FALSE(found.length_is_largest);
    EXPECT_NEAR(found.at(200), 0.5 + 2 * (1 - std::exp(-200 / length)), 0.03);
  }
}

TEST(Variogram, NuggetAloneIsNoCorrelation) {
  const Variogram found = fit_variogram(ideal(0.7, 0, 10), 2000);
  EXPECT_EQ(found.sill, 0);
  EXPECT_EQ(found.length, 0);
  EXPECT_NEAR(found.nugget, 0.7, 1e-9);
  EXPECT_EQ(found.correlation_length(), 0);
}

TEST(Variogram, WhatFewPlacesShowMayBeChance) {
  EXPECT_EQ(fit_variogram(ideal(1, 0.3, 100), 15).length, 0);
  EXPECT_GT(fit_variogram(ideal(1, 0.3, 100), 3000).length, 0);
}

TEST(Variogram, GrowthWithoutEndIsToldOf) {
  std::vector<LagBin> bins;
  for (double d = 10; d < 1000; d *= 1.5) bins.push_back({d, 0.01 * d, 5000});
  EXPECT_TRUE(fit_variogram(bins, 2000).length_is_largest);
}

TEST(Variogram, FewBinsSayNothing) {
  EXPECT_EQ(fit_variogram({}, 10).length, 0);
  EXPECT_EQ(fit_variogram({{10, 1, 50}, {20, 2, 50}}, 10).length, 0);
}

TEST(Variogram, OneLengthHoldsAsMuchCorrelationAsNuggetAndSill) {
  Variogram variogram;
  variogram.nugget = 3, variogram.sill = 1, variogram.length = 80;
  EXPECT_DOUBLE_EQ(variogram.correlation_length(), 40);
  EXPECT_DOUBLE_EQ(variogram.correlation_length(3), 80);  // the nugget is something else
  EXPECT_DOUBLE_EQ(variogram.correlation_length(99), 80);
}

TEST(GridVariogram, OfAPlaneIsTheSquareOfItsRise) {
  const CellSize cell{10, 20};
  GridVariogram sums;
  sums.add(grid_from(40, 60, [](int r, int c) { return 0.5 * c + 0 * r; }), cell);
  bool along = false, across = false;
  for (const LagBin& bin : sums.bins()) {
    const double cells = bin.distance / 10;
    const double rise = 0.5 * 0.5 * 0.25 * cells * cells / (0.457 + 0.494 / bin.pairs);
    along |= bin.semivariance > 0 && std::abs(bin.semivariance / (2 * rise) - 1) < 1e-4;
    across |= bin.semivariance == 0 && bin.distance == 20;
  }
  EXPECT_TRUE(along);
  EXPECT_TRUE(across);
  EXPECT_EQ(sums.places(), 2400u);
}

TEST(GridVariogram, LeavesHolesOutAndTakesPartsTogether) {
  GridVariogram sums;
  const auto white = [](int r, int c) {
    return c % 7 == 3 ? kNan : std::sqrt(12.0) * (noise(r, c, 3) - 0.5);
  };
  sums.add(grid_from(90, 90, white), {5, 5});
  sums.add(grid_from(90, 90, [&](int r, int c) { return white(r + 90, c); }), {5, 5});
  const Variogram found = fit_variogram(sums.bins(), sums.places());
  EXPECT_EQ(found.length, 0);
  EXPECT_NEAR(found.nugget, 1, 0.15);  // the robust one is that of normal errors; these are uniform
}

TEST(PlacedVariogram, SeesWhatNeighboursShare) {
  std::vector<PlacedError> places;  // squares of 50 m whose places share their error
  for (int i = 0; i < 2500; ++i) {
    const double x = 1000 * noise(i, 0, 1), y = 1000 * noise(i, 0, 2);
    const int c = static_cast<int>(x / 50), r = static_cast<int>(y / 50);
    places.push_back({x, y, noise(r, c, 9) + 0.1 * noise(i, 0, 4)});
  }
  const Variogram found = fit_variogram(variogram_of_places(places, 0), places.size());
  EXPECT_GT(found.length, 10);
  EXPECT_LT(found.length, 50);
  EXPECT_LT(found.nugget, 0.3 * found.sill);
}

TEST(PlacedVariogram, OfOnePlaceIsEmpty) {
  EXPECT_TRUE(variogram_of_places(std::vector<PlacedError>(20, {3, 4, 1}), 0).empty());
}

}  // namespace
}  // namespace sightbound
