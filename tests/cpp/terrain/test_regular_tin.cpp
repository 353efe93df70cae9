// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/terrains.h"
#include "terrain/regular_tin.h"
#include "terrain/tin_cleaning.h"
#include "terrain/tin_height_field.h"

namespace sightbound {
namespace {

using testing::dem_of;
using testing::grid_of;
using testing::kNan;

RegularTin made(const DemSource& dem, double unit = 1) {
  Progress progress;
  return regular_tin(dem, unit, MemoryBudget(), progress);
}

TEST(RegularTin, FourSamples) {
  const auto dem = dem_of(grid_of({{1, 2}, {3, 4}}), {500000, 10, 0, 4000000, 0, -10});
  const RegularTin regular = made(*dem);
  const Tin& tin = regular.tin;
  ASSERT_EQ(tin.vertices.size(), 4U);
  EXPECT_EQ(tin.to_crs(tin.vertices[0]), (Xyz{500005, 3999995, 1}));
  EXPECT_EQ(tin.to_crs(tin.vertices[3]), (Xyz{500015, 3999985, 4}));
  EXPECT_TRUE(regular.samples.empty());
  // NW-SE: both faces have corners 0 and 3.
  EXPECT_EQ(tin.faces, (std::vector<Face>{{0, 2, 3}, {0, 3, 1}}));
}

// Whatever the raster's orientation: the diagonal runs NW-SE on the ground and faces look up.
TEST(RegularTin, AnyOrientationOfTheRaster) {
  const std::vector<std::array<double, 6>> orientations{
      {0, 10, 0, 0, 0, -10}, {0, 10, 0, 0, 0, 10},  {0, -10, 0, 0, 0, -10},
      {0, -10, 0, 0, 0, 10}, {0, 9, 2, 0, 2, -9},   {0, 9, 2, 0, -2, 9},
      {0, 0, 10, 0, 10, 0},  {0, 0, 10, 0, -10, 0}, {0, 1, 8, 0, 8, -1}};
  for (const auto& g : orientations) {
    const auto dem =
        dem_of(testing::grid_from(4, 5, [](int r, int c) { return testing::noise(r, c, 3); }), g);
    const Tin tin = made(*dem).tin;
    EXPECT_TRUE(is_height_field(tin));
    EXPECT_TRUE(clean(tin, "The TIN").notes.size() == tin.notes.size());
    std::size_t diagonals = 0;
    for (const Face& f : tin.faces) {
      for (std::size_t i = 0; i < 3; ++i) {
        const Xyz e = tin.vertices[static_cast<std::size_t>(f[(i + 1) % 3])] -
                      tin.vertices[static_cast<std::size_t>(f[i])];
        if (std::hypot(e.x, e.y) < 1.2 * std::hypot(g[1], g[4])) continue;
        EXPECT_LT(e.x * e.y, 0) << g[1] << " " << g[2] << " " << g[4] << " " << g[5];
        ++diagonals;
      }
    }
    EXPECT_EQ(diagonals, tin.faces.size());
  }
}

TEST(RegularTin, NodataTrianglesAndLonelySamplesAreLeftOut) {
  const auto dem = dem_of(grid_of({{1, 2, kNan, 9}, {3, 4, kNan, kNan}, {5, kNan, 7, 8}}));
  const RegularTin regular = made(*dem);
  // Whole: both faces of the first square; of the square below it only corners 3 (1,0), 5 (2,0), 4: NW SW SE
  // needs (2,1): none.
  EXPECT_EQ(regular.tin.faces.size(), 2U);
  EXPECT_EQ(regular.samples, (std::vector<std::int32_t>{0, 1, 4, 5}));
  EXPECT_EQ(regular.tin.vertices[2].z, 3);
  EXPECT_THROW(made(*dem_of(grid_of({{1, 2}, {kNan, kNan}}))), InvalidInput);
}

TEST(RegularTin, OneCornerMissingLeavesOneFace) {
  const RegularTin regular = made(*dem_of(grid_of({{1, 2}, {kNan, 4}})));
  EXPECT_EQ(regular.tin.faces, (std::vector<Face>{{0, 2, 1}}));  // NW, SE, NE
  EXPECT_EQ(regular.samples, (std::vector<std::int32_t>{0, 1, 3}));
}

TEST(RegularTin, FeetAndBudget) {
  const auto dem = dem_of(grid_of({{1, 2}, {3, 4}}));
  const Tin tin = made(*dem, 0.3048).tin;
  EXPECT_NEAR(tin.vertices[1].x - tin.vertices[0].x, 3.048, 1e-12);
  Progress progress;
  EXPECT_THROW(regular_tin(*dem, 1, MemoryBudget(100), progress), OverBudget);
}

}  // namespace
}  // namespace sightbound
