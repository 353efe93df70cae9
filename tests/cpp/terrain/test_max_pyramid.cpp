// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "terrain/max_pyramid.h"

namespace sightbound {
namespace {

Grid<float> noise(int rows, int cols, double holes) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> height(0, 100), chance(0, 1);
  Grid<float> grid(rows, cols);
  for (float& z : grid.values())
    z = chance(random) < holes ? std::numeric_limits<float>::quiet_NaN() : height(random);
  return grid;
}

MaxPyramid pyramid_of(const Grid<float>& grid) {
  Progress progress;
  return MaxPyramid(
      grid.rows(), grid.cols(), [&](int r, float*) { return grid.row(r); }, Workers(2), progress);
}

class MaxPyramidOf : public testing::TestWithParam<std::array<int, 2>> {};

TEST_P(MaxPyramidOf, holds_the_largest_sample_on_and_in_every_node) {
  const Grid<float> grid = noise(GetParam()[0], GetParam()[1], 0.02);
  const MaxPyramid pyramid = pyramid_of(grid);
  for (int level = MaxPyramid::kFinest; level <= pyramid.coarsest(); ++level) {
    const int side = 1 << level;
    for (int row = 0; row * side < std::max(grid.rows() - 1, 1); ++row) {
      for (int col = 0; col * side < std::max(grid.cols() - 1, 1); ++col) {
        float most = std::numeric_limits<float>::lowest();
        bool hole = false;
        for (int r = row * side; r <= std::min((row + 1) * side, grid.rows() - 1); ++r) {
          for (int c = col * side; c <= std::min((col + 1) * side, grid.cols() - 1); ++c) {
            if (std::isnan(grid.at(r, c))) {
              hole = true;
            } else {
              most = std::max(most, grid.at(r, c));
            }
          }
        }
        EXPECT_EQ(pyramid.max(level, row, col), most) << level << " " << row << " " << col;
        EXPECT_EQ(pyramid.has_hole(level, row, col), hole) << level << " " << row << " " << col;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, MaxPyramidOf,
                         testing::Values(std::array{2, 2}, std::array{5, 5}, std::array{6, 33},
                                         std::array{64, 65}, std::array{101, 37}));

TEST(MaxPyramid, keeps_no_holes_where_there_are_none) {
  EXPECT_FALSE(pyramid_of(noise(20, 20, 0)).any_hole());
  EXPECT_TRUE(pyramid_of(noise(20, 20, 0.5)).any_hole());
}

}  // namespace
}  // namespace sightbound
