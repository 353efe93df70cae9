// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "base/error.h"
#include "error_model/local_variation.h"
#include "support/terrains.h"

namespace sightbound {
namespace {

using testing::copy_of;
using testing::dem_of;
using testing::grid_from;
using testing::grid_of;
using testing::hills;
using testing::kNan;
using testing::noise;
using testing::part_of;

Grid<float> map_of(const Grid<float>& heights, double exponent = 1, double typical = 9, int threads = 1) {
  Progress progress;
  return local_variation(Surroundings(heights), residual_scale(exponent, CellContent::kSamples), typical,
                         Workers(threads), progress);
}

// The definition in the header, written down once more.
double by_definition(const Grid<float>& z, int row, int col, double exponent, double typical) {
  const auto at = [&](int r, int c) {
    return r < 0 || c < 0 || r >= z.rows() || c >= z.cols() ? std::nan("") : double(z.at(r, c));
  };
  if (std::isnan(at(row, col))) return typical;
  double sum = 0;
  int count = 0;
  for (int r = row - 1; r <= row + 1; ++r) {
    for (int c = col - 1; c <= col + 1; ++c) {
      const double e[] = {at(r, c) - (at(r, c - 1) + at(r, c + 1)) / 2,
                          at(r, c) - (at(r - 1, c) + at(r + 1, c)) / 2,
                          at(r, c) - (at(r - 1, c - 1) + at(r + 1, c + 1)) / 2};
      for (int i = 0; i < 3; ++i) {
        if (std::isnan(e[i])) continue;
        sum += e[i] * e[i] * (i == 2 ? std::pow(2, -exponent) : 1);
        ++count;
      }
    }
  }
  return count == 0 ? typical : std::pow(2, -exponent) * std::sqrt(sum / count);
}

void expect_by_definition(const Grid<float>& heights, double exponent) {
  const Grid<float> map = map_of(heights, exponent, 9);
  for (int r = 0; r < heights.rows(); ++r) {
    for (int c = 0; c < heights.cols(); ++c) {
      const double expected = by_definition(heights, r, c, exponent, 9);
      EXPECT_NEAR(map.at(r, c), expected, 1e-5 * expected + 1e-6) << r << " " << c;
    }
  }
}

TEST(LocalVariation, IsItsDefinition) {
  expect_by_definition(grid_from(70, 33, [](int r, int c) { return hills(r, c, 0.8, 3); }), 0.8);
  expect_by_definition(grid_from(5, 5, [](int r, int c) { return noise(r, c, 1); }), 1.5);
}

TEST(LocalVariation, IsItsDefinitionAroundHolesAndOnSmallDems) {
  expect_by_definition(
      grid_from(80, 40, [](int r, int c) { return noise(r, c, 7) < 0.1 ? double(kNan) : hills(r, c, 1, 2); }),
      1.1);
  expect_by_definition(grid_of({{1, 2}, {3, 9}}), 1);
  expect_by_definition(grid_of({{1, 2, 0}, {3, kNan, 4}}), 1);
  expect_by_definition(grid_of({{1, 2, 0, 5, 3, 8}, {3, 9, 1, 1, 4, 2}}), 1);
}

TEST(LocalVariation, OfAPlaneIsNothing) {
  const Grid<float> plane = grid_from(20, 20, [](int r, int c) { return 500 + 3.0 * c - 7.0 * r; });
  const Grid<float> map = map_of(plane);
  for (const float v : map.values()) EXPECT_EQ(v, 0);
}

TEST(LocalVariation, OfAStepIsAtTheStepAlone) {
  const Grid<float> step = grid_from(9, 20, [](int, int c) { return c < 10 ? 0 : 8; });
  const Grid<float> map = map_of(step);
  EXPECT_EQ(map.at(4, 7), 0);
  EXPECT_GT(map.at(4, 8), 0);
  EXPECT_GT(map.at(4, 11), 0);
  EXPECT_EQ(map.at(4, 12), 0);
}

TEST(LocalVariation, OnNodataAndWhereNothingIsKnownIsTypical) {
  Grid<float> lonely(9, 9, kNan);
  lonely.at(4, 4) = 100;
  const Grid<float> map = map_of(lonely, 1, 2.5);
  for (const float v : map.values()) EXPECT_EQ(v, 2.5f);
}

TEST(LocalVariation, DoesNotDependOnThreads) {
  const Grid<float> z = grid_from(
      300, 77, [](int r, int c) { return noise(r, c, 9) < 0.01 ? double(kNan) : hills(r, c, 1, 4); });
  const Grid<float> one = map_of(z, 0.9, 1, 1), many = map_of(z, 0.9, 1, 7);
  EXPECT_EQ(std::memcmp(one.data(), many.data(), one.size() * sizeof(float)), 0);
}

TEST(LocalVariation, DoesNotDependOnTheWindow) {
  const auto whole = grid_from(
      200, 90, [](int r, int c) { return noise(r, c, 9) < 0.02 ? double(kNan) : hills(r, c, 1, 4); });
  for (const auto& geotransform : {testing::kNorthUp, testing::kSouthUp}) {
    const auto dem = dem_of(copy_of(whole), geotransform);
    Progress progress;
    const Grid<float> all = dem->read(dem->window(), progress);
    const Grid<float> map = local_variation(Surroundings(all), residual_scale(0.9, CellContent::kSamples), 1,
                                            Workers(2), progress);
    for (const Window& w : {Window{0, 0, 90, 200}, Window{3, 5, 40, 100}, Window{1, 1, 88, 198},
                            Window{60, 150, 30, 50}, Window{17, 64, 1, 1}, Window{0, 70, 2, 130}}) {
      const Grid<float> heights = dem->read(w, progress);
      const Grid<float> part =
          local_variation(Surroundings(heights, w, *dem, progress),
                          residual_scale(0.9, CellContent::kSamples), 1, Workers(2), progress);
      const Grid<float> expected = part_of(map, w);
      EXPECT_EQ(std::memcmp(part.data(), expected.data(), part.size() * sizeof(float)), 0)
          << w.col << " " << w.row;
    }
  }
}

TEST(LocalVariation, CanBeCancelled) {
  const Grid<float> z(200, 200, 1.0f);
  Progress progress([](double) { return false; });
  EXPECT_THROW(
      local_variation(Surroundings(z), residual_scale(1, CellContent::kSamples), 1, Workers(1), progress),
      Cancelled);
}

}  // namespace
}  // namespace sightbound
