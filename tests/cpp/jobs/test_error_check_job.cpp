// SPDX-License-Identifier: GPL-3.0-or-later
// What was put into a DEM must come out of comparing it with the truth.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "jobs/error_check_job.h"
#include "support/says.h"
#include "support/terrains.h"

namespace sightbound {
namespace {

using testing::complaint;
using testing::dem_of;
using testing::grid_from;
using testing::hills;
using testing::kNan;
using testing::noise;
using testing::says;

constexpr int kSide = 60;    // samples of the DEM, every way
constexpr int kStep = 4;     // samples of the truth to one of the DEM
constexpr double kFine = 5;  // metres between the truth's samples
constexpr double kWide = kStep * kFine;
constexpr int kFineSide = kStep * kSide;

double truth(int r, int c) { return hills(r, c, 1, 6); }

// The truth's corner is (0, 0); rows run south.
std::unique_ptr<DemSource> fine_dem() {
  return dem_of(grid_from(kFineSide, kFineSide, truth), {0, kFine, 0, 0, 0, -kFine});
}

// Every kStep-th sample of the truth plus `errors`, said to lie `east` and `north` metres from where it does.
std::unique_ptr<DemSource> samples_of_truth(const std::function<double(int, int)>& errors, double east = 0,
                                            double north = 0) {
  const double corner = 0.5 * (kFine - kWide);
  return dem_of(
      grid_from(kSide, kSide, [&](int r, int c) { return truth(kStep * r, kStep * c) + errors(r, c); }),
      {corner + east, kWide, 0, -corner + north, 0, -kWide});
}

std::unique_ptr<DemSource> means_of_truth() {
  return dem_of(grid_from(kSide, kSide,
                          [](int r, int c) {
                            double sum = 0;
                            for (int i = 0; i < kStep * kStep; ++i)
                              sum += truth(kStep * r + i / kStep, kStep * c + i % kStep);
                            return sum / (kStep * kStep);
                          }),
                {0, kWide, 0, 0, 0, -kWide});
}

double no_error(int, int) { return 0; }

ErrorModel nothing_between() {
  ErrorModel model;
  model.geologic_variation = 0.0;
  model.vertical_rmse = 0.0;
  return model;
}

ErrorCheck with_points(const DemSource& dem, const std::vector<Xyz>& points,
                       const ErrorCheckOptions& options = {}) {
  Progress progress;
  return check_with_points(dem, nothing_between(), points, options, progress);
}

ErrorCheck with_reference(const DemSource& dem, const DemSource& reference,
                          const ErrorCheckOptions& options = {}) {
  Progress progress;
  return check_with_reference(dem, reference, options, progress);
}

std::optional<CellContent> seen(const DemSource& dem, const DemSource& reference) {
  Progress progress;
  return content_seen(dem, reference, progress);
}

// A tilted plane of 10 m cells, and points off its samples whose heights are wrong by known amounts.
struct Tilted {
  std::unique_ptr<DemSource> dem = dem_of(grid_from(20, 20, [](int r, int c) { return 50 + 3 * c - r; }));
  std::vector<Xyz> points;
  std::vector<double> errors;

