// SPDX-License-Identifier: GPL-3.0-or-later
// Large files: every layout gives the same values, and a cancelled read ends at once with all its threads.
#include <chrono>
#include <cmath>
#include <thread>

#include <gtest/gtest.h>

#include "base/error.h"
#include "io/raster_dem.h"
#include "support/raster_files.h"
#include "support/scratch.h"

namespace sightbound {
namespace {

using testing::make_raster;
using testing::RasterFileSpec;

constexpr int kRows = 1300, kCols = 1700;

RasterFileSpec large(std::vector<std::string> options) {
  RasterFileSpec spec{.rows = kRows, .cols = kCols, .nodata = -1};
  spec.options = std::move(options);
  spec.values.resize(static_cast<std::size_t>(kRows) * kCols);
  for (std::size_t i = 0; i < spec.values.size(); ++i) {
    spec.values[i] = i % 1000 == 0 ? -1 : static_cast<double>(i % 20011) * 0.25;
  }
  return spec;
}

void expect_same(const Grid<float>& got, const std::vector<double>& values, const Window& window) {
  int wrong = 0;
  for (int r = 0; r < window.rows; ++r) {
    for (int c = 0; c < window.cols; ++c) {
      const double expected =
          values[static_cast<std::size_t>(window.row + r) * kCols + static_cast<std::size_t>(window.col + c)];
      const float z = got.at(r, c);
      wrong += expected == -1 ? !std::isnan(z) : z != static_cast<float>(expected);
    }
  }
  EXPECT_EQ(wrong, 0);
}

class ReadingTest : public testing::Scratch {};

TEST_F(ReadingTest, EveryLayoutGivesTheSameValues) {
  const std::vector<std::vector<std::string>> layouts{
      {},
      {"COMPRESS=DEFLATE", "PREDICTOR=3"},
      {"TILED=YES", "BLOCKXSIZE=256", "BLOCKYSIZE=256", "COMPRESS=DEFLATE", "PREDICTOR=3"},
      {"TILED=YES", "BLOCKXSIZE=512", "BLOCKYSIZE=128"},
      {"BLOCKYSIZE=1300", "COMPRESS=LZW"},
      {"BLOCKYSIZE=7"}};
  for (const auto& layout : layouts) {
    const RasterFileSpec spec = large(layout);
    const auto dem = open_dem(make_raster(spec, path("large.tif")));
    Progress progress;
    for (const Window& window : {dem->window(), Window{200, 300, 700, 800}, Window{1699, 1299, 1, 1}}) {
      expect_same(dem->read(window, progress), spec.values, window);
    }
  }
}

TEST_F(ReadingTest, MosaicsAreReadThroughTheirParts) {
  const RasterFileSpec spec = large({"TILED=YES", "COMPRESS=DEFLATE"});
  make_raster(spec, path("part.tif"));
  const GDALDatasetUniquePtr part(GDALDataset::Open(path("part.tif").c_str()));
  const GDALDatasetUniquePtr mosaic(GetGDALDriverManager()->GetDriverByName("VRT")->CreateCopy(
      path("mosaic.vrt").c_str(), part.get(), FALSE, nullptr, nullptr, nullptr));
  ASSERT_TRUE(mosaic);
  mosaic->FlushCache();
  const auto dem = open_dem(path("mosaic.vrt"));
  Progress progress;
  expect_same(dem->read(dem->window(), progress), spec.values, dem->window());
}

TEST_F(ReadingTest, SeveralJobsReadOneDem) {
  const RasterFileSpec spec = large({"TILED=YES", "COMPRESS=DEFLATE"});
  const auto dem = open_dem(make_raster(spec, path("large.tif")));
  std::vector<std::thread> jobs;
  for (const Window& window : {dem->window(), Window{200, 300, 700, 800}, Window{0, 0, 40, 1300}}) {
    jobs.emplace_back([&, window] {
      Progress progress;
      expect_same(dem->read(window, progress), spec.values, window);
      EXPECT_EQ(dem->notes().size(), 0u);
    });
  }
  for (std::thread& job : jobs) job.join();
}

TEST_F(ReadingTest, AWaitingJobCanBeCancelled) {
  const auto dem = open_dem(make_raster(large({"TILED=YES", "COMPRESS=DEFLATE"}), path("large.tif")));
  Progress first([&](double) {
    std::thread([&] {
      Progress second([](double) { return false; });
      EXPECT_THROW(dem->read(dem->window(), second), Cancelled);
    }).join();
    return true;
  });
  EXPECT_NO_THROW(dem->read(dem->window(), first));
}

TEST_F(ReadingTest, CancelsBetweenChunks) {
  const auto dem = open_dem(make_raster(large({"TILED=YES", "COMPRESS=DEFLATE"}), path("large.tif")));
  const std::thread::id caller = std::this_thread::get_id();
  Progress progress([&](double) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    return false;
  });
  const auto start = std::chrono::steady_clock::now();
  EXPECT_THROW(dem->read(dem->window(), progress), Cancelled);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(200));
  Progress again;
  EXPECT_NO_THROW(dem->read(dem->window(), again));
}

}  // namespace
}  // namespace sightbound
