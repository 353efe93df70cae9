// SPDX-License-Identifier: GPL-3.0-or-later
#include <numeric>
#include <utility>

#include <gtest/gtest.h>

#include "terrain/grid.h"

namespace sightbound {
namespace {

TEST(Window, HalfOpen) {
  const Window w{2, 3, 4, 5};
  EXPECT_EQ(w.col_end(), 6);
  EXPECT_EQ(w.row_end(), 8);
  EXPECT_EQ(w.cells(), 20U);
  EXPECT_TRUE(w.contains({2, 3, 4, 5}));
  EXPECT_FALSE(w.contains({2, 3, 5, 5}));
  EXPECT_FALSE(w.contains({1, 3, 4, 5}));
}

TEST(Window, IntersectionsAndBounds) {
  const Window a{0, 0, 4, 4}, b{2, 3, 5, 5}, apart{9, 9, 1, 1};
  EXPECT_EQ(intersection(a, b), (Window{2, 3, 2, 1}));
  EXPECT_TRUE(intersection(a, apart).empty());
  EXPECT_EQ(intersection(a, apart).cells(), 0U);
  EXPECT_EQ(bounding(a, b), (Window{0, 0, 7, 8}));
  EXPECT_EQ(bounding(a, Window{}), a);
  EXPECT_EQ(bounding(Window{}, a), a);
}

TEST(Window, CellsDoNotOverflow) { EXPECT_EQ((Window{0, 0, 100000, 100000}.cells()), 10000000000U); }

TEST(Grid, RowsAreContiguous) {
  Grid<int> grid(3, 4);
  std::iota(grid.values().begin(), grid.values().end(), 0);
  EXPECT_EQ(grid.at(2, 3), 11);
  EXPECT_EQ(grid.row(1), grid.data() + 4);
  EXPECT_EQ(grid.size(), 12U);
}

TEST(Grid, FillsAndMoves) {
  Grid<float> grid(2, 2, 7.0F);
  const float* data = grid.data();
  const Grid<float> moved = std::move(grid);
  EXPECT_EQ(moved.data(), data);
  EXPECT_EQ(moved.at(1, 1), 7);
  EXPECT_TRUE(Grid<float>().empty());
}

TEST(Grid, FlipRows) {
  for (const int rows : {1, 2, 3, 4}) {
    Grid<int> grid(rows, 2);
    std::iota(grid.values().begin(), grid.values().end(), 0);
    grid.flip_rows();
    for (int r = 0; r < rows; ++r) EXPECT_EQ(grid.at(r, 1), 2 * (rows - 1 - r) + 1);
  }
}

}  // namespace
}  // namespace sightbound
