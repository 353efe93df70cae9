// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "terrain/dem.h"

namespace sightbound {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::array<double, 6> kNorthUp{0, 10, 0, 0, 0, -10};
constexpr std::array<double, 6> kSouthUp{0, 10, 0, 0, 0, 10};

ArrayDem dem_of(std::vector<float> values, int rows, int cols, const std::array<double, 6>& g,
                double nodata = std::numeric_limits<double>::quiet_NaN(), double unit = 1) {
  const auto owned = std::make_shared<std::vector<float>>(std::move(values));
  return ArrayDem({.data = owned->data(),
                   .rows = rows,
                   .cols = cols,
                   .nodata = nodata,
                   .metres_per_unit = unit,
                   .owner = owned},
                  Geotransform(g), "");
}

std::vector<float> all(const Grid<float>& grid) { return {grid.values().begin(), grid.values().end()}; }

TEST(ArrayDem, ReadsWindows) {
  const ArrayDem dem = dem_of({0, 1, 2, 3, 4, 5}, 2, 3, kNorthUp);
  Progress progress;
  EXPECT_EQ(all(dem.read(dem.window(), progress)), (std::vector<float>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(all(dem.read({1, 1, 2, 1}, progress)), (std::vector<float>{4, 5}));
}

TEST(ArrayDem, SouthUpIsTurnedAndEverySampleKeepsItsPlace) {
  const ArrayDem dem = dem_of({0, 1, 2, 3, 4, 5}, 3, 2, kSouthUp);
  Progress progress;
  EXPECT_TRUE(dem.flipped());
  EXPECT_EQ(all(dem.read(dem.window(), progress)), (std::vector<float>{4, 5, 2, 3, 0, 1}));
  EXPECT_EQ(all(dem.read({0, 2, 2, 1}, progress)), (std::vector<float>{0, 1}));
  const Xy last = dem.geotransform().of_sample(0, 2), first_of_user = Geotransform(kSouthUp).of_sample(0, 0);
  EXPECT_DOUBLE_EQ(last.x, first_of_user.x);
  EXPECT_DOUBLE_EQ(last.y, first_of_user.y);
}

TEST(ArrayDem, NodataNanAndInfinityAreHoles) {
  const ArrayDem dem = dem_of({-9999, kNan, kInfinity, 3}, 2, 2, kNorthUp, -9999);
  Progress progress;
  const Grid<float> z = dem.read(dem.window(), progress);
  EXPECT_TRUE(std::isnan(z.at(0, 0)) && std::isnan(z.at(0, 1)) && std::isnan(z.at(1, 0)));
  EXPECT_EQ(z.at(1, 1), 3);
}

TEST(ArrayDem, ConvertsToMetresAfterNodata) {
  const ArrayDem dem = dem_of({1000, 999, 0, -10}, 2, 2, kNorthUp, 999, 0.3048);
  Progress progress;
  const Grid<float> z = dem.read(dem.window(), progress);
  EXPECT_FLOAT_EQ(z.at(0, 0), 304.8F);
  EXPECT_TRUE(std::isnan(z.at(0, 1)));
  EXPECT_FLOAT_EQ(z.at(1, 1), -3.048F);
}

TEST(ArrayDem, NeedsTwoByTwo) {
  EXPECT_THROW(dem_of({1, 2, 3}, 1, 3, kNorthUp), InvalidInput);
  EXPECT_THROW(dem_of({1, 2, 3}, 3, 1, kNorthUp), InvalidInput);
}

TEST(ArrayDem, KeepsItsOwnerAlive) {
  auto owned = std::make_shared<std::vector<float>>(4, 1.0F);
  const std::weak_ptr<std::vector<float>> watched = owned;
  {
    const ArrayDem dem(
        {.data = owned->data(), .rows = 2, .cols = 2, .nodata = NAN, .metres_per_unit = 1, .owner = owned},
        Geotransform(kNorthUp), "");
    owned.reset();
    EXPECT_FALSE(watched.expired());
  }
  EXPECT_TRUE(watched.expired());
}

TEST(ArrayDem, CancelsWhileReading) {
  const ArrayDem dem = dem_of(std::vector<float>(4, 1.0F), 2, 2, kNorthUp);
  Progress progress([](double) { return false; });
  EXPECT_THROW(dem.read(dem.window(), progress), Cancelled);
}

}  // namespace
}  // namespace sightbound
