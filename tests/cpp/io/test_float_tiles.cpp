// SPDX-License-Identifier: GPL-3.0-or-later
// Blocks read past libtiff hold the same bits as GDAL's, in every layout; what is not such a block is left to
// GDAL.
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "base/error.h"
#include "io/float_tiles.h"
#include "io/raster_dem.h"
#include "support/raster_files.h"
#include "support/scratch.h"

namespace sightbound {
namespace {

using testing::make_raster;
using testing::RasterFileSpec;

class FloatTilesTest : public testing::Scratch {
 protected:
  // Heights of every size, and what no height is.
  static RasterFileSpec spec(std::vector<std::string> options) {
    RasterFileSpec spec{.rows = 61, .cols = 75};
    spec.options = std::move(options);
    spec.options.push_back("COMPRESS=DEFLATE");
    spec.options.push_back("PREDICTOR=3");
    std::mt19937 random(1);
    std::uniform_real_distribution<double> size(-6, 6), sign(-1, 1);
    for (int i = 0; i < spec.rows * spec.cols; ++i)
      spec.values.push_back(std::copysign(std::pow(10, size(random)), sign(random)));
    spec.values[7] = std::numeric_limits<double>::quiet_NaN();
    spec.values[8] = -std::numeric_limits<double>::infinity();
    return spec;
  }

  // How many blocks were read; all of them with the bits that GDAL reads.
  static int blocks_read(const std::string& file, int number = 1) {
    const GDALDatasetUniquePtr dataset(GDALDataset::Open(file.c_str()));
    GDALRasterBand* band = dataset->GetRasterBand(number);
    const auto tiles = FloatTiles::of(band, file);
    if (!tiles) return 0;
    int cols = 0, rows = 0, read = 0;
    band->GetBlockSize(&cols, &rows);
    std::vector<float> ours(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows)), gdals(ours);
    for (int y = 0; y * rows < band->GetYSize(); ++y) {
      for (int x = 0; x * cols < band->GetXSize(); ++x) {
        if (tiles->read(x, y, ours.data()) != FloatTiles::Found::kValues) continue;
        EXPECT_EQ(band->ReadBlock(x, y, gdals.data()), CE_None);
        EXPECT_EQ(std::memcmp(ours.data(), gdals.data(), ours.size() * sizeof(float)), 0) << x << ' ' << y;
        ++read;
      }
    }
    return read;
  }
};

TEST_F(FloatTilesTest, SameBitsAsGdals) {
  const std::vector<std::string> tiles{"TILED=YES", "BLOCKXSIZE=32", "BLOCKYSIZE=16"};
  EXPECT_EQ(blocks_read(make_raster(spec(tiles), path("tiles.tif"))), 12);
  auto big_endian = tiles;
  big_endian.push_back("ENDIANNESS=BIG");
  EXPECT_EQ(blocks_read(make_raster(spec(big_endian), path("big.tif"))), 12);
  auto big_file = tiles;
  big_file.push_back("BIGTIFF=YES");
  EXPECT_EQ(blocks_read(make_raster(spec(big_file), path("bigtiff.tif"))), 12);
  // The last of the strips is cut short.
  EXPECT_EQ(blocks_read(make_raster(spec({"BLOCKYSIZE=10"}), path("strips.tif"))), 6);
  RasterFileSpec bands = spec({"INTERLEAVE=BAND"});
  bands.bands = 2;
  EXPECT_GT(blocks_read(make_raster(bands, path("bands.tif")), 2), 0);
}

TEST_F(FloatTilesTest, OtherLayoutsAreGdals) {
  RasterFileSpec pixels = spec({"INTERLEAVE=PIXEL"});
  pixels.bands = 2;
  EXPECT_EQ(blocks_read(make_raster(pixels, path("pixels.tif"))), 0);
  RasterFileSpec doubles = spec({});
  doubles.type = GDT_Float64;
  EXPECT_EQ(blocks_read(make_raster(doubles, path("doubles.tif"))), 0);
  RasterFileSpec plain = spec({});
  plain.options = {"COMPRESS=DEFLATE"};
  EXPECT_EQ(blocks_read(make_raster(plain, path("plain.tif"))), 0);
  EXPECT_EQ(blocks_read("GTIFF_DIR:1:" + make_raster(spec({}), path("page.tif"))), 0);
}

TEST_F(FloatTilesTest, BlocksThatAreNotThereAreGdals) {
  RasterFileSpec sparse = spec({"TILED=YES", "BLOCKXSIZE=32", "BLOCKYSIZE=32", "SPARSE_OK=TRUE"});
  for (int row = 0; row < sparse.rows; ++row) {
    for (int col = 0; col < 32; ++col) sparse.values[static_cast<std::size_t>(row * sparse.cols + col)] = 0;
  }
  EXPECT_EQ(blocks_read(make_raster(sparse, path("sparse.tif"))), 4);
}

TEST_F(FloatTilesTest, DamageIsFoundAndToldByGdal) {
  const std::string file =
      make_raster(spec({"TILED=YES", "BLOCKXSIZE=32", "BLOCKYSIZE=32"}), path("cut.tif"));
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 300);
  EXPECT_LT(blocks_read(file), 6);
  const auto dem = open_dem(file);
  Progress progress;
  EXPECT_THROW(dem->read(dem->window(), progress), IoError);
}

// A few bytes wrong in the middle: GDAL hands over heights that were never measured.
TEST_F(FloatTilesTest, DamageWithinABlockIsFound) {
  const std::string file =
      make_raster(spec({"TILED=YES", "BLOCKXSIZE=64", "BLOCKYSIZE=64"}), path("hit.tif"));
  const auto size = std::filesystem::file_size(file);
  {
    std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(static_cast<std::streamoff>(size / 2));
    bytes.write("\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 16);
  }
  const auto dem = open_dem(file);
  Progress progress;
  EXPECT_THROW(dem->read(dem->window(), progress), IoError);
}

}  // namespace
}  // namespace sightbound