  explicit Tilted(int count) {
    for (int i = 0; i < count; ++i) {
      const double col = 1 + 17 * noise(i, 0, 3), row = 1 + 17 * noise(i, 1, 3);
      errors.push_back(0.7 + 2 * noise(i, 2, 3));
      points.push_back({10 * (col + 0.5), -10 * (row + 0.5), 50 + 3 * col - row - errors.back()});
    }
  }
};

TEST(CheckWithPoints, FiguresArePlainArithmetic) {
  const Tilted tilted(51);
  const ErrorCheck found = with_points(*tilted.dem, tilted.points);
  std::vector<double> e = tilted.errors;
  std::sort(e.begin(), e.end());
  const double n = static_cast<double>(e.size()), mean = std::accumulate(e.begin(), e.end(), 0.0) / n;
  double squares = 0, about_mean = 0;
  for (const double one : e) squares += one * one, about_mean += (one - mean) * (one - mean);
  EXPECT_EQ(found.statistics.count, 51u);
  EXPECT_EQ(found.left_out, 0u);
  EXPECT_NEAR(found.statistics.mean, mean, 1e-5);
  EXPECT_NEAR(found.statistics.median, e[25], 1e-5);
  EXPECT_NEAR(found.statistics.rmse, std::sqrt(squares / n), 1e-5);
  EXPECT_NEAR(found.statistics.sd, std::sqrt(about_mean / (n - 1)), 1e-5);
}

TEST(CheckWithPoints, ASlopeThatLooksOneWayTellsNoShift) {
  const Tilted tilted(40);
  const ErrorCheck found = with_points(*tilted.dem, tilted.points);
  EXPECT_FALSE(found.shift);
  EXPECT_FALSE(found.corrected);
  EXPECT_TRUE(says(found.warnings.front(), "cannot be told"));
}

TEST(CheckWithPoints, WithoutAShiftTheBiasAloneIsTakenOff) {
  const Tilted tilted(41);
  ErrorCheckOptions options;
  const ErrorCheck as_it_is = with_points(*tilted.dem, tilted.points);
  options.correct_shift = true;
  const ErrorCheck corrected = with_points(*tilted.dem, tilted.points, options);
  EXPECT_TRUE(corrected.corrected);
  EXPECT_EQ(corrected.correction.x, 0);
  EXPECT_EQ(corrected.correction.z, as_it_is.statistics.median);
  EXPECT_EQ(as_it_is.correction.z, as_it_is.statistics.median);
  EXPECT_NEAR(corrected.statistics.median, 0, 1e-12);
  Tilted high(41);
  for (Xyz& point : high.points) point.z -= 45;
  EXPECT_TRUE(says(with_points(*high.dem, high.points, options).warnings.back(), "m higher than the truth"));
  options.correction = Correction{0, 0, 1};  // told by something else
  EXPECT_NEAR(with_points(*tilted.dem, tilted.points, options).statistics.median,
              as_it_is.statistics.median - 1, 1e-12);
}

TEST(CheckWithPoints, PlacesOutsideAndOnHolesAreLeftOutAndCounted) {
  Tilted tilted(30);
  Grid<float> heights = grid_from(20, 20, [](int r, int c) { return 50 + 3 * c - r; });
  heights.at(0, 0) = kNan;
  const auto holed = dem_of(std::move(heights));
  tilted.points.push_back({5, -5, 50});      // the hole
  tilted.points.push_back({-40, -100, 50});  // west of the DEM
  tilted.points.push_back({100, -1e9, 50});
  const ErrorCheck found = with_points(*holed, tilted.points);
  EXPECT_EQ(found.left_out, 3u);
  EXPECT_EQ(found.statistics.count, 30u);
}

TEST(CheckWithPoints, NoneAndTooFewAreRefused) {
  const Tilted tilted(9);
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { with_points(*tilted.dem, {}); }), "Only 0 places"));
  EXPECT_TRUE(
      says(complaint<InvalidInput>([&] { with_points(*tilted.dem, tilted.points); }), "Only 9 places"));
}

TEST(CheckWithReference, FindsTheShiftThatWasPutIn) {
  const auto shifted = samples_of_truth([](int, int) { return 2.0; }, -2 * kFine, kFine);
  const auto reference = fine_dem();
  ErrorCheckOptions options;
  const ErrorCheck found = with_reference(*shifted, *reference, options);
  ASSERT_TRUE(found.shift);
  EXPECT_NEAR(found.shift->x, -2 * kFine, 0.01);
  EXPECT_NEAR(found.shift->y, kFine, 0.01);
  EXPECT_NEAR(found.shift->z, 2, 0.01);
  EXPECT_TRUE(found.shift->is_significant());
  EXPECT_FALSE(found.corrected);
  EXPECT_TRUE(says(found.warnings.front(), "11.2 m sideways"));
  EXPECT_GT(found.statistics.nmad, 0.5);

  options.correct_shift = true;
  const ErrorCheck corrected = with_reference(*shifted, *reference, options);
  EXPECT_TRUE(corrected.corrected);
  EXPECT_NEAR(corrected.statistics.median, 0, 0.01);
  EXPECT_LT(corrected.statistics.nmad, 0.02);
}

