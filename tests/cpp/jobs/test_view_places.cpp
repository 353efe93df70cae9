// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "io/tin_crs.h"
#include "jobs/view_places.h"
#include "support/says.h"
#include "volume/dem_surface.h"

namespace sightbound {
namespace {

using testing::says;

// A plane that rises by 1 m in 10 m to the east, 21 x 21 samples of 10 m from (x, y) to the north-east.
std::shared_ptr<const Surface> slope(double x, double y, const std::string& crs_wkt) {
  DemInput input{.heights = Grid<float>(21, 21),
                 .error = {},
                 .geotransform = Geotransform({x - 5, 10, 0, y + 205, 0, -10}),
                 .crs_wkt = crs_wkt};
  for (int r = 0; r < 21; ++r) {
    for (int c = 0; c < 21; ++c) input.heights.at(r, c) = static_cast<float>(c);
  }
  input.error.cell_sizes.assign(21, {10, 10});
  input.error.farthest.assign(21, 7.1);
  input.error.larger_side_m = 10;
  return std::make_shared<DemSurface>(std::move(input));
}

std::string complaint(const std::shared_ptr<const Surface>& surface, const ViewVolume& view,
                      double spacing = 10) {
  try {
    view_places(*surface, {view}, HeightReference::kGround, spacing);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "nothing";
}

TEST(ViewPlaces, APointStandsOnTheGround) {
  const auto surface = slope(1000, 2000, "");
  const ViewPlaces found =
      view_places(*surface, {{{{{1037, 2050}}}, 1.5, 1.5, ""}}, HeightReference::kGround, 10);
  ASSERT_EQ(found.places.size(), 1u);
  EXPECT_NEAR(found.places[0].place.x, 37, 1e-9);
  EXPECT_NEAR(found.places[0].place.y, 50, 1e-9);
  EXPECT_NEAR(found.places[0].place.z, 3.7 + 1.5, 1e-6);
  const ViewPlaces absolute =
      view_places(*surface, {{{{{1037, 2050}}}, 40, 45, "mast"}}, HeightReference::kAbsolute, 2);
  ASSERT_EQ(absolute.places.size(), 4u);  // both ends, at most 2 m apart
  EXPECT_EQ(absolute.places.front().place.z, 40);
  EXPECT_EQ(absolute.places.back().place.z, 45);
  EXPECT_TRUE(says(absolute.as_json[0], R"("name":"mast")"));
}

TEST(ViewPlaces, APolygonHasPlacesInside) {
  const auto surface = slope(1000, 2000, "");
  // A triangle: half of 100 squares of 10 m, less or more on its long side.
  const ViewVolume triangle{{{{1050, 2050}, {1150, 2050}, {1050, 2150}}}, 2, 2, ""};
  const ViewPlaces found = view_places(*surface, {triangle}, HeightReference::kGround, 10);
  EXPECT_GE(found.places.size(), 45u);
  EXPECT_LE(found.places.size(), 55u);
  for (const auto& [place, cell] : found.places) {
    EXPECT_GT(place.x, 50);
    EXPECT_GT(place.y, 50);
    EXPECT_LE(place.x + place.y, 200 + 1e-9);
    EXPECT_NEAR(place.z, place.x / 10 + 2, 1e-5);
  }
  // One that no square's middle lies in.
  const ViewVolume tiny{{{{1051, 2051}, {1052, 2051}, {1051, 2052}}}, 2, 2, ""};
  EXPECT_GE(view_places(*surface, {tiny}, HeightReference::kGround, 10).places.size(), 1u);
}

std::vector<Xy> square(double x, double y, double side) {
  return {{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}};
}

TEST(ViewPlaces, HolesHaveNoPlaces) {
  const auto surface = slope(1000, 2000, "");
  // 100 squares of 10 m, a hole of 36 of them, an island of 4 in it; the hole's ring closed, and turned
  // round.
  ViewVolume area{{square(1050, 2050, 100), square(1070, 2070, 60), square(1090, 2090, 20)}, 2, 2, ""};
  area.rings[1].push_back(area.rings[1].front());
  std::ranges::reverse(area.rings[1]);
  const ViewPlaces found = view_places(*surface, {area}, HeightReference::kGround, 10);
  EXPECT_EQ(found.places.size(), 100u - 36 + 4);
  const auto within = [](const Xyz& place, double from, double to) {
    return place.x > from && place.x < to && place.y > from && place.y < to;
  };
  for (const auto& [place, cell] : found.places)
    EXPECT_TRUE(!within(place, 70, 130) || within(place, 90, 110)) << place.x << ' ' << place.y;
  EXPECT_TRUE(says(found.as_json[0], R"("outline":[[1050.0,2050.0])"));
  EXPECT_TRUE(says(found.as_json[0], R"("further_rings":[[)"));
  // What is left of an area that is nearly all hole still has its place.
  const ViewVolume rim{{square(1050, 2050, 100), square(1050.5, 2050.5, 99)}, 2, 2, ""};
  for (const auto& [place, cell] : view_places(*surface, {rim}, HeightReference::kGround, 40).places)
    EXPECT_FALSE(within(place, 50.5, 149.5));
  EXPECT_TRUE(
      says(complaint(surface, {{square(1050, 2050, 10), square(1050, 2050, 10)}, 1, 1, ""}), "without area"));
  EXPECT_TRUE(
      says(complaint(surface, {{square(1050, 2050, 10), {{1055, 2055}}}, 1, 1, ""}), "too few corners"));
}

// Wherever somebody may be in the area, a cell holds the place.
TEST(ViewPlaces, CellsCoverTheArea) {
  const auto surface = slope(1000, 2000, "");
  const ViewVolume triangle{{{{1052, 2057}, {1147, 2061}, {1071, 2143}}}, 2, 5, ""};
  for (const double spacing : {4.0, 10.0, 30.0, 70.0}) {
    const ViewPlaces found = view_places(*surface, {triangle}, HeightReference::kGround, spacing);
    for (int n = 0; n < 4000; ++n) {
      // Even over the triangle.
      double u = std::fmod(n * 0.7548776662, 1.0), v = std::fmod(n * 0.5698402910, 1.0);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const double x = 52 + u * 95 + v * 19, y = 57 + u * 4 + v * 86, z = x / 10 + 2 + n % 4;
      EXPECT_TRUE(std::ranges::any_of(found.places,
                                      [&](const ViewPlace& view) {
                                        const auto& [low, high] = view.cell;
                                        return x >= low.x && x <= high.x && y >= low.y && y <= high.y &&
                                               z >= low.z - 1e-4 && z <= high.z + 1e-4;
                                      }))
          << spacing << ": " << x << ' ' << y << ' ' << z;
    }
    for (const auto& [place, cell] : found.places) EXPECT_LE(cell.high.x - cell.low.x, 3 * spacing);
  }
  // Squares beside the area are left alone.
  for (const auto& [place, cell] :
       view_places(*surface, {{{square(1050, 2050, 20)}, 2, 2, ""}}, HeightReference::kGround, 10).places) {
    EXPECT_EQ(cell.high.x - cell.low.x, 10);
    EXPECT_NEAR(cell.high.z - cell.low.z, 1, 1e-5);  // as the ground rises
  }
}

TEST(ViewPlaces, SpacingIsAnEighthOfTheAreaWhereNoneIsGiven) {
  const auto surface = slope(1000, 2000, "");
  const ViewVolume area{{square(1020, 2020, 160)}, 2, 2, ""};
  EXPECT_EQ(view_places(*surface, {area}, HeightReference::kGround, 0, 10).places.size(), 64u);
  EXPECT_EQ(view_places(*surface, {area}, HeightReference::kGround, 0, 40).places.size(), 16u);
}

TEST(ViewPlaces, SeveralPartsHavePlacesInEach) {
  const auto surface = slope(1000, 2000, "");
  const ViewVolume parts{{square(1050, 2050, 30), square(1120, 2050, 20)}, 2, 2, ""};
  EXPECT_EQ(view_places(*surface, {parts}, HeightReference::kGround, 10).places.size(), 9u + 4);
}

TEST(ViewPlaces, PartsOffTheTerrainAreToldOf) {
  const auto surface = slope(1000, 2000, "");
  const ViewVolume half{{{{1150, 2050}, {1250, 2050}, {1250, 2150}, {1150, 2150}}}, 2, 2, ""};
  const ViewPlaces found = view_places(*surface, {half}, HeightReference::kGround, 10);
  EXPECT_EQ(found.places.size(), 50u);
  ASSERT_EQ(found.warnings.size(), 1u);
  EXPECT_TRUE(says(found.warnings[0], "50 of 100 places are not on the terrain"));
}

TEST(ViewPlaces, WrongViewsAreNamed) {
  const auto surface = slope(1000, 2000, "");
  EXPECT_TRUE(says(complaint(surface, {{}, 1, 1, ""}), "View 1 has no outline"));
  EXPECT_TRUE(says(complaint(surface, {{{{900, 2050}}}, 1, 1, "hut"}), "View 'hut' (900, 2050) is not on"));
  EXPECT_TRUE(says(complaint(surface, {{{{1050, 2050}}}, 3, 1, ""}), "begins at 3 m and ends at 1 m"));
  EXPECT_TRUE(says(complaint(surface, {{{{1050, 2050}}}, std::nan(""), 1, ""}), "height is nan"));
  EXPECT_TRUE(says(complaint(surface, {{{{1050, 2050}, {1060, 2050}}}, 1, 1, ""}), "two corners"));
  EXPECT_TRUE(
      says(complaint(surface, {{{{1050, 2050}, {1060, 2050}, {1070, 2050}}}, 1, 1, ""}), "without area"));
  EXPECT_TRUE(says(complaint(surface, {{{{1050, 2050}}}, 1, 1, ""}, -1), "view_spacing is -1"));
}

TEST(GroundBend, IsTheEllipsoids) {
  // 15 E, 45 N in UTM 33: scale 0.9996, radii 6367.4 km (north) and 6388.8 km (east).
  const GroundBend bend = ground_bend(*slope(499900, 4982850, crs_from_text("EPSG:32633")), 0);
  EXPECT_NEAR(bend.drop(1000, 0), 1e6 / (0.9996 * 0.9996) / (2 * 6388838), 1e-6);
  EXPECT_NEAR(bend.drop(0, 1000), 1e6 / (0.9996 * 0.9996) / (2 * 6367382), 1e-6);
  EXPECT_NEAR(ground_bend(*slope(499900, 4982850, crs_from_text("EPSG:32633")), 0.13).drop(1000, 0),
              0.87 * bend.drop(1000, 0), 1e-9);
  // Without a CRS a sphere.
  EXPECT_NEAR(ground_bend(*slope(0, 0, ""), 0).drop(600, 800), 1e6 / (2 * 6371008.8), 1e-9);
}

}  // namespace
}  // namespace sightbound
