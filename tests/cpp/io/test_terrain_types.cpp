// SPDX-License-Identifier: GPL-3.0-or-later
// Delta from polygons. Layers are GeoJSON texts on a 6 x 6 DEM of 10 m cells.
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "io/error_rasters.h"
#include "io/raster_dem.h"
#include "support/raster_files.h"
#include "support/says.h"
#include "support/scratch.h"

namespace sightbound {
namespace {

using testing::make_raster;
using testing::says;

// A square of the DEM's cells [col, col_end) x [row, row_end), as a GeoJSON feature in EPSG:32632.
std::string feature(int col, int row, int col_end, int row_end, const std::string& properties) {
  const auto corner = [](int c, int r) {
    std::string text = "[";
    return text.append(std::to_string(500000 + 10 * c))
        .append(",")
        .append(std::to_string(5000000 - 10 * r))
        .append("]");
  };
  return R"({"type":"Feature","properties":{)" + properties +
         R"(},"geometry":{"type":"Polygon","coordinates":[[)" + corner(col, row) + "," +
         corner(col_end, row) + "," + corner(col_end, row_end) + "," + corner(col, row_end) + "," +
         corner(col, row) + "]]}}";
}

std::string collection(const std::string& features, const std::string& crs = "EPSG:32632") {
  return R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":")" + crs +
         R"("}},"features":[)" + features + "]}";
}

class TerrainTypesTest : public testing::Scratch {
 protected:
  Grid<float> variation(const std::string& geojson, const std::string& field,
                        const std::map<std::string, double>& table = {}) {
    const auto dem = open_dem(make_raster({.rows = 6, .cols = 6, .geotransform = place_}, path("dem.tif")));
    Progress progress;
    return terrain_type_variation({write_text("types.geojson", geojson), "", field, table}, *dem, window_,
                                  progress);
  }

  std::string refusal(const std::string& geojson, const std::string& field,
                      const std::map<std::string, double>& table = {}) {
    try {
      variation(geojson, field, table);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  }

  std::array<double, 6> place_{500000, 10, 0, 5000000, 0, -10};
  Window window_{0, 0, 6, 6};
};

TEST_F(TerrainTypesTest, MetresUnderTheSampleAndNothingOutside) {
  const Grid<float> got = variation(collection(feature(1, 2, 4, 5, R"("delta":2.5)")), "delta");
  for (int r = 0; r < 6; ++r) {
    for (int c = 0; c < 6; ++c) {
      const bool inside = c >= 1 && c < 4 && r >= 2 && r < 5;
      if (inside) {
        EXPECT_EQ(got.at(r, c), 2.5F);
      } else {
        EXPECT_TRUE(std::isnan(got.at(r, c)));
      }
    }
  }
}

TEST_F(TerrainTypesTest, TheLargestWinsWhateverTheOrder) {
  const std::string small = feature(0, 0, 6, 6, R"("delta":1)"), large = feature(2, 2, 3, 3, R"("delta":4)");
  for (const std::string& both : {small + "," + large, large + "," + small}) {
    const Grid<float> got = variation(collection(both), "delta");
    EXPECT_EQ(got.at(2, 2), 4);
    EXPECT_EQ(got.at(3, 3), 1);
  }
}

TEST_F(TerrainTypesTest, WindowsAndTurnedRastersKeepTheGround) {
  const std::string types = collection(feature(1, 2, 4, 5, R"("delta":2.5)"));
  window_ = {1, 2, 2, 2};
  EXPECT_EQ(variation(types, "delta").at(0, 0), 2.5F);
  window_ = {0, 0, 6, 6};
  place_ = {500000, 10, 0, 4999940, 0, 10};
  const Grid<float> turned = variation(types, "delta");
  EXPECT_EQ(turned.at(2, 1), 2.5F);
  EXPECT_TRUE(std::isnan(turned.at(1, 1)));
}

TEST_F(TerrainTypesTest, ClassesOfTheDefaultTable) {
  const std::map<std::string, double>& table = default_terrain_table();
  ASSERT_FALSE(table.empty());
  const auto& [name, metres] = *table.begin();
  const Grid<float> got = variation(collection(feature(0, 0, 6, 6, R"("cover":")" + name + "\"")), "cover");
  EXPECT_FLOAT_EQ(got.at(3, 3), static_cast<float>(metres));
}

TEST_F(TerrainTypesTest, ClassesOfAGivenTableAndWholeNumbersAsCodes) {
  EXPECT_EQ(
      variation(collection(feature(0, 0, 6, 6, R"("cover":"moor")")), "cover", {{"moor", 1.5}}).at(0, 0),
      1.5F);
  EXPECT_EQ(variation(collection(feature(0, 0, 6, 6, R"("code":321)")), "code", {{"321", 0.5}}).at(0, 0),
            0.5F);
  EXPECT_EQ(variation(collection(feature(0, 0, 6, 6, R"("delta":3)")), "delta").at(0, 0), 3);
}

