// SPDX-License-Identifier: GPL-3.0-or-later
// Cell sizes against the radii of curvature: a step of d degrees is M d along the meridian, N cos(lat) d
// along the parallel (to (d/2)^2/24 relative, far below 1e-8 for these cells).
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "base/error.h"
#include "earth/georeference.h"

namespace sightbound {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

// A raster in degrees: CRS coordinates are longitude and latitude already.
Georeference degrees(const std::array<double, 6>& g, const Ellipsoid& ellipsoid = {}) {
  return {Geotransform(g), ellipsoid, [](std::span<double>, std::span<double>) {}};
}

struct Radii {
  double meridian, normal;
};
Radii radii(const Ellipsoid& e, double lat) {
  const double e2 = e.flattening * (2 - e.flattening);
  const double w = std::sqrt(1 - e2 * std::pow(std::sin(lat * kDegree), 2));
  return {e.semi_major_m * (1 - e2) / (w * w * w), e.semi_major_m / w};
}

TEST(Georeference, CellSizesInDegrees) {
  constexpr double kStep = 1.0 / 3600;
  for (const double lat : {5.0, 46.5, 60.0, 77.0, -60.0}) {
    const Georeference georeference = degrees({11, kStep, 0, lat + kStep, 0, -2 * kStep});
    const Radii at = radii({}, lat);
    const std::vector<CellSize> sizes = ground_cell_sizes(georeference, {0, 0, 100, 1});
    ASSERT_EQ(sizes.size(), 1U);
    EXPECT_NEAR(sizes[0].col_m, at.normal * std::cos(lat * kDegree) * kStep * kDegree, 1e-5) << lat;
    EXPECT_NEAR(sizes[0].row_m, at.meridian * 2 * kStep * kDegree, 1e-5) << lat;
  }
}

TEST(Georeference, RowsNarrowTowardsThePole) {
  const Georeference georeference = degrees({0, 0.01, 0, 80, 0, -0.01});
  const std::vector<CellSize> sizes = ground_cell_sizes(georeference, {0, 0, 10, 500});
  for (std::size_t r = 1; r < sizes.size(); ++r) EXPECT_GT(sizes[r].col_m, sizes[r - 1].col_m);
}

TEST(Georeference, WindowsStartAtTheirOwnRow) {
  const Georeference georeference = degrees({0, 0.01, 0, 80, 0, -0.01});
  const std::vector<CellSize> whole = ground_cell_sizes(georeference, {0, 0, 20, 50});
  const std::vector<CellSize> part = ground_cell_sizes(georeference, {0, 30, 20, 5});
  const std::vector<CellSize> moved = ground_cell_sizes(georeference.of_window({4, 30, 9, 9}), {0, 0, 20, 5});
  for (std::size_t r = 0; r < part.size(); ++r) {
    EXPECT_DOUBLE_EQ(part[r].col_m, whole[30 + r].col_m);
    EXPECT_NEAR(moved[r].col_m, whole[30 + r].col_m, 1e-6);
    EXPECT_NEAR(moved[r].row_m, whole[30 + r].row_m, 1e-6);
  }
}

TEST(Georeference, RotatedCells) {
  // A turn by 90 degrees swaps the steps.
  constexpr double kStep = 0.001;
  const std::vector<CellSize> sizes = ground_cell_sizes(degrees({11, 0, kStep, 47, kStep, 0}), {0, 0, 1, 1});
  const Radii at = radii({}, 47);
  EXPECT_NEAR(sizes[0].col_m, at.meridian * kStep * kDegree, 1e-2);
  EXPECT_NEAR(sizes[0].row_m, at.normal * std::cos(47 * kDegree) * kStep * kDegree, 1e-2);
}

TEST(Georeference, OtherBodies) {
  const Ellipsoid moon{1737400, 0};
  const std::vector<CellSize> sizes =
      ground_cell_sizes(degrees({0, 0.01, 0, 0.005, 0, -0.01}, moon), {0, 0, 2, 1});
  EXPECT_NEAR(sizes[0].col_m, 1737400 * 0.01 * kDegree, 1e-6);
  EXPECT_NEAR(sizes[0].row_m, 1737400 * 0.01 * kDegree, 1e-6);
}

TEST(Georeference, Plane) {
  const Georeference plane(Geotransform({0, 3, 4, 0, 4, -3}));
  EXPECT_TRUE(plane.is_plane());
  const std::vector<CellSize> sizes = ground_cell_sizes(plane, {5, 5, 7, 3});
  ASSERT_EQ(sizes.size(), 3U);
  EXPECT_DOUBLE_EQ(sizes[2].col_m, 5);
  EXPECT_DOUBLE_EQ(sizes[2].row_m, 5);
  EXPECT_THROW(plane.lon_lat(0, 0), BrokenGuarantee);
}

TEST(Georeference, LargerCellSide) {
  EXPECT_DOUBLE_EQ(larger_cell_side(Georeference(Geotransform({0, 10, 0, 0, 0, -25})), 9, 9), 25);
  // At 60 degrees a degree of longitude is half one of latitude: the middle row counts, not the first.
  const double side = larger_cell_side(degrees({0, 0.01, 0, 60.5, 0, -0.01}), 101, 11);
  EXPECT_NEAR(side, radii({}, 60).meridian * 0.01 * kDegree, 0.01);
}

TEST(Georeference, RowsThatCannotBeReachedTakeTheNearest) {
  // Latitudes beyond 90 do not exist, and on the pole a step of longitude has no length.
  const Georeference georeference = degrees({0, 0.5, 0, 92.25, 0, -0.5});
  const std::vector<CellSize> sizes =
      ground_cell_sizes(georeference, {0, 0, 4, 10});  // latitudes 92 ... 87.5
  for (const CellSize& size : sizes) {
    EXPECT_GT(size.col_m, 0);
    EXPECT_TRUE(std::isfinite(size.row_m));
  }
  EXPECT_EQ(sizes[0].col_m, sizes[5].col_m);  // 89.5 is the northernmost with a whole cell around it
  EXPECT_NE(sizes[6].col_m, sizes[5].col_m);
}

TEST(Georeference, NoRowThatCanBeReachedIsAnError) {
  const Georeference lost(Geotransform({0, 1, 0, 0, 0, -1}), {},
                          [](std::span<double> x, std::span<double> y) {
                            std::fill(x.begin(), x.end(), std::numeric_limits<double>::infinity());
                            std::fill(y.begin(), y.end(), std::numeric_limits<double>::infinity());
                          });
  EXPECT_THROW(ground_cell_sizes(lost, {0, 0, 4, 4}), InvalidInput);
}

TEST(Georeference, LonLatOfRasterCoordinates) {
  const Georeference georeference = degrees({10, 0.5, 0, 50, 0, -0.25});
  const LonLat place = georeference.lon_lat(1, 2);
  EXPECT_DOUBLE_EQ(place.lon, 10.75);
  EXPECT_DOUBLE_EQ(place.lat, 49.375);
}

}  // namespace
}  // namespace sightbound
