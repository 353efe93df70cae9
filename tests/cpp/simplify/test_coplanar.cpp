// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "simplify/coplanar.h"

namespace sightbound {
namespace {

constexpr double kUlp = 0x1p-52;

TEST(Coplanar, IsDecidedToTheLastBit) {
  const Point a{0, 0, 1}, b{1, 0, 2}, c{0, 1, 4};
  EXPECT_TRUE(coplanar(a, b, c, {1, 1, 5}));
  EXPECT_FALSE(coplanar(a, b, c, {1, 1, 5 * (1 + kUlp)}));
  EXPECT_FALSE(coplanar(a, b, c, {1, 1, 5 * (1 - kUlp)}));
  EXPECT_TRUE(coplanar(a, b, c, {-3, 0.5, -0.5}));
  // Products of 53 and 53 bits.
  const double slope = 1.0 / 3;
  const auto on_slope = [&](double x, double y) { return Point{x, y, slope * y}; };
  EXPECT_TRUE(coplanar(on_slope(0, 0), on_slope(1025.0 / 1024, 0), on_slope(7, 4), on_slope(-5, 16)));
  EXPECT_FALSE(coplanar(on_slope(0, 0), on_slope(1, 0), on_slope(7, 4), {-5, 16, slope * 16 * (1 + kUlp)}));
}

TEST(Coplanar, KnowsLevelGround) {
  EXPECT_TRUE(coplanar({0, 0, 0.1}, {9, 0, 0.1}, {2, 5, 0.1}, {3, 1.25, 0.1}));
  EXPECT_FALSE(coplanar({0, 0, 0.1}, {9, 0, 0.1}, {2, 5, 0.1}, {3, 1.25, 0.1 * (1 + kUlp)}));
}

}  // namespace
}  // namespace sightbound
