// SPDX-License-Identifier: GPL-3.0-or-later
// Formats that DEMs come in, beside GeoTIFF.
#include <cmath>
#include <cstdint>
#include <vector>

#include <cpl_vsi.h>
#include <gtest/gtest.h>

#include "io/crs.h"
#include "io/raster_dem.h"
#include "support/raster_files.h"
#include "support/says.h"
#include "support/scratch.h"

namespace sightbound {
namespace {

using testing::copy_raster;
using testing::make_raster;
using testing::RasterFileSpec;
using testing::says;

class FormatTest : public testing::Scratch {
 protected:
  // Reads the whole file; the DEM stays open in dem_.
  Grid<float> read(const std::string& file) {
    dem_ = open_dem(file);
    Progress progress;
    return dem_->read(dem_->window(), progress);
  }
  std::unique_ptr<DemSource> dem_;
};

TEST_F(FormatTest, AsciiGrid) {
  const Grid<float> z = read(write_text("dem.asc",
                                        "ncols 3\nnrows 2\nxllcorner 600000\nyllcorner 5000000\ncellsize 25\n"
                                        "NODATA_value -9999\n1.5 2 -9999\n4 5 6\n"));
  EXPECT_EQ(z.at(0, 0), 1.5F);
  EXPECT_TRUE(std::isnan(z.at(0, 2)));
  EXPECT_EQ(z.at(1, 2), 6);
  EXPECT_DOUBLE_EQ(dem_->geotransform().of_sample(0, 0).y, 5000037.5);
  EXPECT_TRUE(says(dem_->notes().at(0), "no CRS"));
}

TEST_F(FormatTest, BandInterleavedByLine) {
  const Grid<float> z = read(make_raster({.type = GDT_Int16, .nodata = 5.0}, path("dem.bil"), "EHdr"));
  EXPECT_EQ(z.at(2, 3), 11);
  EXPECT_TRUE(std::isnan(z.at(1, 1)));
}

// Written byte by byte: 1201 x 1201 big-endian, north-west corner first.
TEST_F(FormatTest, SrtmTileInAZip) {
  constexpr int kSide = 1201;
  std::vector<std::uint8_t> bytes;
  for (int i = 0; i < kSide * kSide; ++i) {
    const auto z = static_cast<std::uint16_t>(i == 0 ? 0x8000 : i % 3000);
    bytes.push_back(static_cast<std::uint8_t>(z >> 8));
    bytes.push_back(static_cast<std::uint8_t>(z & 255));
  }
  const std::string zip = path("N46E011.hgt.zip");
  {
    void* container = VSIFOpenL(("/vsizip/" + zip).c_str(), "wb");
    ASSERT_NE(container, nullptr);
    VSILFILE* file = VSIFOpenL(("/vsizip/" + zip + "/N46E011.hgt").c_str(), "wb");
    ASSERT_NE(file, nullptr);
    VSIFWriteL(bytes.data(), 1, bytes.size(), file);
    VSIFCloseL(file);
    VSIFCloseL(static_cast<VSILFILE*>(container));
  }
  for (const std::string& name : {zip, "/vsizip/" + zip + "/N46E011.hgt"}) {
    const Grid<float> z = read(name);
    EXPECT_EQ(z.rows(), kSide);
    EXPECT_TRUE(std::isnan(z.at(0, 0)));
    EXPECT_EQ(z.at(1, 0), 1201);
    EXPECT_NEAR(dem_->geotransform().of_sample(0, 0).x, 11, 1e-9);
    EXPECT_NEAR(dem_->geotransform().of_sample(0, 0).y, 47, 1e-9);
    EXPECT_FALSE(georeference_of(*dem_).is_plane());
  }
}

TEST_F(FormatTest, Dted) {
  RasterFileSpec spec{.rows = 121, .cols = 121, .type = GDT_Int16, .crs = "EPSG:4326", .nodata = -32767};
  const double step = 1.0 / 120;
  spec.geotransform = {{11 - step / 2, step, 0, 47 + step / 2, 0, -step}};
  for (int i = 0; i < 121 * 121; ++i) spec.values.push_back(i == 7 ? -32767 : i % 1000);
  const Grid<float> z = read(copy_raster(spec, path("n46.dt0"), "DTED"));
  EXPECT_TRUE(std::isnan(z.at(0, 7)));
  EXPECT_EQ(z.at(1, 5), 126);
}

TEST_F(FormatTest, UsgsDem) {
  RasterFileSpec spec{.rows = 1201, .cols = 1201, .type = GDT_Int16, .crs = "EPSG:4326", .nodata = -32767};
  const double step = 1.0 / 1200;
  spec.geotransform = {{-85 - step / 2, step, 0, 37 + step / 2, 0, -step}};
  for (int i = 0; i < 1201 * 1201; ++i) spec.values.push_back(i % 1000);
  const Grid<float> z = read(copy_raster(spec, path("usgs.dem"), "USGSDEM"));
  EXPECT_EQ(z.rows(), 1201);
  EXPECT_EQ(z.at(0, 7), 7);
}

TEST_F(FormatTest, VirtualFiles) {
  const Grid<float> z = read(make_raster({}, "/vsimem/sightbound-test.tif"));
  EXPECT_EQ(z.at(2, 3), 11);
  dem_.reset();
  VSIUnlink("/vsimem/sightbound-test.tif");
}

TEST_F(FormatTest, SubdatasetPaths) {
  make_raster({}, path("inner.tif"));
  const Grid<float> z = read("GTIFF_DIR:1:" + path("inner.tif"));
  EXPECT_EQ(z.at(2, 3), 11);
}

}  // namespace
}  // namespace sightbound
