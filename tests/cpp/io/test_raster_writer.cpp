// SPDX-License-Identifier: GPL-3.0-or-later
// What is written can be read back, and a file appears only when whole.
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <thread>
#include <vector>

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "base/error.h"
#include "io/raster_writer.h"
#include "support/says.h"
#include "support/scratch.h"
#include "support/terrains.h"

namespace sightbound {
namespace {

using testing::kNan;
using testing::says;

const Geotransform kPlace({500000, 10, 0, 5000000, 0, -10});

class RasterWriterTest : public testing::Scratch {
 protected:
  template <class T>
  void write(const std::string& file, const Grid<T>& grid, const RasterMetadata& metadata = {},
             const std::string& crs = "EPSG:25832", const Geotransform& place = kPlace) {
    Progress progress;
    write_raster(file, grid, place, crs, metadata, 0, progress);
  }

  template <class T>
  std::vector<T> read(const std::string& file, GDALDataType type) {
    dataset_.reset(GDALDataset::Open(file.c_str()));
    EXPECT_TRUE(dataset_);
    const int cols = dataset_->GetRasterXSize(), rows = dataset_->GetRasterYSize();
    std::vector<T> values(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows));
    EXPECT_EQ(dataset_->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, cols, rows, values.data(), cols, rows, type,
                                                   0, 0, nullptr),
              CE_None);
    return values;
  }
  GDALDatasetUniquePtr dataset_;
};

// Incompressible, so that a limit on the file's size is met.
Grid<float> noise(int side) {
  return testing::grid_from(side, side, [](int r, int c) { return testing::noise(r, c, 1); });
}

std::string content(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST_F(RasterWriterTest, FloatsComeBackWithTheirMetadata) {
  Grid<float> grid(300, 500);
  for (int r = 0; r < 300; ++r) {
    for (int c = 0; c < 500; ++c)
      grid.at(r, c) = (r + c) % 7 == 0 ? kNan : 0.001F * static_cast<float>(r * c);
  }
  write(path("p.tif"), grid, {"confidence", "m", {{"SIGHTBOUND_CONFIDENCE", "0.95"}}, {}});
  const std::vector<float> values = read<float>(path("p.tif"), GDT_Float32);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float expected = grid.data()[i];
    ASSERT_TRUE(values[i] == expected || (std::isnan(values[i]) && std::isnan(expected))) << i;
  }
  GDALRasterBand* band = dataset_->GetRasterBand(1);
  int has_nodata = 0;
  EXPECT_TRUE(std::isnan(band->GetNoDataValue(&has_nodata)) && has_nodata);
  EXPECT_STREQ(band->GetDescription(), "confidence");
  EXPECT_STREQ(band->GetUnitType(), "m");
  EXPECT_STREQ(dataset_->GetMetadataItem("SIGHTBOUND_CONFIDENCE"), "0.95");
  EXPECT_STREQ(dataset_->GetSpatialRef()->GetAuthorityCode(nullptr), "25832");
  std::array<double, 6> g{};
  dataset_->GetGeoTransform(g.data());
  EXPECT_EQ(g, kPlace.coefficients());
  EXPECT_EQ(files(), std::vector<std::string>{"p.tif"});
}

TEST_F(RasterWriterTest, BytesAndCounts) {
  Grid<std::uint8_t> verdict(2, 3, 2);
  verdict.at(1, 1) = 255;
  write(path("v.tif"), verdict);
  EXPECT_EQ(read<std::uint8_t>(path("v.tif"), GDT_Byte), (std::vector<std::uint8_t>{2, 2, 2, 2, 255, 2}));
  EXPECT_EQ(dataset_->GetRasterBand(1)->GetNoDataValue(nullptr), 255);

  Grid<std::uint32_t> count(2, 2, 3000000000U);
  count.at(0, 0) = 4294967295U;
  write(path("c.tif"), count);
  EXPECT_EQ(read<std::uint32_t>(path("c.tif"), GDT_UInt32).at(3), 3000000000U);
  EXPECT_EQ(dataset_->GetRasterBand(1)->GetNoDataValue(nullptr), 4294967295.0);
}