TEST_F(TerrainTypesTest, UnknownClassesAreListedWithTheKnown) {
  const std::string types =
      collection(feature(0, 0, 3, 3, R"("cover":"moor")") + "," + feature(3, 0, 6, 3, R"("cover":"heath")") +
                 "," + feature(0, 3, 6, 6, R"("cover":"rock")"));
  const std::string message = refusal(types, "cover", {{"rock", 4}, {"sand", 0.2}});
  EXPECT_TRUE(says(message, "'heath', 'moor'"));
  EXPECT_TRUE(says(message, "Known are 'rock', 'sand'"));
}

// Wide enough for several strips of rows; a slanted band crosses them all.
TEST_F(TerrainTypesTest, LargeWindowsAreBurntInStrips) {
  constexpr int kRows = 400, kCols = 12000;
  const auto dem = open_dem(make_raster(
      {.rows = kRows, .cols = kCols, .values = std::vector<double>(kRows * kCols, 1), .type = GDT_Byte},
      path("wide.tif")));
  const std::string band =
      R"({"type":"Feature","properties":{"delta":2},"geometry":{"type":"Polygon","coordinates":[[)"
      R"([500000,5000000],[500100,5000000],[504100,4996000],[504000,4996000],[500000,5000000]]]}})";
  const std::string file =
      write_text("band.geojson", collection(band + "," + feature(5, 150, 6, 350, R"("delta":3)")));
  Progress progress;
  const Grid<float> got = terrain_type_variation({file, "", "delta", {}}, *dem, dem->window(), progress);
  int wrong = 0;
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < 500; ++c) {
      const bool in_post = c == 5 && r >= 150 && r<350, in_band = c> r && c < r + 10;  // c = r is on the edge
      if (c == r || c == r + 10) continue;
      wrong += in_post ? got.at(r, c) != 3 : in_band ? got.at(r, c) != 2 : !std::isnan(got.at(r, c));
    }
  }
  EXPECT_EQ(wrong, 0);
}

TEST_F(TerrainTypesTest, AnotherCrs) {
  // Degrees on the central meridian, 9 E: the box covers the DEM's western half (30 m are 0.00038 degrees).
  const std::string box =
      R"({"type":"Feature","properties":{"delta":2},"geometry":{"type":"Polygon","coordinates":[[[8.99,45.1],)"
      R"([9.00038146,45.1],[9.00038146,45.2],[8.99,45.2],[8.99,45.1]]]}})";
  const Grid<float> got = variation(collection(box, "urn:ogc:def:crs:OGC:1.3:CRS84"), "delta");
  EXPECT_EQ(got.at(3, 2), 2);
  EXPECT_TRUE(std::isnan(got.at(3, 3)));
}

TEST_F(TerrainTypesTest, HolesAreOutside) {
  const std::string ring =
      R"({"type":"Feature","properties":{"delta":2},"geometry":{"type":"MultiPolygon","coordinates":[[[)"
      R"([500000,5000000],[500060,5000000],[500060,4999940],[500000,4999940],[500000,5000000]],)"
      R"([[500020,4999980],[500040,4999980],[500040,4999960],[500020,4999960],[500020,4999980]]]]}})";
  const Grid<float> got = variation(collection(ring), "delta");
  EXPECT_EQ(got.at(1, 1), 2);
  EXPECT_TRUE(std::isnan(got.at(2, 2)));
}

TEST_F(TerrainTypesTest, Refusals) {
  const std::string good = feature(0, 0, 6, 6, R"("delta":1)");
  EXPECT_TRUE(says(refusal(collection(""), "delta"), "is empty"));
  EXPECT_TRUE(says(refusal(collection(good), "relief"), "no field 'relief'; the layer has 'delta'"));
  EXPECT_TRUE(
      says(refusal(collection(good + "," + feature(0, 0, 1, 1, R"("delta":null)")), "delta"), "is NULL"));
  EXPECT_TRUE(says(refusal(collection(feature(0, 0, 6, 6, R"("delta":-1.5)")), "delta"), "0 or more metres"));
  EXPECT_TRUE(
      says(refusal(collection(feature(90, 90, 96, 96, R"("delta":1)")), "delta"), "no polygon lies in"));
  const std::string point =
      R"({"type":"Feature","properties":{"delta":2},"geometry":{"type":"Point","coordinates":[500030,4999970]}})";
  EXPECT_TRUE(says(refusal(collection(point), "delta"), "is no polygon"));
}

TEST_F(TerrainTypesTest, LayersAndFilesThatAreMissing) {
  const auto dem = open_dem(make_raster({.rows = 6, .cols = 6}, path("dem.tif")));
  Progress progress;
  const std::string file = write_text("types.geojson", collection(feature(0, 0, 6, 6, R"("delta":1)")));
  try {
    terrain_type_variation({file, "soils", "delta", {}}, *dem, dem->window(), progress);
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_TRUE(says(error.what(), "no layer 'soils'"));
  }
  EXPECT_THROW(terrain_type_variation({path("no.gpkg"), "", "delta", {}}, *dem, dem->window(), progress),
               IoError);
}

}  // namespace
}  // namespace sightbound
