// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "error_model/horizontal_shift.h"
#include "support/terrains.h"

namespace sightbound {
namespace {

using testing::noise;

double ground(double x, double y) { return 30 * std::sin(x / 70) + 20 * std::cos(y / 90 + x / 200); }
double slope_x(double x, double y) { return (ground(x + 0.1, y) - ground(x - 0.1, y)) / 0.2; }
double slope_y(double x, double y) { return (ground(x, y + 0.1) - ground(x, y - 0.1)) / 0.2; }

// A DEM that lies `true_shift` beside the ground and `up` above it, with independent errors.
auto comparison(Xy true_shift, double up, double error, double blunders = 0) {
  return [=](Xy shift) {
    std::vector<ShiftPlace> places;
    for (int i = 0; i < 4000; ++i) {
      const double x = 2000 * noise(i, 1, 1), y = 2000 * noise(i, 1, 2);
      const double at_x = x + shift.x - true_shift.x, at_y = y + shift.y - true_shift.y;
      const double e =
          error * std::sqrt(12.0) * (noise(i, 1, 3) - 0.5) + (noise(i, 1, 4) < 0.03 ? blunders : 0);
      places.push_back({ground(at_x, at_y) + up + e - ground(x, y), slope_x(x, y), slope_y(x, y), i % 64});
    }
    return places;
  };
}

TEST(HorizontalShift, IsFoundExactlyWithoutErrors) {
  const auto found = find_shift(comparison({12, -7}, 1.5, 0), 20, 400);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->x, 12, 0.01);
  EXPECT_NEAR(found->y, -7, 0.01);
  EXPECT_NEAR(found->z, 1.5, 0.01);
  EXPECT_LT(found->nmad_after, 0.01);
  EXPECT_GT(found->nmad_before, 1);
  EXPECT_TRUE(found->is_significant());
}

TEST(HorizontalShift, ErrsByItsStandardError) {
  const auto found = find_shift(comparison({5, 3}, -2, 2), 20, 400);
  ASSERT_TRUE(found);
  EXPECT_LT(std::abs(found->x - 5), 3 * found->se_x);
  EXPECT_LT(std::abs(found->y - 3), 3 * found->se_y);
  EXPECT_LT(std::abs(found->z + 2), 3 * found->se_z);
  // sigma / sqrt(n) over the rms slope.
  EXPECT_NEAR(found->se_z, 2 / std::sqrt(4000.0), 0.01);
  EXPECT_GT(found->se_x, 2 / std::sqrt(4000.0) / 0.5);
  EXPECT_LT(found->se_x, 2 / std::sqrt(4000.0) / 0.15);
}

TEST(HorizontalShift, IsNotMovedByBlunders) {
  const auto found = find_shift(comparison({5, 3}, 0, 1, 60), 20, 400);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->x, 5, 0.5);
  EXPECT_NEAR(found->y, 3, 0.5);
  EXPECT_NEAR(found->z, 0, 0.2);
}

TEST(HorizontalShift, OfNothingIsNotSignificant) {
  const auto found = find_shift(comparison({0, 0}, 4, 2), 20, 400);
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->is_significant());
}

TEST(HorizontalShift, CannotBeToldOnFlatOrOneSidedGroundOrFarAway) {
  const auto plane = [](double per_x) {
    return [=](Xy) {
      std::vector<ShiftPlace> places;
      for (int i = 0; i < 100; ++i) places.push_back({noise(i, 0, 0), per_x, 0, i});
      return places;
    };
  };
  EXPECT_FALSE(find_shift(plane(0), 10, 100));
  EXPECT_FALSE(find_shift(plane(0.3), 10, 100));
  EXPECT_FALSE(find_shift(comparison({12, -7}, 0, 0), 20, 5));
  EXPECT_FALSE(find_shift([](Xy) { return std::vector<ShiftPlace>(9); }, 10, 100));
}

}  // namespace
}  // namespace sightbound