TEST_F(RasterWriterTest, AnyOrientation) {
  for (const std::array<double, 6>& g : {std::array<double, 6>{0, 10, 0, 100, 0, 10}, {7, 8, 6, 9, 6, -8}}) {
    write(path("g.tif"), Grid<float>(3, 4, 1.0F), {}, "EPSG:25832", Geotransform(g));
    read<float>(path("g.tif"), GDT_Float32);
    std::array<double, 6> back{};
    dataset_->GetGeoTransform(back.data());
    EXPECT_EQ(back, g);
  }
}

TEST_F(RasterWriterTest, WritesTheHorizontalPartOfTheCrs) {
  write(path("p.tif"), Grid<float>(2, 2, 1.0F), {}, "EPSG:2263+6360");
  read<float>(path("p.tif"), GDT_Float32);
  EXPECT_FALSE(dataset_->GetSpatialRef()->IsCompound());
  EXPECT_STREQ(dataset_->GetRasterBand(1)->GetUnitType(), "");  // a probability has no feet
  write(path("n.tif"), Grid<float>(2, 2, 1.0F), {}, "");
  read<float>(path("n.tif"), GDT_Float32);
  EXPECT_EQ(dataset_->GetSpatialRef(), nullptr);
}

TEST_F(RasterWriterTest, CreationOptionsWinOverOurs) {
  write(path("o.tif"), noise(600), {"", "", {}, {"COMPRESS=LZW", "TILED=NO"}});
  read<float>(path("o.tif"), GDT_Float32);
  EXPECT_STREQ(dataset_->GetMetadataItem("COMPRESSION", "IMAGE_STRUCTURE"), "LZW");
  int block_cols = 0, block_rows = 0;
  dataset_->GetRasterBand(1)->GetBlockSize(&block_cols, &block_rows);
  EXPECT_EQ(block_cols, 600);
  write(path("u.tif"), noise(60), {"", "", {}, {"COMPRESS=NONE"}});
  EXPECT_EQ(read<float>(path("u.tif"), GDT_Float32).at(0), noise(60).at(0, 0));
  EXPECT_THROW(write(path("x.tif"), noise(60), {"", "", {}, {"TILED"}}), InvalidInput);
}

TEST_F(RasterWriterTest, EveryBytePerThreadNumber) {
  const Grid<float> grid = noise(700);
  for (const int threads : {1, 2, 5}) {
    Progress progress;
    write_raster(path(std::to_string(threads) + ".tif"), grid, kPlace, "", {}, threads, progress);
  }
  EXPECT_EQ(content(path("1.tif")), content(path("2.tif")));
  EXPECT_EQ(content(path("1.tif")), content(path("5.tif")));
}

TEST_F(RasterWriterTest, ReplacesAndDropsWhatDescribedTheOldFile) {
  write_text("p.tif", "old");
  write_text("p.tif.aux.xml", "<PAMDataset/>");
  write_text("p.tif.ovr", "old overviews");
  write(path("p.tif"), Grid<float>(2, 2, 1.0F));
  EXPECT_EQ(files(), std::vector<std::string>{"p.tif"});
  EXPECT_EQ(read<float>(path("p.tif"), GDT_Float32).at(0), 1);
}

TEST_F(RasterWriterTest, SideFilesOfAProfileGoAlong) {
  write(path("p.tif"), Grid<float>(2, 2, 1.0F),
        {"confidence", "", {{"SIGHTBOUND_X", "y"}}, {"PROFILE=BASELINE"}});
  EXPECT_EQ(files(), (std::vector<std::string>{"p.tif", "p.tif.aux.xml"}));
  read<float>(path("p.tif"), GDT_Float32);
  EXPECT_STREQ(dataset_->GetMetadataItem("SIGHTBOUND_X"), "y");
}

TEST_F(RasterWriterTest, CancellingLeavesNothingAndKeepsTheOldFile) {
  write_text("p.tif", "old");
  Progress progress([](double) { return false; });
  EXPECT_THROW(write_raster(path("p.tif"), noise(600), kPlace, "", {}, 0, progress), Cancelled);
  EXPECT_EQ(files(), std::vector<std::string>{"p.tif"});
  EXPECT_EQ(content(path("p.tif")), "old");
}

