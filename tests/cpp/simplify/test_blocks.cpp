// SPDX-License-Identifier: GPL-3.0-or-later
// A DEM that is worked on block by block: nothing shows where blocks meet.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "simplify/simplify.h"
#include "support/says.h"
#include "support/simplify_promises.h"

namespace sightbound {
namespace {

using namespace testing;

SimplifyOptions in_blocks(double tolerance, int block) {
  SimplifyOptions options = within(tolerance);
  options.block = block;
  options.samples_at_once = 1;  // a row of blocks
  return options;
}

TEST(Blocks, FitWithoutCracks) {
  for (const Scene& scene : scenes()) {
    SCOPED_TRACE(scene.name);
    const DemTerrain terrain = terrain_of(scene.heights);
    for (const int block : {1, 3, 8}) {
      SCOPED_TRACE(block);
      const SimplifyOptions options = in_blocks(2, block);
      expect_kept(terrain, options, simplified(terrain, options));
    }
  }
}

TEST(Blocks, KeepHolesAndIslandsThatLieAcross) {
  for (const Scene& scene : scenes()) {
    SCOPED_TRACE(scene.name);
    const DemTerrain terrain = terrain_of(scene.heights);
    SimplifyOptions options = in_blocks(5, 7), all = within(5);
    all.keep = Grid<std::uint8_t>(scene.heights.rows(), scene.heights.cols(), 1);
    EXPECT_EQ(expect_kept(terrain, options, simplified(terrain, options)).holes,
              expect_kept(terrain, all, simplified(terrain, all)).holes);
  }
}

TEST(Blocks, KeepTheirPromisesOnRandomTerrains) {
  for (std::uint64_t seed = 500; seed < 800; ++seed) {
    SCOPED_TRACE(seed);
    const auto pick = [&](int n, int what) { return static_cast<int>(n * noise(what, 0, seed)); };
    const int rows = 2 + pick(14, 1), cols = 2 + pick(14, 2), step = 1 + pick(3, 3);
    const double holes = pick(3, 4) * 0.08;
    const Grid<float> heights = grid_from(rows, cols, [&](int r, int c) {
      if (noise(r, c, seed + 1) < holes) return static_cast<double>(kNan);
      return std::floor(5 * noise(r / step, c / step, seed + 2)) * (noise(r, c, seed + 3) < 0.02 ? 40 : 1);
    });
    SimplifyOptions options = in_blocks(pick(4, 5) * 0.5, 1 + pick(6, 6));
    if (pick(2, 7) == 1) {
      options.tolerance =
          grid_from(rows, cols, [&](int r, int c) { return std::floor(3 * noise(r, c, seed + 4)); });
    }
    if (pick(2, 8) == 1) {
      options.keep = Grid<std::uint8_t>(rows, cols, 0);
      for (int c = 0; c < cols; ++c) options.keep.at(rows / 2, c) = noise(c, 1, seed + 5) < 0.3 ? 1 : 0;
    }
    options.keep_border = pick(5, 9) == 0;
    if (pick(4, 10) == 0) options.target_faces = 20;
    try {
      expect_kept(terrain_of(heights), options, simplified(terrain_of(heights), options));
    } catch (const InvalidInput& error) {
      EXPECT_TRUE(says(error.what(), "no surface"));
    }
  }
}

TEST(Blocks, OfAnySizeBesideTheRaster) {
  constexpr int kBlock = 8;
  for (const int rows : {2, kBlock, kBlock + 1, kBlock + 2, 2 * kBlock + 2}) {
    for (const int cols : {2, kBlock + 1, kBlock + 2, 2 * kBlock + 1}) {
      SCOPED_TRACE(std::to_string(rows) + " x " + std::to_string(cols));
      const Grid<float> heights = grid_from(rows, cols, [](int r, int c) { return hills(r, c, 0.8, 21); });
      const SimplifyOptions options = in_blocks(4, kBlock);
      expect_kept(terrain_of(heights), options, simplified(terrain_of(heights), options));
    }
  }
}

// Vertices of rims are removed as others are.
TEST(Blocks, LeaveNoTrace) {
  const Grid<float> heights = grid_from(257, 257, [](int r, int c) { return hills(r, c, 0.8, 22); });
  const auto faces = [&](int block) {
    return static_cast<double>(simplified(terrain_of(heights), in_blocks(1, block)).report.faces_after);
  };
  EXPECT_LT(faces(64), 1.02 * faces(256));
  const Grid<float> plane = grid_from(33, 33, [](int r, int c) { return 0.5 * r - c; });
  EXPECT_EQ(simplified(terrain_of(plane), in_blocks(0, 40)).report.faces_after, 2U);
}

TEST(Blocks, KeepWhatStaysOnTheirRims) {
  const Grid<float> heights = grid_from(20, 26, [](int r, int c) { return hills(r, c, 0.8, 23); });
  const DemTerrain terrain = terrain_of(heights);
  SimplifyOptions options = in_blocks(10, 8);
  options.keep_border = true;
  options.keep = Grid<std::uint8_t>(20, 26, 0);
  options.keep.at(8, 16) = options.keep.at(8, 3) = options.keep.at(5, 8) = options.keep.at(16, 24) = 1;
  const SimplifiedTin made = simplified(terrain, options);
  expect_kept(terrain, options, made);
  const auto count_at = [&](int r, int c) {
    const Xy at = terrain.geotransform.of_sample(c, r);
    return std::count(made.tin.vertices.begin(), made.tin.vertices.end(),
                      made.tin.from_crs({at.x, at.y, heights.at(r, c)}));
  };
  for (int r = 0; r < 20; ++r) {
    for (int c = 0; c < 26; ++c) {
      const bool border = r == 0 || c == 0 || r == 19 || c == 25;
      if (!border && options.keep.at(r, c) == 0) continue;
      EXPECT_EQ(count_at(r, c), 1) << r << " " << c;
    }
  }
}

TEST(Blocks, D1SameBytesForAnyThreadsAndMemory) {
  const Grid<float> heights = grid_from(
      150, 130, [](int r, int c) { return noise(r / 9, c / 9, 24) < 0.1 ? kNan : hills(r, c, 0.8, 25); });
  const DemTerrain terrain = terrain_of(heights);
  for (const std::int64_t target : {0, 1500}) {
    SCOPED_TRACE(target);
    SimplifyOptions options = in_blocks(2, 32);
    options.target_faces = target;
    options.threads = 1;
    const SimplifiedTin one = simplified(terrain, options);
    const auto expect_same = [&] {
      const SimplifiedTin other = simplified(terrain, options);
      EXPECT_TRUE(one.tin.vertices == other.tin.vertices);
      EXPECT_TRUE(one.tin.faces == other.tin.faces);
      EXPECT_TRUE(one.tin.face_attributes[0].values == other.tin.face_attributes[0].values);
    };
    options.threads = 2;
    expect_same();
    options.memory_bytes = 64 << 20;
    expect_same();
  }
}

TEST(Blocks, StopAtTheTarget) {
  const Grid<float> heights = grid_from(120, 140, [](int r, int c) { return hills(r, c, 0.8, 26); });
  const DemTerrain terrain = terrain_of(heights);
  for (const int target : {12000, 3000, 1000}) {
    SimplifyOptions options = in_blocks(20, 32);
    options.target_faces = target;
    const SimplifiedTin made = simplified(terrain, options);
    expect_kept(terrain, options, made);
    EXPECT_GE(made.tin.faces.size(), static_cast<std::size_t>(target - 1));
    EXPECT_LE(made.tin.faces.size(), static_cast<std::size_t>(target));
  }
}

TEST(Blocks, AreRefusedWhenWhatIsLeftIsTooMuch) {
  const Grid<float> heights = grid_from(400, 400, [](int r, int c) { return 100 * noise(r, c, 27); });
  SimplifyOptions options = in_blocks(0.01, 32);
  options.memory_bytes = 8 << 20;
  options.threads = 2;
  EXPECT_TRUE(
      says(complaint<OverBudget>([&] { simplified(terrain_of(heights), options); }), "left of the first"));
}

// Large enough to be told of at all: progress is told ten times a second.
TEST(Blocks, ProgressMovesOnTheWayToATarget) {
  const Grid<float> heights = grid_from(800, 800, [](int r, int c) { return hills(r, c, 0.8, 28); });
  SimplifyOptions options = in_blocks(50, 64);
  options.target_faces = 2000;
  std::vector<double> heard;
  Progress progress([&](double done) {
    heard.push_back(done);
    return true;
  });
  simplify_dem(terrain_of(heights), options, progress);
  EXPECT_GT(heard.size(), 2U);
  int calls = 0;
  Progress cancelling([&](double) { return ++calls < 2; });
  EXPECT_THROW(simplify_dem(terrain_of(heights), options, cancelling), Cancelled);
}

}  // namespace
}  // namespace sightbound
