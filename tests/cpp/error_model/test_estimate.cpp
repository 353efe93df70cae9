// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "error_model/estimate.h"
#include "error_model/local_variation.h"
#include "support/says.h"
#include "support/terrains.h"

namespace sightbound {
namespace {

using testing::dem_of;
using testing::grid_from;
using testing::hills;
using testing::kNan;
using testing::noise;
using testing::says;

Estimate learnt(Grid<float> heights, const std::array<double, 6>& geotransform = testing::kNorthUp) {
  Progress progress;
  return estimate(*dem_of(std::move(heights), geotransform), CellContent::kSamples, progress);
}

// A random walk in both directions: increments independent, so that H = 1/2.
Grid<float> sheet_of_walks(int rows, int cols) {
  std::vector<double> down(static_cast<std::size_t>(rows)), across(static_cast<std::size_t>(cols));
  for (std::size_t r = 1; r < down.size(); ++r) down[r] = down[r - 1] + noise(int(r), 0, 1) - 0.5;
  for (std::size_t c = 1; c < across.size(); ++c) across[c] = across[c - 1] + noise(0, int(c), 2) - 0.5;
  return grid_from(rows, cols, [&](int r, int c) { return down[std::size_t(r)] + across[std::size_t(c)]; });
}

TEST(Estimate, FindsTheGrowthOfARandomWalk) {
  const Estimate found = learnt(sheet_of_walks(700, 800));
  EXPECT_NEAR(found.growth_exponent, 0.5, 0.06);
  // Each walk's residual: (step - step) / 2 with steps of variance 1/12.
  EXPECT_NEAR(found.edge_ms, 1.0 / 24, 0.003);
  EXPECT_TRUE(found.warnings.empty());
}

TEST(Estimate, OfWhiteNoiseDoesNotGrow) {
  const Estimate found = learnt(grid_from(300, 300, [](int r, int c) { return noise(r, c, 5); }));
  EXPECT_DOUBLE_EQ(found.growth_exponent, 0.1);  // clipped
  EXPECT_NEAR(found.edge_ms, 1.5 / 12, 0.002);
}

TEST(Estimate, OfAParaboloidGrowsQuadraticallyAndWarns) {
  const Estimate found = learnt(grid_from(60, 60, [](int r, int c) { return 0.01 * (r * r + c * c); }));
  EXPECT_NEAR(found.growth_exponent, 2, 1e-3);
  EXPECT_NEAR(std::sqrt(found.edge_ms), 0.01, 1e-5);
  ASSERT_EQ(found.warnings.size(), 1u);
  EXPECT_TRUE(says(found.warnings[0], "smoother than its cell size"));
}

TEST(Estimate, OfAFlatDemOrAPlaneIsZero) {
  for (const double slope : {0.0, 0.37}) {
    const Estimate found =
        learnt(grid_from(90, 90, [=](int r, int c) { return 1234.5 + slope * c - 2 * slope * r; }));
    EXPECT_EQ(found.growth_exponent, 1);
    EXPECT_EQ(found.typical_m, 0);
    EXPECT_EQ(found.rounding_m, 0);
    ASSERT_EQ(found.warnings.size(), 1u);
    EXPECT_TRUE(says(found.warnings[0], "flat"));
  }
}

TEST(Estimate, TypicalIsTheRmsOfTheLocalMap) {
  const Grid<float> z = grid_from(400, 400, [](int r, int c) { return hills(r, c, 0.9, 8); });
  const Estimate found = learnt(testing::copy_of(z));
  Progress progress;
  const Grid<float> map = local_variation(
      Surroundings(z), residual_scale(found.growth_exponent, found.content, found.local_scale),
      found.typical_m, Workers(1), progress);
  double sum = 0;
  for (const float v : map.values()) sum += double(v) * v;
  EXPECT_NEAR(std::sqrt(sum / double(map.size())) / found.typical_m, 1, 0.01);
}

TEST(Estimate, RoundingDoesNotHideTheGrowth) {
  const auto terrain = [](int r, int c) { return 3 * hills(r, c, 1.2, 8); };
  const Estimate exact = learnt(grid_from(400, 400, terrain));
  const Estimate rounded =
      learnt(grid_from(400, 400, [&](int r, int c) { return std::round(terrain(r, c)); }));
  EXPECT_EQ(exact.rounding_m, 0);
  EXPECT_NEAR(rounded.rounding_m, 0.2887, 1e-4);
  EXPECT_NEAR(rounded.growth_exponent, exact.growth_exponent, 0.1);
}

// Most errors of rounded heights are exactly 0: that is no bare roof.
TEST(Estimate, RoundingIsNotLearntAsTails) {
  for (const double scale : {0.03, 0.1, 0.3, 1.0, 3.0}) {
    const Estimate rounded =
        learnt(grid_from(400, 400, [&](int r, int c) { return std::round(scale * hills(r, c, 0.9, 9)); }));
    EXPECT_GT(rounded.rounding_m, 0);
    EXPECT_TRUE(rounded.steps.is_normal()) << scale;
  }
}

TEST(Estimate, SkipsHolesAndSpikes) {
  const auto terrain = [](int r, int c) { return hills(r, c, 0.9, 8); };
  const Estimate whole = learnt(grid_from(400, 400, terrain));
  const Estimate holey = learnt(grid_from(400, 400, [&](int r, int c) {
    const double dice = noise(r, c, 4);
    return dice < 0.02 ? double(kNan) : dice < 0.021 ? 1e9 : terrain(r, c);
  }));
  EXPECT_NEAR(holey.growth_exponent, whole.growth_exponent, 0.02);
  EXPECT_NEAR(holey.typical_m / whole.typical_m, 1, 0.02);
}

TEST(Estimate, OfASmallDemSaysThatItIsSmall) {
  const Estimate found = learnt(grid_from(6, 6, [](int r, int c) { return hills(r, c, 0.9, 8); }));
  EXPECT_EQ(found.growth_exponent, 1);
  EXPECT_GT(found.typical_m, 0);
  ASSERT_EQ(found.warnings.size(), 1u);
  EXPECT_TRUE(says(found.warnings[0], "only 4 places"));
}

TEST(Estimate, OfADemWithoutHeightsIsZeroWithAWarning) {
  const Estimate found = learnt(Grid<float>(50, 50, kNan));
  EXPECT_EQ(found.typical_m, 0);
  EXPECT_EQ(found.growth_exponent, 1);
  EXPECT_EQ(found.warnings.size(), 1u);
}

// Counts what is read.
class Watched final : public DemSource {
 public:
  explicit Watched(const DemSource& source, const std::array<double, 6>& geotransform)
      : DemSource(source.rows(), source.cols(), Geotransform(geotransform), ""), source_(source) {}
  Grid<float> read(const Window& w, Progress& progress) const override {
    windows.push_back(w);
    return source_.read(w, progress);
  }
  mutable std::vector<Window> windows;

