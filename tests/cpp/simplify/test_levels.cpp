// SPDX-License-Identifier: GPL-3.0-or-later
// A hierarchy: each TIN within its own tolerance, and made of the one before by collapses alone.
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "simplify/simplify.h"
#include "support/simplify_promises.h"

namespace sightbound {
namespace {

using namespace testing;

std::vector<SimplifiedTin> levels_of(const DemTerrain& terrain, const SimplifyOptions& options,
                                     const std::vector<double>& factors) {
  Progress progress;
  return simplify_dem_levels(terrain, options, factors, progress);
}

// Turned so that the least number comes first.
Face turned(Face f) {
  std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
  return f;
}

std::multiset<Face> faces_of(const Tin& tin) {
  std::multiset<Face> faces;
  for (const Face& f : tin.faces) faces.insert(turned(f));
  return faces;
}

// The finer TIN's faces with their corners where these were drawn into.
std::multiset<Face> drawn_together(const SimplifiedTin& finer) {
  std::multiset<Face> faces;
  for (const Face& f : finer.tin.faces) {
    Face g{};
    for (std::size_t i = 0; i < 3; ++i) g[i] = finer.coarser_vertex[static_cast<std::size_t>(f[i])];
    if (g[0] != g[1] && g[1] != g[2] && g[2] != g[0]) faces.insert(turned(g));
  }
  return faces;
}

TEST(Levels, EachKeepsItsToleranceAndComesOfTheOneBefore) {
  const std::vector<double> factors{1, 1.5, 4, 10};
  for (const Scene& scene : scenes()) {
    SCOPED_TRACE(scene.name);
    const DemTerrain terrain = terrain_of(scene.heights);
    for (const int block : {256, 7}) {
      SCOPED_TRACE(block);
      SimplifyOptions options;
      options.tolerance_m = 0.5;
      options.block = block;
      if (block == 7) {
        options.tolerance = grid_from(scene.heights.rows(), scene.heights.cols(),
                                      [](int r, int c) { return 2 * noise(r / 3, c / 3, 11); });
      }
      const std::vector<SimplifiedTin> levels = levels_of(terrain, options, factors);
      ASSERT_EQ(levels.size(), factors.size());
      for (std::size_t n = 0; n < levels.size(); ++n) {
        SCOPED_TRACE(n);
        SimplifyOptions wider = within(options.tolerance_m * factors[n]);
        if (!options.tolerance.empty()) {
          wider.tolerance = grid_from(scene.heights.rows(), scene.heights.cols(), [&](int r, int c) {
            return static_cast<double>(options.tolerance.at(r, c)) * factors[n];
          });
        }
        expect_kept(terrain, wider, levels[n]);
        if (n + 1 == levels.size()) {
          EXPECT_TRUE(levels[n].coarser_vertex.empty());
        } else {
          EXPECT_EQ(drawn_together(levels[n]), faces_of(levels[n + 1].tin));
        }
      }
    }
  }
}

TEST(Levels, TheFirstIsWhatOneAloneWouldBeAndFewFacesMoreAreLeft) {
  const Grid<float> heights = grid_from(200, 210, [](int r, int c) { return hills(r, c, 0.8, 3); });
  const DemTerrain terrain = terrain_of(heights);
  const std::vector<SimplifiedTin> levels = levels_of(terrain, within(1), {1, 2, 5});
  const SimplifiedTin first = simplified(terrain, within(1));
  EXPECT_EQ(levels[0].tin.vertices, first.tin.vertices);
  EXPECT_EQ(levels[0].tin.faces, first.tin.faces);
  for (std::size_t n = 1; n < 3; ++n) {
    const std::size_t alone = simplified(terrain, within(n == 1 ? 2 : 5)).report.faces_after;
    EXPECT_LT(levels[n].report.faces_after, 1.15 * static_cast<double>(alone));
    EXPECT_LT(levels[n].report.faces_after, levels[n - 1].report.faces_after);
  }
}

TEST(Levels, D1SameBytesForAnyNumberOfThreads) {
  const Grid<float> heights = grid_from(300, 280, [](int r, int c) { return hills(r, c, 0.8, 15); });
  SimplifyOptions options = within(1);
  options.threads = 1;
  const std::vector<SimplifiedTin> one = levels_of(terrain_of(heights), options, {1, 3});
  options.threads = 2;
  const std::vector<SimplifiedTin> two = levels_of(terrain_of(heights), options, {1, 3});
  EXPECT_EQ(one[0].coarser_vertex, two[0].coarser_vertex);
  EXPECT_EQ(one[1].tin.vertices, two[1].tin.vertices);
  EXPECT_EQ(one[1].tin.faces, two[1].tin.faces);
}

TEST(Levels, SayWhatIsWrong) {
  const Grid<float> heights = grid_from(9, 9, [](int, int c) { return c; });
  const DemTerrain terrain = terrain_of(heights);
  for (const std::vector<double>& factors :
       {std::vector<double>{}, {2}, {1, 1}, {1, 3, 2}, {1, std::numeric_limits<double>::infinity()}})
    EXPECT_THROW(levels_of(terrain, within(1), factors), InvalidInput);
  SimplifyOptions options = within(1);
  options.target_faces = 10;
  EXPECT_THROW(levels_of(terrain, options, {1, 2}), InvalidInput);
}

}  // namespace
}  // namespace sightbound