TEST(CheckWithReference, CountsWhatIsMissingAndWhatIsLevelInBoth) {
  const auto flooded = [](int r, int c) { return c < kFineSide / 2 ? 0 : truth(r, c); };
  Grid<float> heights =
      grid_from(kSide, kSide, [&](int r, int c) { return flooded(kStep * r, kStep * c) + (2 * c >= kSide); });
  heights.at(30, 40) = kNan;
  const double corner = 0.5 * (kFine - kWide);
  const auto dem = dem_of(std::move(heights), {corner, kWide, 0, -corner, 0, -kWide});
  const auto reference = dem_of(grid_from(kFineSide, kFineSide, flooded), {0, kFine, 0, 0, 0, -kFine});
  const ErrorCheck found = with_reference(*dem, *reference);
  EXPECT_EQ(found.left_out, 1u);
  // Half of the samples are water; the slope of those on the shore and beside it is not 0.
  EXPECT_NEAR(static_cast<double>(found.equal_level), kSide * (kSide / 2 - 1), kSide);
  EXPECT_NEAR(found.statistics.median, 1, 1e-5);
}

TEST(CheckWithReference, OneElsewhereIsRefused) {
  const auto far = dem_of(grid_from(50, 50, truth), {1e6, 10, 0, 1e6, 0, -10});
  const auto dem = samples_of_truth(no_error);
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { with_reference(*dem, *far); }), "does not overlap"));
  const auto holes = dem_of(grid_from(kFineSide, kFineSide, [](int, int) { return double{kNan}; }),
                            {0, kFine, 0, 0, 0, -kFine});
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { with_reference(*dem, *holes); }), "Only 0 places"));
}

TEST(ErrorCheck, IsTheSameForAnyNumberOfThreads) {
  const auto dem = samples_of_truth([](int r, int c) { return noise(r, c, 9); });
  const auto reference = fine_dem();
  std::vector<Xyz> points;
  for (int i = 0; i < 300; ++i) {
    const int r = 8 + static_cast<int>(200 * noise(i, 0, 4)), c = 8 + static_cast<int>(200 * noise(i, 1, 4));
    points.push_back({kFine * (c + 0.5), -kFine * (r + 0.5), truth(r, c)});
  }
  const auto figures = [](const ErrorCheck& check) {
    std::vector<double> all = check.quantiles;
    const ResidualStatistics& s = check.statistics;
    all.insert(all.end(),
               {s.mean, s.median, s.rmse, s.nmad, s.le90, s.excess_kurtosis, check.at_flat, check.per_slope,
                check.ridge_bias, check.variogram.nugget, check.variogram.sill, check.variogram.length,
                check.shift->x, check.shift->y, check.shift->z, check.shift->se_x, check.shift->nmad_after});
    for (const LagBin& bin : check.variogram.bins) all.insert(all.end(), {bin.distance, bin.semivariance});
    return all;
  };
  ErrorCheckOptions one, three;
  one.threads = 1, three.threads = 3;
  EXPECT_EQ(figures(with_points(*dem, points, one)), figures(with_points(*dem, points, three)));
  EXPECT_EQ(figures(with_reference(*dem, *reference, one)), figures(with_reference(*dem, *reference, three)));
}