 private:
  const DemSource& source_;
};

TEST(Estimate, ReadsSpreadBlocksOnTheFilesTiles) {
  constexpr int kRows = 2900, kCols = 2500;
  for (const auto& geotransform : {testing::kNorthUp, testing::kSouthUp}) {
    const auto dem =
        dem_of(grid_from(kRows, kCols, [](int r, int c) { return noise(r / 2, c / 2, 3); }), geotransform);
    const Watched watched(*dem, geotransform);
    Progress progress;
    estimate(watched, std::nullopt, progress);
    EXPECT_LE(watched.windows.size(), static_cast<std::size_t>(kEstimateBlocks));
    EXPECT_GE(watched.windows.size(), static_cast<std::size_t>(kEstimateBlocks) * 3 / 4);
    Window all;
    for (const Window& w : watched.windows) {
      const int file_row = dem->flipped() ? kRows - w.row_end() : w.row;
      EXPECT_EQ(file_row % kEstimateBlockSide, 0);
      EXPECT_EQ(w.col % kEstimateBlockSide, 0);
      EXPECT_TRUE(dem->window().contains(w));
      all = bounding(all, w);
    }
    EXPECT_GT(all.cells(), dem->window().cells() * 6 / 10);
  }
}

TEST(Estimate, LooksFurtherWhenMostHeightsAreMissing) {
  const auto dem = dem_of(
      grid_from(2600, 2600, [](int r, int c) { return r < 100 && c < 100 ? noise(r, c, 3) : double(kNan); }));
  Progress progress;
  const Estimate found = estimate(*dem, std::nullopt, progress);
  EXPECT_TRUE(found.warnings.empty());
  EXPECT_GT(found.typical_m, 0);
}

TEST(WithEstimate, FillsInOnlyWhatWasLeftOpen) {
  Estimate found;
  found.growth_exponent = 0.8;
  found.rounding_m = 0.29;
  found.edge_ms = found.diagonal_ms = 1;
  const ErrorModel all = with_estimate(ErrorModel(), found);
  EXPECT_FALSE(all.needs_estimate());
  EXPECT_EQ(std::get<double>(all.vertical_rmse), 0.29);
  EXPECT_TRUE(std::holds_alternative<FromDem>(all.geologic_variation));
  EXPECT_EQ(all.geologic_shape, GeologicShape::kGrowth);
  EXPECT_EQ(all.growth_exponent, 0.8);
  EXPECT_DOUBLE_EQ(*all.typical_m, found.typical_with(0.8));
  EXPECT_NO_THROW(all.validate());

  ErrorModel said;
  said.vertical_rmse = 0.0;
  said.growth_exponent = 1.5;
  const ErrorModel kept = with_estimate(said, found);
  EXPECT_EQ(std::get<double>(kept.vertical_rmse), 0);
  EXPECT_EQ(kept.growth_exponent, 1.5);
  EXPECT_DOUBLE_EQ(*kept.typical_m, found.typical_with(1.5));

  ErrorModel geologic;
  geologic.geologic_variation = 3.0;
  const ErrorModel gaussian = with_estimate(geologic, found);
  EXPECT_EQ(gaussian.geologic_shape, GeologicShape::kGaussian);
  EXPECT_FALSE(gaussian.growth_exponent);
}

}  // namespace
}  // namespace sightbound
