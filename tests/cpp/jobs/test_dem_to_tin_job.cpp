// SPDX-License-Identifier: GPL-3.0-or-later
// From a DEM and its error to a TIN: what the tolerance is, and which ground it covers.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "jobs/dem_to_tin_job.h"
#include "support/says.h"

namespace sightbound {
namespace {

using testing::complaint;
using testing::says;

ErrorModel error(double rmse) {
  ErrorModel model;
  model.vertical_rmse = rmse;
  model.geologic_variation = 0.0;
  return model;
}

// 20 x 30 samples of 10 m, waves of some metres.
class Waves {
 public:
  static constexpr int kRows = 20, kCols = 30;

  Waves()
      : dem_({heights_.data(), kRows, kCols, std::numeric_limits<double>::quiet_NaN(), 1, nullptr},
             Geotransform({1000, 10, 0, 2200, 0, -10}), "") {
    for (std::size_t n = 0; n < heights_.size(); ++n)
      heights_[n] = static_cast<float>(50 + 3 * std::sin(0.7 * static_cast<double>(n % kCols)) +
                                       2 * std::cos(0.9 * static_cast<double>(n / kCols)));
  }
  DemToTin tin(const ErrorModel& model, const DemToTinOptions& options = {}) const {
    Progress progress;
    return run_dem_to_tin(dem_, model, options, progress);
  }

 private:
  std::vector<float> heights_ = std::vector<float>(kRows * kCols);
  ArrayDem dem_;
};

TEST(DemToTin, TheToleranceIsSigmaAtTheConfidence) {
  const DemToTin made = Waves().tin(error(0.5));  // 0.95
  EXPECT_NEAR(made.least_tolerance_m, 0.98, 0.001);
  EXPECT_EQ(made.least_tolerance_m, made.largest_tolerance_m);
  EXPECT_LE(made.levels[0].report.largest_deviation_m, made.largest_tolerance_m);
  EXPECT_GT(made.levels[0].report.largest_deviation_m, 0.5);
  EXPECT_LT(made.levels[0].report.faces_after, made.levels[0].report.faces_before / 2);
  ASSERT_EQ(made.warnings.size(), 1u);
  EXPECT_TRUE(says(made.warnings[0], "CRS"));  // it has none
  DemToTinOptions itself;
  itself.error_means = ErrorMeans::kTolerance;
  EXPECT_EQ(Waves().tin(error(0.5), itself).largest_tolerance_m, 0.5);
}

TEST(DemToTin, SlopesCountWherePositionsAreInDoubt) {
  ErrorModel model = error(0.2);
  model.horizontal_rmse = 1;
  const DemToTin made = Waves().tin(model);
  EXPECT_LT(made.least_tolerance_m, 0.9 * made.largest_tolerance_m);
  EXPECT_GE(made.least_tolerance_m, 0.2 * 1.9599);
  EXPECT_LE(made.levels[0].report.largest_ratio, 1);
}

TEST(DemToTin, APartIsThatPart) {
  DemToTinOptions options;
  options.extent = Extent{1100, 2050, 1200, 2150};
  const DemToTin part = Waves().tin(error(0.5), options);
  EXPECT_EQ(part.levels[0].report.faces_before, 2u * 9 * 9);
  const Tin& tin = part.levels[0].tin;
  const Box3 box = bounds_of(tin);
  EXPECT_EQ(tin.to_crs(box.low).x, 1105);
  EXPECT_EQ(tin.to_crs(box.high).y, 2145);
}

TEST(DemToTin, ExactSamplesAreToldOf) {
  const DemToTin made = Waves().tin(error(0));
  ASSERT_FALSE(made.warnings.empty());
  EXPECT_TRUE(says(made.warnings.back(), "count as exact"));
}

TEST(DemToTin, AnAbsurdHeightIsToldOf) {
  std::vector<float> heights(100, 50.0f);
  const ArrayDem dem({heights.data(), 10, 10, std::numeric_limits<double>::quiet_NaN(), 1, nullptr},
                     Geotransform({0.1, 0.1, 0, 5e6, 0, -0.1}), "");
  Progress progress;
  heights[33] = -1e5f;
  const DemToTin made = run_dem_to_tin(dem, error(0.5), {}, progress);
  EXPECT_TRUE(std::any_of(made.warnings.begin(), made.warnings.end(),
                          [](const std::string& warning) { return warning.find("Rounding takes") == 0; }));
  heights[33] = -1e30f;  // nodata that nobody declared
  EXPECT_TRUE(
      says(complaint<InvalidInput>([&] { run_dem_to_tin(dem, error(0.5), {}, progress); }), "nodata"));
}

TEST(DemToTin, SeveralConfidencesGiveNestedTins) {
  DemToTinOptions options;
  options.levels = {0.5, 0.8, 0.95};
  const DemToTin made = Waves().tin(error(0.5), options);
  ASSERT_EQ(made.levels.size(), 3U);
  for (std::size_t n = 0; n < 3; ++n) {
    const double tolerance = 0.5 * two_sided_quantile(options.levels[n]);
    EXPECT_NEAR(made.factors[n] * made.least_tolerance_m, tolerance, 1e-6);
    EXPECT_LE(made.levels[n].report.largest_deviation_m, tolerance);
    EXPECT_EQ(made.levels[n].coarser_vertex.empty(), n == 2);
  }
  EXPECT_LT(made.levels[2].tin.faces.size(), made.levels[0].tin.faces.size());
  options.levels = {0.8, 0.5};
  EXPECT_THROW(Waves().tin(error(0.5), options), InvalidInput);
}

TEST(DemToTin, BreakLinesLieInTheCrs) {
  DemToTinOptions options;
  options.error_means = ErrorMeans::kTolerance;
  options.break_lines = {{{1105, 2095}, {1255, 2095}}};
  options.break_line_tolerance_m = 0;
  const DemToTin made = Waves().tin(error(1000), options);
  const Tin& tin = made.levels[0].tin;
  double along = 0;  // metres of edges on the line, each seen from both of its faces
  for (const Face& f : tin.faces) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Xyz a = tin.to_crs(tin.vertices[static_cast<std::size_t>(f[i])]),
                b = tin.to_crs(tin.vertices[static_cast<std::size_t>(f[(i + 1) % 3])]);
      if (a.y == 2095 && b.y == 2095) along += std::abs(a.x - b.x);
    }
  }
  EXPECT_EQ(along, 300);
  options.break_lines = {{{1105, 2095}, {1255, std::numeric_limits<double>::infinity()}}};
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { Waves().tin(error(1000), options); }), "break_lines"));
}

TEST(DemToTin, RefusesWhatItCannotHold) {
  DemToTinOptions options;
  options.memory_budget = 100;
  EXPECT_THROW(Waves().tin(error(0.5), options), OverBudget);
  options = {};
  options.levels = {1};
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { Waves().tin(error(0.5), options); }), "confidence"));
  options = {};
  options.target.faces = -1;
  EXPECT_THROW(Waves().tin(error(0.5), options), InvalidInput);
}

TEST(DemToTin, IsCancelled) {
  std::vector<float> heights(100);
  const ArrayDem dem({heights.data(), 10, 10, std::numeric_limits<double>::quiet_NaN(), 1, nullptr},
                     Geotransform({0, 1, 0, 0, 0, -1}), "");
  Progress progress([](double) { return false; });
  EXPECT_THROW(run_dem_to_tin(dem, error(0.5), {}, progress), Cancelled);
}

}  // namespace
}  // namespace sightbound
