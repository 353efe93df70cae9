// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "simplify/simplify.h"
#include "support/says.h"
#include "support/simplify_promises.h"

namespace sightbound {
namespace {

using namespace testing;

TEST(Simplify, S1EveryPlaceIsWithinTheTolerance) {
  for (const Scene& scene : scenes()) {
    SCOPED_TRACE(scene.name);
    const DemTerrain terrain = terrain_of(scene.heights);
    for (const double tolerance : {0.05, 0.5, 2.0, 10.0, 1000.0}) {
      SCOPED_TRACE(tolerance);
      const SimplifyOptions options = within(tolerance);
      expect_kept(terrain, options, simplified(terrain, options));
    }
  }
}

TEST(Simplify, S1WithAToleranceThatVaries) {
  for (const Scene& scene : scenes()) {
    SCOPED_TRACE(scene.name);
    const DemTerrain terrain = terrain_of(scene.heights);
    SimplifyOptions options;
    options.tolerance = grid_from(scene.heights.rows(), scene.heights.cols(), [](int r, int c) {
      const double e = 8 * noise(r / 3, c / 3, 11);
      return e < 1 ? 0 : e;
    });
    expect_kept(terrain, options, simplified(terrain, options));
  }
}

TEST(Simplify, S2HolesAndIslandsStay) {
  for (const Scene& scene : scenes()) {
    SCOPED_TRACE(scene.name);
    const DemTerrain terrain = terrain_of(scene.heights);
    SimplifyOptions options = within(5), all = within(5);
    all.keep = Grid<std::uint8_t>(scene.heights.rows(), scene.heights.cols(), 1);
    const SimplifiedTin made = simplified(terrain, options), full = simplified(terrain, all);
    EXPECT_EQ(full.report.faces_after, full.report.faces_before);
    EXPECT_EQ(expect_kept(terrain, options, made).holes, expect_kept(terrain, all, full).holes);
  }
}

// Whole numbers and plateaus, so that much is collinear, coplanar or just at the tolerance; holes everywhere.
TEST(Simplify, KeepsItsPromisesOnRandomTerrains) {
  for (std::uint64_t seed = 100; seed < 400; ++seed) {
    SCOPED_TRACE(seed);
    const auto pick = [&](int n, int what) { return static_cast<int>(n * noise(what, 0, seed)); };
    const int rows = 2 + pick(14, 1), cols = 2 + pick(14, 2), step = 1 + pick(3, 3),
              steepness = 1 + pick(6, 4);
    const double holes = pick(3, 5) * 0.06;
    const Grid<float> heights = grid_from(rows, cols, [&](int r, int c) {
      if (noise(r, c, seed + 1) < holes) return static_cast<double>(kNan);
      return std::floor(steepness * noise(r / step, c / step, seed + 2)) *
             (noise(r, c, seed + 3) < 0.02 ? 40 : 1);
    });
    SimplifyOptions options = within(pick(4, 6) * 0.5);
    if (pick(2, 7) == 1) {
      options.tolerance =
          grid_from(rows, cols, [&](int r, int c) { return std::floor(3 * noise(r, c, seed + 4)); });
    }
    if (pick(2, 8) == 1) {
      options.keep = Grid<std::uint8_t>(rows, cols, 0);
      for (int c = 0; c < cols; ++c) options.keep.at(rows / 2, c) = noise(c, 1, seed + 5) < 0.3 ? 1 : 0;
    }
    options.keep_border = pick(5, 9) == 0;
    try {
      expect_kept(terrain_of(heights), options, simplified(terrain_of(heights), options));
    } catch (const InvalidInput& error) {
      EXPECT_TRUE(says(error.what(), "no surface"));
    }
  }
}

TEST(Simplify, S4NoToleranceRemovesOnlyWhatIsCoplanar) {
  for (const Scene& scene : scenes()) {
    SCOPED_TRACE(scene.name);
    const DemTerrain terrain = terrain_of(scene.heights);
    const SimplifiedTin made = simplified(terrain, within(0));
    const OverlayReport seen = overlay_report(
        terrain.heights, terrain.geotransform, [](int, int) { return 0; }, made.tin);
    EXPECT_LE(seen.deviation, kNoHeight);
    EXPECT_LT(seen.uncovered + std::abs(seen.outside) + seen.overlap, kNoArea);
    EXPECT_EQ(seen.not_up, 0U);
    EXPECT_EQ(made.report.largest_deviation_m, 0);
    EXPECT_EQ(made.report.largest_ratio, 0);
  }
}

TEST(Simplify, S4PlanesAndStraightEdgesNeedNoTolerance) {
  const auto faces = [](int rows, int cols, const std::function<double(int, int)>& f) {
    const Grid<float> heights = grid_from(rows, cols, f);
    return simplified(terrain_of(heights), within(0)).report.faces_after;
  };
  EXPECT_EQ(faces(12, 17, [](int, int) { return 7.25; }), 2U);
  EXPECT_EQ(faces(12, 17, [](int r, int c) { return 0.25 * r - 3 * c; }), 2U);
  EXPECT_EQ(faces(13, 17, [](int, int c) { return std::abs(c - 8); }), 4U);    // a roof along a column
  EXPECT_EQ(faces(14, 14, [](int r, int c) { return std::abs(r - c); }), 2U);  // along the diagonal
  // A spike: six faces, and ten from its foot to the corners; one more where the way is blocked.
  EXPECT_LE(faces(9, 9, [](int r, int c) { return r == 4 && c == 4; }), 17U);
}

TEST(Simplify, WhateverTheRastersOrientation) {
  const Grid<float> heights = grid_from(20, 26, [](int r, int c) { return hills(r, c, 0.8, 12); });
  for (const std::array<double, 6>& map :
       {kNorthUp, kSouthUp, std::array<double, 6>{4e5, -3, 0, 5e6, 0, -2},
        std::array<double, 6>{4e5, 8, 6, 5e6, 6, -8}, std::array<double, 6>{4e5, 0, 5, 5e6, 5, 0}}) {
    const DemTerrain terrain = terrain_of(heights, map);
    const SimplifyOptions options = within(2);
    const SimplifiedTin made = simplified(terrain, options);
    expect_kept(terrain, options, made);
    EXPECT_LT(made.report.faces_after, made.report.faces_before / 2);
  }
}

TEST(Simplify, KeepsWhatItIsToldTo) {
  const Grid<float> heights = grid_from(20, 26, [](int r, int c) { return hills(r, c, 0.8, 13); });
  const DemTerrain terrain = terrain_of(heights);
  SimplifyOptions options = within(10);
  options.keep = Grid<std::uint8_t>(20, 26, 0);
  options.keep.at(7, 11) = options.keep.at(8, 12) = options.keep.at(0, 5) = options.keep.at(19, 25) = 1;
  const SimplifiedTin made = simplified(terrain, options);
  expect_kept(terrain, options, made);
  for (int r = 0; r < 20; ++r) {
    for (int c = 0; c < 26; ++c) {
      if (options.keep.at(r, c) == 0) continue;
      const Xy at = terrain.geotransform.of_sample(c, r);
      const Xyz place = made.tin.from_crs({at.x, at.y, heights.at(r, c)});
      EXPECT_EQ(std::count(made.tin.vertices.begin(), made.tin.vertices.end(), place), 1) << r << " " << c;
    }
  }
}

TEST(Simplify, KeptBordersFit) {
  const Grid<float> heights = grid_from(30, 30, [](int r, int c) { return hills(r, c, 0.8, 14); });
  const DemTerrain terrain = terrain_of(heights);
  SimplifyOptions options = within(10);
  options.keep_border = true;
  const SimplifiedTin made = simplified(terrain, options);
  expect_kept(terrain, options, made);
  std::size_t on_border = 0;
  for (const Xyz& v : made.tin.vertices) {
    const Xyz crs = made.tin.to_crs(v);
    const Xy at = terrain.geotransform.to_raster(crs.x, crs.y);
    const double edge = std::min({at.x, at.y, 29 - at.x, 29 - at.y});
    if (std::abs(edge) > 1e-6) continue;
    ++on_border;
    EXPECT_EQ(crs.z, heights.at(static_cast<int>(std::lround(at.y)), static_cast<int>(std::lround(at.x))));
  }
  EXPECT_EQ(on_border, 4U * 29);
}

TEST(Simplify, StopsAtTheTarget) {
  const Grid<float> heights = grid_from(30, 31, [](int r, int c) { return hills(r, c, 0.8, 17); });
  const DemTerrain terrain = terrain_of(heights);
  const std::size_t least = simplified(terrain, within(3)).report.faces_after;
  for (const int target : {1000, 500, 300}) {
    SimplifyOptions options = within(3);
    options.target_faces = target;
    const SimplifiedTin made = simplified(terrain, options);
    expect_kept(terrain, options, made);
    EXPECT_GE(made.tin.faces.size(), static_cast<std::size_t>(target - 1));
    EXPECT_LE(made.tin.faces.size(), static_cast<std::size_t>(target));
  }
  SimplifyOptions options = within(3);
  options.target_faces = 2;
  EXPECT_LE(simplified(terrain, options).report.faces_after, least + 4);  // another order, much the same end
  options.target_faces = 5000;
  EXPECT_EQ(simplified(terrain, options).report.faces_after, 2U * 29 * 30);
}

TEST(Simplify, D1SameBytesForAnyNumberOfThreads) {
  const Grid<float> heights = grid_from(300, 280, [](int r, int c) { return hills(r, c, 0.8, 15); });
  SimplifyOptions options = within(2);
  options.threads = 1;
  const SimplifiedTin one = simplified(terrain_of(heights), options);
  for (const int threads : {2, 0}) {
    options.threads = threads;
    const SimplifiedTin more = simplified(terrain_of(heights), options);
    EXPECT_EQ(one.tin.vertices, more.tin.vertices);
    EXPECT_EQ(one.tin.faces, more.tin.faces);
    EXPECT_EQ(one.tin.face_attributes[0].values, more.tin.face_attributes[0].values);
  }
}

TEST(Simplify, CanBeCancelled) {
  const Grid<float> heights = grid_from(300, 300, [](int r, int c) { return hills(r, c, 0.8, 16); });
  int calls = 0;
  Progress progress([&](double) { return ++calls < 2; });
  EXPECT_THROW(simplify_dem(terrain_of(heights), within(1), progress), Cancelled);
}

TEST(Simplify, RefusesWhatItCannotUse) {
  const Grid<float> good = grid_from(4, 5, [](int r, int c) { return r * c; });
  const auto message = [&](const Grid<float>& heights, SimplifyOptions options) {
    try {
      simplified(terrain_of(heights), options);
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_TRUE(says(message(good, within(-1)), "tolerance is -1"));
  EXPECT_TRUE(says(message(good, within(std::nan(""))), "tolerance is"));
  EXPECT_TRUE(says(message(Grid<float>(1, 5, 0.0f), within(1)), "1 x 5"));
  EXPECT_TRUE(says(message(Grid<float>(4, 5, kNan), within(1)), "no surface"));
  EXPECT_TRUE(
      says(message(Grid<float>(3, 3, std::numeric_limits<float>::infinity()), within(1)), "height of the DEM is inf"));
  SimplifyOptions options;
  options.tolerance = Grid<float>(4, 4, 1.0f);
  EXPECT_TRUE(says(message(good, std::move(options)), "tolerance has 4 x 4"));
  options = {};
  options.keep = Grid<std::uint8_t>(3, 5, 1);
  EXPECT_TRUE(says(message(good, std::move(options)), "keep has 3 x 5"));
  options = {};
  options.target_faces = -3;
  EXPECT_TRUE(says(message(good, std::move(options)), "target_faces is -3"));
  options = {};
  options.least_gain = 1.5;
  EXPECT_TRUE(says(message(good, std::move(options)), "least_gain is 1.5"));
}

}  // namespace
}  // namespace sightbound
