// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "error_model/sampling_error.h"
#include "support/terrains.h"

namespace sightbound {
namespace {

using testing::copy_of;
using testing::dem_of;
using testing::grid_from;
using testing::grid_of;
using testing::hills;
using testing::kNan;

std::vector<CellSize> cells(int rows, double col_m, double row_m) {
  return std::vector<CellSize>(static_cast<std::size_t>(rows), CellSize{col_m, row_m});
}

SampleField koppe(const Grid<float>& heights, double sigma_v, double sigma_h,
                  const std::vector<CellSize>& sizes) {
  Progress progress;
  return sampling_error(SampleField(static_cast<float>(sigma_v)), sigma_h, Surroundings(heights), sizes,
                        Workers(1), progress);
}

// tan(slope) of the plane through three samples by its normal; shares no formula with the code.
double tan_slope(const Grid<float>& z, const CellSize& cell, const int (&corners)[3][2]) {
  double p[3][3];
  for (int i = 0; i < 3; ++i) {
    const int r = corners[i][0], c = corners[i][1];
    if (r < 0 || c < 0 || r >= z.rows() || c >= z.cols()) return kNan;
    p[i][0] = c * cell.col_m, p[i][1] = r * cell.row_m, p[i][2] = z.at(r, c);
  }
  const double u[] = {p[1][0] - p[0][0], p[1][1] - p[0][1], p[1][2] - p[0][2]};
  const double v[] = {p[2][0] - p[0][0], p[2][1] - p[0][1], p[2][2] - p[0][2]};
  const double n[] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  return std::hypot(n[0], n[1]) / std::abs(n[2]);
}

double steepest_around(const Grid<float>& z, const CellSize& cell, int r, int c) {
  double largest = 0;
  for (int i = r - 1; i <= r; ++i) {
    for (int j = c - 1; j <= c; ++j) {
      const int upper[3][2] = {{i, j}, {i, j + 1}, {i + 1, j + 1}},
                lower[3][2] = {{i, j}, {i + 1, j}, {i + 1, j + 1}};
      for (const auto& triangle : {std::cref(upper), std::cref(lower)}) {
        const auto& t = triangle.get();
        const bool touches =
            std::any_of(std::begin(t), std::end(t), [&](const int(&p)[2]) { return p[0] == r && p[1] == c; });
        const double slope = touches ? tan_slope(z, cell, t) : 0;
        if (slope > largest) largest = slope;
      }
    }
  }
  return largest;
}

TEST(SamplingError, OnAPlaneIsKoppesFormula) {
  const Grid<float> plane = grid_from(6, 7, [](int r, int c) { return 100 + 3.0 * c + 4.0 * r; });
  const SampleField field = koppe(plane, 1, 2, cells(6, 10, 10));
  for (const float sigma : field.values().values())
    EXPECT_FLOAT_EQ(sigma, 1 + 2 * 0.5f);  // tan = hypot(0.3, 0.4)
}

TEST(SamplingError, TakesTheSteepestOfSixTriangles) {
  const Grid<float> rough = grid_from(9, 8, [](int r, int c) { return hills(r, c, 0.3, 5); });
  const SampleField field = koppe(rough, 0.25, 1.5, cells(9, 7, 11));
  for (int r = 0; r < 9; ++r) {
    for (int c = 0; c < 8; ++c) {
      EXPECT_NEAR(field.at(r, c), 0.25 + 1.5 * steepest_around(rough, {7, 11}, r, c), 2e-6 * field.at(r, c))
          << r << " " << c;
    }
  }
}

TEST(SamplingError, LooksAlongTheNorthWestSouthEastDiagonalOnly) {
  // A spike two diagonal steps of the other kind away shares no triangle with the sample in the middle.
  const Grid<float> spike = grid_of({{0, 0, 9}, {0, 0, 0}, {0, 0, 0}});
  EXPECT_EQ(koppe(spike, 0, 1, cells(3, 1, 1)).at(1, 1), 0);
  const Grid<float> on_diagonal = grid_of({{9, 0, 0}, {0, 0, 0}, {0, 0, 0}});
  EXPECT_FLOAT_EQ(koppe(on_diagonal, 0, 1, cells(3, 1, 1)).at(1, 1), 9);
}

TEST(SamplingError, TrianglesWithAHoleDoNotCount) {
  const Grid<float> holey = grid_of({{0, 0, 0, 0}, {0, 0, kNan, 50}, {0, 0, 7, 0}, {0, 0, 0, 0}});
  const SampleField field = koppe(holey, 0, 1, cells(4, 1, 1));
  EXPECT_EQ(field.at(0, 0), 0);
  EXPECT_FLOAT_EQ(field.at(2, 1), 7 * std::sqrt(2.0f));  // (2,1)-(2,2)-(3,2) is whole
  EXPECT_EQ(field.at(1, 2), 0);                          // the hole itself: no whole triangle, a finite value
  for (const float sigma : field.values().values()) EXPECT_TRUE(std::isfinite(sigma));
}

TEST(SamplingError, WithoutHorizontalErrorNothingIsComputed) {
  const Grid<float> rough = grid_from(5, 5, [](int r, int c) { return hills(r, c, 0.3, 5); });
  const SampleField field = koppe(rough, 0.75, 0, cells(5, 1, 1));
  EXPECT_TRUE(field.is_constant());
  EXPECT_EQ(field.constant(), 0.75f);
}

TEST(SamplingError, AddsToAGridOfSigmaInPlace) {
  const Grid<float> plane = grid_from(4, 4, [](int, int c) { return 2.0 * c; });
  Grid<float> sigma_v = grid_from(4, 4, [](int r, int c) { return r + 0.1 * c; });
  const float* storage = sigma_v.data();
  Progress progress;
  const auto sizes = cells(4, 1, 1);
  const SampleField field =
      sampling_error(SampleField(std::move(sigma_v)), 3, Surroundings(plane), sizes, Workers(2), progress);
  EXPECT_EQ(field.values().data(), storage);
  EXPECT_FLOAT_EQ(field.at(2, 3), 2.3f + 6);
}

}  // namespace
}  // namespace sightbound