TEST_F(RasterWriterTest, ProgressCountsCells) {
  double last = 0;
  Progress progress([&](double fraction) {
    last = fraction;
    return true;
  });
  progress.begin(0.5, 600 * 600);
  write_raster(path("p.tif"), noise(600), kPlace, "", {}, 0, progress);
  std::this_thread::sleep_for(std::chrono::milliseconds(110));
  progress.check();
  EXPECT_DOUBLE_EQ(last, 0.5);
}

// A full disk, played by a limit on the size of files; every compression notices it at a different moment.
TEST_F(RasterWriterTest, AFullDiskIsAnErrorThatLeavesNothing) {
  for (const char* compression : {"ZSTD", "DEFLATE", "NONE"}) {
    for (const rlim_t limit : {rlim_t{4096}, rlim_t{200000}, rlim_t{1400000}}) {
      write_text("p.tif", "old");
      rlimit before{};
      getrlimit(RLIMIT_FSIZE, &before);
      const rlimit tight{limit, before.rlim_max};
      const auto handler = std::signal(SIGXFSZ, SIG_IGN);
      setrlimit(RLIMIT_FSIZE, &tight);
      std::string message;
      try {
        write(path("p.tif"), noise(600), {"", "", {}, {std::string("COMPRESS=") + compression}});
      } catch (const IoError& error) {
        message = error.what();
      }
      setrlimit(RLIMIT_FSIZE, &before);
      std::signal(SIGXFSZ, handler);
      const bool fits = limit == 1400000 && std::string(compression) != "NONE";
      EXPECT_TRUE(fits || says(message, "p.tif")) << compression << " " << limit;
      EXPECT_EQ(files(), std::vector<std::string>{"p.tif"});
      EXPECT_EQ(content(path("p.tif")) == "old", !message.empty());
    }
  }
}

TEST_F(RasterWriterTest, NothingIsPrinted) {
  ::testing::internal::CaptureStderr();
  EXPECT_THROW(write(path("missing/p.tif"), noise(10)), IoError);
  EXPECT_THROW(write("/proc/p.tif", noise(10)), IoError);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST_F(RasterWriterTest, BadPathsAreNamed) {
  const auto refusal = [&](const std::string& file) -> std::string {
    try {
      write(file, Grid<float>(2, 2, 1.0F));
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_TRUE(says(refusal(""), "path is empty"));
  EXPECT_TRUE(says(refusal(path("missing/p.tif")), "does not exist"));
  EXPECT_TRUE(says(refusal(path("p.img")), "use .tif"));
  std::filesystem::create_directory(path("folder.tif"));
  EXPECT_TRUE(says(refusal(path("folder.tif")), "it is a folder"));
}

TEST_F(RasterWriterTest, UnusualNames) {
  for (const char* name : {"p", "p.TIF", "a b.tif", "gr\xC3\xBC\xC3\x9F.tiff", ".hidden.tif"}) {
    write(path(name), Grid<float>(2, 2, 3.0F));
    EXPECT_EQ(read<float>(path(name), GDT_Float32).at(0), 3) << name;
  }
  write("/vsimem/sightbound-writer.tif", Grid<float>(2, 2, 3.0F));
  EXPECT_EQ(read<float>("/vsimem/sightbound-writer.tif", GDT_Float32).at(0), 3);
  dataset_.reset();
  VSIUnlink("/vsimem/sightbound-writer.tif");
}

TEST_F(RasterWriterTest, SeveralAppearTogetherOrNotAtAll) {
  const Grid<float> p(2, 2, 1.0F);
  const Grid<std::uint8_t> verdict(2, 2, 2);
  Progress progress;
  write_rasters({{path("p.tif"), &p, {}}, {path("v.tif"), &verdict, {}}}, kPlace, "", 0, progress);
  EXPECT_EQ(files(), (std::vector<std::string>{"p.tif", "v.tif"}));

  Progress again;
  EXPECT_THROW(
      write_rasters({{path("a.tif"), &p, {}}, {path("missing/b.tif"), &verdict, {}}}, kPlace, "", 0, again),
      IoError);
  EXPECT_THROW(write_rasters({{path("a.tif"), &p, {}}, {path("a.tif"), &verdict, {}}}, kPlace, "", 0, again),
               InvalidInput);
  EXPECT_EQ(files(), (std::vector<std::string>{"p.tif", "v.tif"}));
}

}  // namespace
}  // namespace sightbound
