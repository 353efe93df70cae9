// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"
#include "jobs/windows.h"
#include "support/says.h"
#include "support/terrains.h"

namespace sightbound {
namespace {

using testing::dem_of;
using testing::says;

// 5 columns of 10 m from x = 1000, 4 rows down from y = 2000.
constexpr std::array<double, 6> kPlace{1000, 10, 0, 2000, 0, -10};
constexpr std::array<double, 6> kPlaceSouthUp{1000, 10, 0, 1960, 0, 10};

std::unique_ptr<DemSource> dem(const std::array<double, 6>& geotransform = kPlace) {
  return dem_of(Grid<float>(4, 5, 1.0f), geotransform);
}

std::string refusal(const Extent& extent) {
  try {
    snap_extent(extent, *dem());
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(SnapExtent, GrowsToWholeCells) {
  EXPECT_EQ(snap_extent({1011, 1975, 1029, 1989}, *dem()), (Window{1, 1, 2, 2}));
  EXPECT_EQ(snap_extent({1014, 1984, 1015, 1985}, *dem()), (Window{1, 1, 1, 1}));
}

TEST(SnapExtent, CellBordersStayWhereTheyAre) {
  EXPECT_EQ(snap_extent({1010, 1970, 1030, 1990}, *dem()), (Window{1, 1, 2, 2}));
  EXPECT_EQ(snap_extent({1009.999, 1969.999, 1030.001, 1990.001}, *dem()), (Window{1, 1, 2, 2}));
}

TEST(SnapExtent, IsClippedToTheDem) {
  EXPECT_EQ(snap_extent({0, 0, 1e9, 1e9}, *dem()), (Window{0, 0, 5, 4}));
  EXPECT_EQ(snap_extent({1035, 1900, 1099, 1975}, *dem()), (Window{3, 2, 2, 2}));
}

TEST(SnapExtent, CountsRowsTheCoresWay) {
  const auto south_up = dem(kPlaceSouthUp);
  ASSERT_TRUE(south_up->flipped());
  EXPECT_EQ(snap_extent({1010, 1970, 1030, 1990}, *south_up), (Window{1, 1, 2, 2}));
  EXPECT_EQ(snap_extent({1000, 1990, 1050, 2000}, *south_up), (Window{0, 0, 5, 1}));
}

TEST(SnapExtent, CoversTheCornersOnARotatedRaster) {
  const double c = 10 * std::sqrt(0.5);
  const auto rotated = dem({0, c, c, 0, c, -c});
  const Window w = snap_extent({20, 0, 25, 5}, *rotated);
  for (const double x : {20.0, 25.0}) {
    for (const double y : {0.0, 5.0}) {
      const Xy at = rotated->geotransform().to_raster(x, y);
      EXPECT_TRUE(at.x + 0.5 >= w.col && at.x + 0.5 <= w.col_end() && at.y + 0.5 >= w.row &&
                  at.y + 0.5 <= w.row_end());
    }
  }
  EXPECT_LT(w.cells(), 20u);
}

TEST(SnapExtent, SaysWhatIsWrong) {
  EXPECT_TRUE(says(refusal({3000, 1970, 3010, 1990}), "outside the DEM (x 1000 to 1050, y 1960 to 2000)"));
  EXPECT_TRUE(says(refusal({1030, 1970, 1010, 1990}), "empty"));
  EXPECT_TRUE(says(refusal({std::nan(""), 1970, 1030, 1990}), "not a number"));
}

TEST(DeliveredGeotransform, IsTheUsersOwnForTheWholeDem) {
  for (const auto& geotransform : {kPlace, kPlaceSouthUp}) {
    const auto source = dem(geotransform);
    EXPECT_EQ(delivered_geotransform(*source, window_of(std::nullopt, *source)).coefficients(), geotransform);
  }
}

TEST(DeliveredGeotransform, OfAWindowPlacesItsOwnCells) {
  const auto source = dem(kPlaceSouthUp);
  const Geotransform g = delivered_geotransform(*source, {1, 0, 2, 1});  // the northernmost row
  EXPECT_DOUBLE_EQ(g.of_sample(0, 0).x, 1015);
  EXPECT_DOUBLE_EQ(g.of_sample(0, 0).y, 1995);
  EXPECT_GT(g.coefficients()[5], 0);
}

}  // namespace
}  // namespace sightbound