TEST(ErrorCheck, CanBeCancelledAndTellsItsProgress) {
  const auto dem = samples_of_truth(no_error);
  const auto reference = fine_dem();
  const Tilted tilted(40);
  const auto jobs = std::vector<std::function<void(Progress&)>>{
      [&](Progress& p) { check_with_points(*tilted.dem, nothing_between(), tilted.points, {}, p); },
      [&](Progress& p) { check_with_reference(*dem, *reference, {}, p); },
      [&](Progress& p) { content_seen(*dem, *reference, p); },
  };
  for (const auto& job : jobs) {
    Progress cancelled([](double) { return false; });
    EXPECT_THROW(job(cancelled), Cancelled);
    double last = -1;
    Progress told([&](double fraction) {
      EXPECT_GE(fraction, last);
      last = fraction;
      return true;
    });
    job(told);
    EXPECT_EQ(last, 1);
  }
}

TEST(ContentSeen, IsWhatTheDemWasMadeOf) {
  const auto reference = fine_dem();
  EXPECT_EQ(seen(*samples_of_truth(no_error), *reference), CellContent::kSamples);
  EXPECT_EQ(seen(*means_of_truth(), *reference), CellContent::kMeans);
}

TEST(ContentSeen, IsNotToldByCellsOfOneSize) {
  const auto reference = fine_dem();
  const auto same =
      dem_of(grid_from(kFineSide, kFineSide, [](int r, int c) { return truth(r, c) + noise(r, c, 5); }),
             {0, kFine, 0, 0, 0, -kFine});
  EXPECT_FALSE(seen(*same, *reference));
}

TEST(ContentSeen, IsNotToldOnFlatGround) {
  const auto level = [](int, int) { return 7.0; };
  const auto dem = dem_of(grid_from(30, 30, level), {0, 20, 0, 0, 0, -20});
  EXPECT_FALSE(seen(*dem, *dem_of(grid_from(120, 120, level), {0, 5, 0, 0, 0, -5})));
}

// Slopes are known at 5 x 5 of 7 x 7 samples, but only at 3 x 3 of the means over their cells, which reach
// half a cell farther: too few to fit anything to. That is no agreement.
TEST(ContentSeen, IsNotToldWhereOneOfTheTwoCannotBeCompared) {
  const auto dem = samples_of_truth([](int r, int c) { return 0.1 * noise(r, c, 9); });
  constexpr int kFirst = 20 * kStep, kCount = 6 * kStep + 1;
  const auto small =
      dem_of(grid_from(kCount, kCount, [](int r, int c) { return truth(kFirst + r, kFirst + c); }),
             {kFirst * kFine, kFine, 0, -kFirst * kFine, 0, -kFine});
  ErrorCheckOptions as_means;
  as_means.content = CellContent::kMeans;
  EXPECT_EQ(with_reference(*dem, *small).statistics.count, 49u);
  EXPECT_TRUE(with_reference(*dem, *small).shift);
  EXPECT_FALSE(with_reference(*dem, *small, as_means).shift);
  EXPECT_FALSE(seen(*dem, *small));
}

TEST(MapShift, RunsEastAndNorthWhateverTheRaster) {
  // Columns run north, rows east; said to lie 10 m west and 5 m north of where it does.
  const double corner = 0.5 * (kFine - kWide);
  const auto turned = dem_of(
      grid_from(kSide, kSide, [](int r, int c) { return truth(kStep * (kSide - 1 - c), kStep * r) + 3; }),
      {corner - 2 * kFine, 0, kWide, -kFine * kFineSide - corner + kFine, kWide, 0});
  const ErrorCheck found = with_reference(*turned, *fine_dem());
  ASSERT_TRUE(found.shift);
  const MapShift shift = on_map(*found.shift, *turned);
  EXPECT_NEAR(shift.east, -2 * kFine, 0.01);
  EXPECT_NEAR(shift.north, kFine, 0.01);
  EXPECT_NEAR(shift.up, 3, 0.01);

  HorizontalShift upright;
  upright.x = 3, upright.y = 4, upright.z = 5, upright.se_x = 0.3, upright.se_y = 0.4;
  const MapShift same = on_map(upright, *fine_dem());
  EXPECT_EQ((std::array{same.east, same.north, same.up, same.se_east, same.se_north}),
            (std::array{3.0, 4.0, 5.0, 0.3, 0.4}));
}

}  // namespace
}  // namespace sightbound
