// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "base/error.h"
#include "terrain/geotransform.h"

namespace sightbound {
namespace {

using Coefficients = std::array<double, 6>;

constexpr Coefficients kNorthUp{1000, 10, 0, 2000, 0, -20};
constexpr Coefficients kSouthUp{1000, 10, 0, 2000, 0, 20};
constexpr Coefficients kWestUp{1000, -10, 0, 2000, 0, -20};
constexpr Coefficients kHalfTurn{1000, -10, 0, 2000, 0, 20};
constexpr Coefficients kTurned{1000, 8, 6, 2000, 6, -8};  // mirrored as a north-up one, turned by 37 degrees
constexpr Coefficients kTransposed{1000, 0, 10, 2000, -10, 0};  // columns run south, rows east

TEST(Geotransform, IntegersAreCellCentres) {
  const Geotransform g(kNorthUp);
  EXPECT_DOUBLE_EQ(g.of_sample(0, 0).x, 1005);
  EXPECT_DOUBLE_EQ(g.of_sample(0, 0).y, 1990);
  EXPECT_DOUBLE_EQ(g.of_sample(3, 2).x, 1035);
  EXPECT_DOUBLE_EQ(g.of_sample(3, 2).y, 1950);
}

TEST(Geotransform, ToRasterInverts) {
  for (const Coefficients& c : {kNorthUp, kSouthUp, kWestUp, kHalfTurn, kTurned, kTransposed}) {
    const Geotransform g(c);
    const Xy place = g.of_sample(3.25, -7.5);
    EXPECT_NEAR(g.to_raster(place.x, place.y).x, 3.25, 1e-12);
    EXPECT_NEAR(g.to_raster(place.x, place.y).y, -7.5, 1e-12);
  }
}

TEST(Geotransform, WindowsAndFlipsKeepEverySampleInPlace) {
  constexpr int kRows = 9;
  for (const Coefficients& c : {kNorthUp, kSouthUp, kTurned, kTransposed}) {
    const Geotransform g(c);
    const Xy place = g.of_sample(5, 6);
    const Xy in_window = g.of_window({2, 4, 5, 5}).of_sample(3, 2);
    EXPECT_NEAR(in_window.x, place.x, 1e-9);
    EXPECT_NEAR(in_window.y, place.y, 1e-9);
    const Xy flipped = g.of_flipped(kRows).of_sample(5, kRows - 1 - 6);
    EXPECT_NEAR(flipped.x, place.x, 1e-9);
    EXPECT_NEAR(flipped.y, place.y, 1e-9);
    const Geotransform twice = g.of_flipped(kRows).of_flipped(kRows);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(twice.coefficients()[i], c[i], 1e-9);
  }
}

// Coordinates of 2^-30 m: thousandths of what the CRS's doubles can tell apart.
TEST(Geotransform, SeenFromNearbyNothingIsLost) {
  const Coefficients c{5e8, 0x1p-30, 0, -3e8, 0, -0x1p-29};
  const Geotransform g(c), moved = g.of_window({5, 3, 4, 4}).of_flipped(4);
  EXPECT_EQ(moved.coefficients()[0], 5e8);
  EXPECT_EQ(moved.lost().x, 5 * 0x1p-30);
  const Geotransform there = moved.seen_from({5e8 - 1, -3e8 + 2}, 2);
  EXPECT_EQ(there.of_sample(1, 2).x, 2 * (1 + 6.5 * 0x1p-30));
  EXPECT_EQ(there.of_sample(1, 2).y, 2 * (-2 - 4.5 * 0x1p-29));  // row 3 + (4 - 1 - 2)
}

TEST(Geotransform, TheGroundsNorthWestSouthEastDiagonal) {
  EXPECT_FALSE(Geotransform(kNorthUp).diagonal_is_anti());
  EXPECT_TRUE(Geotransform(kSouthUp).diagonal_is_anti());
  EXPECT_TRUE(Geotransform(kWestUp).diagonal_is_anti());
  EXPECT_FALSE(Geotransform(kHalfTurn).diagonal_is_anti());
  EXPECT_FALSE(Geotransform(kTurned).diagonal_is_anti());
  EXPECT_FALSE(Geotransform(kTransposed).diagonal_is_anti());
}

TEST(Geotransform, FlippingAlwaysMakesTheMainDiagonalTheRightOne) {
  for (int degree = 0; degree < 360; ++degree) {
    const double a = degree * std::numbers::pi / 180, c = 10 * std::cos(a), s = 10 * std::sin(a);
    for (const Coefficients& turned : {Coefficients{0, c, s, 0, s, -c}, Coefficients{0, c, -s, 0, s, c}}) {
      const Geotransform g(turned);
      if (g.diagonal_is_anti()) {
        EXPECT_FALSE(g.of_flipped(5).diagonal_is_anti()) << degree;
      }
    }
  }
}

TEST(Geotransform, ATieLeavesTheFilesOrder) {
  const double s = std::sqrt(0.5);
  EXPECT_FALSE(Geotransform({0, s, s, 0, s, -s}).diagonal_is_anti());
  EXPECT_FALSE(Geotransform({0, s, -s, 0, s, s}).diagonal_is_anti());
}

TEST(Geotransform, RefusesWhatCannotBeInverted) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const Coefficients& bad : {Coefficients{0, 0, 0, 0, 0, -1}, Coefficients{0, 1, 2, 0, 2, 4},
                                  Coefficients{0, kNan, 0, 0, 0, -1}, Coefficients{kNan, 1, 0, 0, 0, -1},
                                  Coefficients{0, 1, 0, std::numeric_limits<double>::infinity(), 0, -1}}) {
    EXPECT_THROW(Geotransform{bad}, InvalidInput);
  }
}

}  // namespace
}  // namespace sightbound
