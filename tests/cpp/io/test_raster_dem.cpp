// SPDX-License-Identifier: GPL-3.0-or-later
// Traps met in real DEM files, each with a file that has it.
#include <array>
#include <cfloat>
#include <cmath>
#include <filesystem>
#include <limits>

#include <gtest/gtest.h>

#include "base/error.h"
#include "io/raster_dem.h"
#include "support/raster_files.h"
#include "support/says.h"
#include "support/scratch.h"

namespace sightbound {
namespace {

using testing::make_dataset;
using testing::make_raster;
using testing::RasterFileSpec;
using testing::says;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class RasterDemTest : public testing::Scratch {
 protected:
  Grid<float> heights(const std::string& file, VerticalUnit unit = VerticalUnit::kAuto) {
    const auto dem = open_dem(file, 1, unit);
    Progress progress;
    Grid<float> read = dem->read(dem->window(), progress);
    notes_.clear();
    for (const std::string& note : dem->notes()) notes_ += note + "\n";
    return read;
  }
  Grid<float> heights_of(const RasterFileSpec& spec) { return heights(make_raster(spec, path("dem.tif"))); }

  std::string refusal(const RasterFileSpec& spec) {
    try {
      open_dem(make_raster(spec, path("dem.tif")));
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  }

  std::string notes_;
};

void expect_values(const Grid<float>& grid, const std::vector<double>& expected) {
  ASSERT_EQ(grid.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (std::isnan(expected[i])) {
      EXPECT_TRUE(std::isnan(grid.data()[i])) << "cell " << i << " is " << grid.data()[i];
    } else {
      EXPECT_FLOAT_EQ(grid.data()[i], static_cast<float>(expected[i])) << "cell " << i;
    }
  }
}

constexpr double kHole = std::numeric_limits<double>::quiet_NaN();

TEST_F(RasterDemTest, ReadsAPlainGeoTiff) {
  const std::string file = make_raster({}, path("dem.tif"));
  const auto dem = open_dem(file);
  EXPECT_EQ(dem->rows(), 3);
  EXPECT_EQ(dem->cols(), 4);
  EXPECT_FALSE(dem->flipped());
  EXPECT_DOUBLE_EQ(dem->geotransform().of_sample(0, 0).x, 500005);
  EXPECT_DOUBLE_EQ(dem->geotransform().of_sample(0, 0).y, 4999995);
  EXPECT_TRUE(says(dem->crs_wkt(), "PROJCRS[\"WGS 84 / UTM zone 32N\""));
  EXPECT_TRUE(dem->notes().empty());
  expect_values(heights(file), {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11});
}

TEST_F(RasterDemTest, ReadsWindows) {
  const auto dem = open_dem(make_raster({}, path("dem.tif")));
  Progress progress;
  expect_values(dem->read({1, 1, 2, 2}, progress), {5, 6, 9, 10});
  expect_values(dem->read({3, 0, 1, 3}, progress), {3, 7, 11});
  EXPECT_THROW(dem->read({3, 0, 2, 3}, progress), BrokenGuarantee);
}

TEST_F(RasterDemTest, ReadsTheBandAskedFor) {
  const std::string file = make_raster({.bands = 3}, path("dem.tif"));
  Progress progress;
  EXPECT_EQ(open_dem(file, 3)->read({0, 0, 1, 1}, progress).at(0, 0), 2000);
  for (const int band : {0, -1, 4}) {
    try {
      open_dem(file, band);
      FAIL() << "band " << band;
    } catch (const InvalidInput& error) {
      EXPECT_TRUE(says(error.what(), "bands 1 to 3"));
    }
  }
}

TEST_F(RasterDemTest, HonoursPositiveNodata) {
  expect_values(heights_of({.values = {999, 1, 2, 3, 4, 5, 6, 7, 8, 9, 999, 998}, .nodata = 999}),
                {kHole, 1, 2, 3, 4, 5, 6, 7, 8, 9, kHole, 998});
}

TEST_F(RasterDemTest, HonoursNodataThatFloatRounds) {
  // -9999.9 in double is no Float32; what is stored is its neighbour.
  expect_values(heights_of({.rows = 2, .cols = 2, .values = {-9999.9, 1, 2, 0.1}, .nodata = -9999.9}),
                {kHole, 1, 2, 0.1});
  EXPECT_EQ(notes_, "");
}

TEST_F(RasterDemTest, HonoursNodataAtTheEndsOfTheFloatRange) {
  for (const double declared :
       {-3.4e38, 3.4e38, -3.4028234663852886e38, 3.4028235e38, -1.7976931348623157e308}) {
    for (const double stored : {-3.4e38, -3.40282306073709652508e38, 3.4e38, -double{FLT_MAX}}) {
      expect_values(heights_of({.rows = 2, .cols = 2, .values = {stored, 1, 2, 3}, .nodata = declared}),
                    {kHole, 1, 2, 3});
      EXPECT_EQ(notes_, "");
    }
  }
}

TEST_F(RasterDemTest, HonoursHugeNodataOfDoubles) {
  expect_values(heights_of({.rows = 2,
                            .cols = 2,
                            .values = {-1.7976931348623157e308, 1e9, -kInfinity, 3},
                            .type = GDT_Float64,
                            .nodata = -1.7976931348623157e308}),
                {kHole, kHole, kHole, 3});
  EXPECT_TRUE(says(notes_, "At least 1 samples lie beyond 30000 m"));
}

TEST_F(RasterDemTest, NodataThatTheTypeCannotHoldMeansNone) {
  expect_values(
      heights_of({.rows = 2, .cols = 2, .values = {0, 1, 241, 255}, .type = GDT_Byte, .nodata = -9999}),
      {0, 1, 241, 255});
  expect_values(
      heights_of({.rows = 2, .cols = 2, .values = {0, -1, 2, 3}, .type = GDT_Int16, .nodata = -3.4e38}),
      {0, -1, 2, 3});
  EXPECT_EQ(notes_, "");
}

TEST_F(RasterDemTest, NanAndInfinityAreHoles) {
  expect_values(heights_of({.rows = 2, .cols = 2, .values = {kHole, kInfinity, -kInfinity, 3}}),
                {kHole, kHole, kHole, 3});
  expect_values(heights_of({.rows = 2, .cols = 2, .values = {kHole, 1, -9999, 3}, .nodata = -9999}),
                {kHole, 1, kHole, 3});
  expect_values(heights_of({.rows = 2, .cols = 2, .values = {kHole, 1, 2, 3}, .nodata = kHole}),
                {kHole, 1, 2, 3});
  EXPECT_EQ(notes_, "");
}

TEST_F(RasterDemTest, SpikesBesideDeclaredNodataAreHolesAndSaid) {
  expect_values(heights_of({.values = {1e9, 1, 2, 3, -9999, 5, 6, -1e9, 8, 9, 10, 31000}, .nodata = -9999}),
                {kHole, 1, 2, 3, kHole, 5, 6, kHole, 8, 9, 10, kHole});
  EXPECT_TRUE(says(notes_, "At least 3 samples lie beyond 30000 m and were taken as holes"));
}

TEST_F(RasterDemTest, VoidsWithoutDeclaredNodata) {
  // -32768 is no height anywhere; -9999 could be the deep sea: kept, and said.
  expect_values(heights_of({.rows = 2, .cols = 2, .values = {-32768, 1, -9999, 3}, .type = GDT_Int16}),
                {kHole, 1, -9999, 3});
  EXPECT_TRUE(says(notes_, "At least 1 samples lie beyond"));
  EXPECT_TRUE(says(notes_, "At least 1 samples are exactly -9999"));
}

TEST_F(RasterDemTest, SeaCodedZeroIsAHeight) {
  expect_values(heights_of({.rows = 2, .cols = 2, .values = {0, 0, 2, 3}}), {0, 0, 2, 3});
}

TEST_F(RasterDemTest, HonoursMaskBands) {
  expect_values(heights_of({.rows = 2, .cols = 2, .values = {1e9, 1, 2, 3}, .mask = {0, 255, 0, 1}}),
                {kHole, 1, kHole, 3});
  EXPECT_EQ(notes_, "");  // what the mask hides is no spike
}

TEST_F(RasterDemTest, HonoursAlpha) {
  {
    const auto dataset = make_dataset(
        {.rows = 2, .cols = 2, .type = GDT_Byte, .bands = 2, .options = {"ALPHA=YES"}}, path("alpha.tif"));
    std::array<std::uint8_t, 4> alpha{0, 255, 1, 0};
    ASSERT_EQ(dataset->GetRasterBand(2)->RasterIO(GF_Write, 0, 0, 2, 2, alpha.data(), 2, 2, GDT_Byte, 0, 0,
                                                  nullptr),
              CE_None);
  }
  expect_values(heights(path("alpha.tif")), {kHole, 1, 2, kHole});
}

TEST_F(RasterDemTest, AppliesScaleAndOffsetAfterNodata) {
  expect_values(heights_of({.rows = 2,
                            .cols = 2,
                            .values = {0, 100, 200, 65535},
                            .type = GDT_UInt16,
                            .nodata = 65535,
                            .scale = 0.1,
                            .offset = -500}),
                {-500, -490, -480, kHole});
}

TEST_F(RasterDemTest, RefusesAScaleOfZero) {
  EXPECT_TRUE(says(refusal({.scale = 0.0, .offset = 1.0}), "scale"));
}

TEST_F(RasterDemTest, ReadsEveryRealType) {
  for (const GDALDataType type : {GDT_Byte, GDT_UInt16, GDT_Int16, GDT_UInt32, GDT_Int32, GDT_Float32,
                                  GDT_Float64, GDT_Int64, GDT_UInt64}) {
    expect_values(heights_of({.rows = 2, .cols = 2, .values = {0, 1, 2, 99}, .type = type}), {0, 1, 2, 99});
  }
}

TEST_F(RasterDemTest, HonoursNodataOf64BitIntegers) {
  {
    const auto dataset =
        make_dataset({.rows = 2, .cols = 2, .values = {7, 1, 2, 3}, .type = GDT_Int64}, path("i.tif"));
    dataset->GetRasterBand(1)->SetNoDataValueAsInt64(7);
  }
  expect_values(heights(path("i.tif")), {kHole, 1, 2, 3});
}

TEST_F(RasterDemTest, RefusesComplexNumbers) {
  EXPECT_TRUE(says(refusal({.type = GDT_CFloat32}), "complex"));
}

TEST_F(RasterDemTest, SouthUpRastersAreTurned) {
  const auto dem =
      open_dem(make_raster({.geotransform = {{500000, 10, 0, 5000000, 0, 10}}}, path("dem.tif")));
  EXPECT_TRUE(dem->flipped());
  EXPECT_DOUBLE_EQ(dem->geotransform().of_sample(0, 0).y, 5000025);
  Progress progress;
  expect_values(dem->read(dem->window(), progress), {8, 9, 10, 11, 4, 5, 6, 7, 0, 1, 2, 3});
  expect_values(dem->read({1, 0, 2, 1}, progress), {9, 10});
  expect_values(dem->read({1, 1, 2, 2}, progress), {5, 6, 1, 2});
}

TEST_F(RasterDemTest, ReadsRotatedRasters) {
  const std::array<double, 6> rotated{500000, 8, 6, 5000000, 6, -8};
  const auto dem = open_dem(make_raster({.geotransform = rotated}, path("dem.tif")));
  EXPECT_EQ(dem->geotransform().coefficients(), rotated);
}

TEST_F(RasterDemTest, RefusesWhatHasNoPlace) {
  EXPECT_TRUE(says(refusal({.geotransform = {}}), "no georeference"));
  EXPECT_TRUE(says(refusal({.geotransform = {{0, 1, 0, 0, 0, 1}}}), "no georeference"));
  EXPECT_TRUE(says(refusal({.geotransform = {{5, 1, 2, 5, 2, 4}}}), "not invertible"));
}

TEST_F(RasterDemTest, RefusesControlPointsAlone) {
  {
    const auto dataset = make_dataset({.geotransform = {}, .crs = ""}, path("gcp.tif"));
    std::array<GDAL_GCP, 4> points{};
    GDALInitGCPs(4, points.data());
    for (std::size_t i = 0; i < 4; ++i) {
      points[i].dfGCPPixel = i % 2 ? 4 : 0;
      points[i].dfGCPLine = i / 2 ? 3 : 0;
      points[i].dfGCPX = 10 + points[i].dfGCPPixel * 1.5 + points[i].dfGCPLine * points[i].dfGCPPixel;
      points[i].dfGCPY = 50 - points[i].dfGCPLine;
    }
    OGRSpatialReference crs;
    crs.SetFromUserInput("EPSG:4326");
    ASSERT_EQ(dataset->SetGCPs(4, points.data(), &crs), CE_None);
    GDALDeinitGCPs(4, points.data());
  }
  try {
    open_dem(path("gcp.tif"));
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_TRUE(says(error.what(), "control points only"));
  }
}

TEST_F(RasterDemTest, RefusesSingleRowsAndColumns) {
  EXPECT_TRUE(says(refusal({.rows = 1, .cols = 5}), "2 x 2"));
  EXPECT_TRUE(says(refusal({.rows = 5, .cols = 1}), "2 x 2"));
}

TEST_F(RasterDemTest, WithoutCrs) {
  heights_of({.crs = ""});
  EXPECT_TRUE(says(notes_, "no CRS"));
  EXPECT_TRUE(
      says(refusal({.geotransform = {{11, 0.001, 0, 47, 0, -0.001}}, .crs = ""}), "look like degrees"));
}

TEST_F(RasterDemTest, FilesThatCannotBeOpened) {
  EXPECT_THROW(open_dem(""), InvalidInput);
  for (const std::string& bad : {path("missing.tif"), path(""), write_text("notes.txt", "not a raster"),
                                 write_text("empty.tif", "")}) {
    try {
      open_dem(bad);
      FAIL() << bad;
    } catch (const IoError& error) {
      EXPECT_TRUE(says(error.what(), bad));
    }
  }
}

TEST_F(RasterDemTest, TruncatedFilesAreSaid) {
  for (const char* compression : {"NONE", "DEFLATE"}) {
    const std::string file = make_raster(
        {.rows = 600, .cols = 600, .options = {"TILED=YES", std::string("COMPRESS=") + compression}},
        path("cut.tif"));
    std::filesystem::resize_file(file, std::filesystem::file_size(file) * 2 / 3);
    ::testing::internal::CaptureStderr();
    try {
      heights(file);
      FAIL() << compression;
    } catch (const IoError& error) {
      EXPECT_TRUE(says(error.what(), "damaged or incomplete"));
      EXPECT_TRUE(says(error.what(), "cut.tif"));
    }
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  }
}

TEST_F(RasterDemTest, NamesTheSubdatasetsOfAContainer) {
  const std::string file = path("two.gpkg");
  RasterFileSpec byte{.rows = 300, .cols = 300, .type = GDT_Byte, .crs = "EPSG:3857"};
  byte.values.assign(90000, 7);
  testing::copy_raster(byte, file, "GPKG", {"RASTER_TABLE=a", "TILE_FORMAT=PNG"});
  testing::copy_raster(byte, file, "GPKG", {"RASTER_TABLE=b", "APPEND_SUBDATASET=YES", "TILE_FORMAT=PNG"});
  try {
    open_dem(file);
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_TRUE(says(error.what(), "GPKG:"));
  }
}

}  // namespace
}  // namespace sightbound
