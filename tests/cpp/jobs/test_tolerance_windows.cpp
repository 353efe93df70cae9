// SPDX-License-Identifier: GPL-3.0-or-later
// A DEM and its error window by window: as if it had been read at once.
#include <cmath>
#include <cstdint>
#include <memory>

#include <gtest/gtest.h>

#include "base/error.h"
#include "jobs/tolerance_windows.h"
#include "support/says.h"
#include "support/terrains.h"

namespace sightbound {
namespace {

using namespace testing;

constexpr int kRows = 20, kCols = 30;

std::unique_ptr<DemSource> waves() {
  return dem_of(grid_from(kRows, kCols, [](int r, int c) { return 50 + 3 * std::sin(0.7 * c) + r; }));
}

// An error of its own at each sample, missing at two of them.
ErrorModel holey_error() {
  Grid<float> sigma = grid_from(kRows, kCols, [](int r, int c) { return 0.5 + 0.01 * r + 0.001 * c; });
  sigma.at(9, 4) = sigma.at(15, 29) = kNan;
  ErrorModel model;
  model.vertical_rmse = std::make_shared<const Grid<float>>(std::move(sigma));
  model.geologic_variation = 3.0;
  return model;
}

TEST(ToleranceWindows, AreTheSameWhateverIsReadAtOnce) {
  const auto dem = waves();
  ErrorModel model = holey_error();
  model.horizontal_rmse = 0.7;
  const Workers workers(1);
  ToleranceWindows whole(*dem, dem->window(), model, 2, nullptr, workers),
      parts(*dem, dem->window(), model, 2, nullptr, workers);
  Progress progress;
  const DemWindow all = whole.read({0, 0, kCols, kRows}, progress);
  for (const Window& window : {Window{0, 0, kCols, 10}, Window{0, 9, kCols, 11}, Window{0, 0, kCols, 10}}) {
    const DemWindow part = parts.read(window, progress);
    for (int r = 0; r < window.rows; ++r) {
      for (int c = 0; c < kCols; ++c) {
        const float z = all.heights.at(window.row + r, c);
        EXPECT_EQ(std::isnan(part.heights.at(r, c)), std::isnan(z));
        if (std::isnan(z)) continue;
        EXPECT_EQ(part.heights.at(r, c), z);
        EXPECT_EQ(part.tolerance.at(r, c), all.tolerance.at(window.row + r, c));
      }
    }
  }
  EXPECT_EQ(parts.least(), whole.least());
  EXPECT_EQ(parts.largest(), whole.largest());
  EXPECT_EQ(parts.warnings(), whole.warnings());
  ASSERT_EQ(whole.warnings().size(), 1U);
  EXPECT_TRUE(says(whole.warnings()[0], "vertical_rmse has no value at 2 of 600 cells"));
}

TEST(ToleranceWindows, OneForAllTakesNoMemory) {
  const auto dem = waves();
  ErrorModel model;
  model.vertical_rmse = 0.5;
  const Workers workers(1);
  ToleranceWindows windows(*dem, {3, 2, 10, 12}, model, 2, nullptr, workers);
  EXPECT_EQ(windows.constant(), 1);
  EXPECT_EQ(windows.least(), 1);
  Progress progress;
  const DemWindow read = windows.read({1, 1, 4, 5}, progress);
  EXPECT_TRUE(read.tolerance.empty());
  EXPECT_EQ(read.heights.at(0, 0), dem->read({4, 3, 1, 1}, progress).at(0, 0));
}

TEST(ToleranceWindows, SayWhichSamplesStay) {
  const auto dem = waves();
  ErrorModel model;
  model.vertical_rmse = 0.5;
  Grid<float> keep(kRows, kCols, 0.0f);
  keep.at(4, 6) = 1;
  const Workers workers(1);
  const SharedGrid shared = std::make_shared<const Grid<float>>(std::move(keep));
  ToleranceWindows windows(*dem, {3, 2, 10, 12}, model, 2, shared, workers);
  Progress progress;
  const DemWindow read = windows.read({1, 1, 4, 5}, progress);
  EXPECT_EQ(read.keep.at(1, 2), 1);
  EXPECT_EQ(read.keep.at(2, 2), 0);
  const SharedGrid wrong = std::make_shared<const Grid<float>>(3, 3, 0.0f);
  EXPECT_TRUE(
      says(complaint<InvalidInput>([&] { ToleranceWindows(*dem, dem->window(), model, 2, wrong, workers); }),
           "keep has 3 x 3"));
}

}  // namespace
}  // namespace sightbound
