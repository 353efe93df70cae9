// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "jobs/ground_raster.h"
#include "jobs/intervisibility_job.h"
#include "support/rolling_ground.h"
#include "support/says.h"
#include "support/terrains.h"

namespace sightbound {
namespace {

using testing::complaint;
using testing::dem_of;
using testing::grid_from;
using testing::kNan;
using testing::Lines;
using testing::noise;
using testing::says;

constexpr double kCell = 10, kSigma = 0.8, kDelta = 1.5, kRange = 4;

// A rolling ground with the same error everywhere.
testing::RandomDem ground() {
  testing::RandomDem dem = testing::rolling_dem(5);
  dem.cell_x = kCell, dem.cell_y = -kCell;
  dem.shape = GeologicShape::kGaussian, dem.range = kRange;
  std::fill(dem.sampling.begin(), dem.sampling.end(), static_cast<float>(kSigma));
  std::fill(dem.amplitude.begin(), dem.amplitude.end(), static_cast<float>(kDelta / kZ95));
  return dem;
}

ErrorModel model() {
  ErrorModel model;
  model.vertical_rmse = kSigma;
  model.geologic_variation = kDelta;
  model.geologic_range = kRange;
  return model;
}

class Intervisible : public ::testing::Test {
 protected:
  Intervisible() : source_(dem_of(heights())) { options_.curvature = false; }

  Grid<float> heights() const {
    return grid_from(dem_.rows, dem_.cols,
                     [&](int r, int c) { return dem_.height[static_cast<std::size_t>(r * dem_.cols + c)]; });
  }
  // Places on the samples' lattice and off it.
  std::vector<Station> stations(int count, std::uint64_t seed) const {
    std::vector<Station> all;
    for (int i = 0; i < count; ++i) {
      const double col = 1 + (dem_.cols - 3) * noise(i, 0, seed),
                   row = 1 + (dem_.rows - 3) * noise(i, 1, seed);
      all.push_back({kCell * (col + 0.5), -kCell * (row + 0.5), 1 + 6 * noise(i, 2, seed)});
    }
    return all;
  }
  Intervisibility run(const std::vector<Station>& a, const std::vector<Station>& b = {}) const {
    Progress progress;
    return run_intervisibility(*source_, a, b, model(), options_, extras_, reach_, progress);
  }

  testing::RandomDem dem_ = ground();
  std::unique_ptr<DemSource> source_;
  ViewshedOptions options_;
  LineExtras extras_;
  StationOptions reach_;
};

TEST_F(Intervisible, EveryPairIsItsSightLineAlone) {
  const std::vector<Station> points = stations(14, 1);
  const Grid<float> terrain = heights();
  const auto place = [](const Station& s) { return Xy{s.x / kCell - 0.5, -s.y / kCell - 0.5}; };
  const Intervisibility found = run(points);
  ASSERT_EQ(found.pairs.size(), 91u);
  std::size_t next = 0;
  int settled = 0;
  for (std::size_t from = 0; from < points.size(); ++from) {
    for (std::size_t to = from + 1; to < points.size(); ++to) {
      const JudgedPair& pair = found.pairs[next++];
      ASSERT_EQ(std::make_pair(pair.from, pair.to), std::make_pair(from, to));
      const Xy eye = place(points[from]), target = place(points[to]);
      const Lines lines(dem_, eye.x, eye.y, interpolate(terrain, eye.x, eye.y) + points[from].height, false);
      const double k =
          lines.ratio(target.x, target.y, interpolate(terrain, target.x, target.y) + points[to].height);
      EXPECT_EQ(pair.status, PairStatus::kJudged);
      EXPECT_NEAR(pair.sight.k, k, 1e-9);
      EXPECT_NEAR(pair.sight.p, 0.5 * std::erfc(-k / std::sqrt(2.0)), 2e-3);
      EXPECT_EQ(pair.sight.verdict, k >= kZ95 ? kVisible : k <= -kZ95 ? kHidden : kUncertain);
      EXPECT_NEAR(pair.sight.distance, kCell * std::hypot(target.x - eye.x, target.y - eye.y), 1e-6);
      settled += std::abs(k) < 3;
    }
  }
  EXPECT_GT(settled, 5);  // or nothing was tested
}

// A wall 20 m high on level ground, in the middle between two masts.
TEST_F(Intervisible, AWallIsClearedByTheHeightAboveItInSigmas) {
  const auto walled = dem_of(grid_from(11, 21, [](int, int c) { return c == 10 ? 20.0 : 0.0; }));
  ErrorModel exact;
  exact.vertical_rmse = 2.0;
  exact.geologic_variation = 0.0;
  const auto mast = [](double col, double height) { return Station{kCell * (col + 0.5), -55, height}; };
  for (const auto& [left, right] : {std::pair{20.0, 25.0}, {24.0, 24.0}, {16.0, 20.0}}) {
    Progress progress;
    const Intervisibility found = run_intervisibility(*walled, {mast(5, left)}, {mast(15, right)}, exact,
                                                      options_, extras_, reach_, progress);
    ASSERT_EQ(found.pairs.size(), 1u);
    const LineOfSight& sight = found.pairs[0].sight;
    const double above = 0.5 * (left + right) - 20;
    EXPECT_NEAR(sight.k, above / 2, 1e-6);
    EXPECT_NEAR(sight.critical_clearance, above, 1e-6);
    EXPECT_NEAR(sight.critical_distance, 50, 1e-6);
    EXPECT_NEAR(sight.azimuth, 90, 1e-6);
  }
}

TEST_F(Intervisible, TwoListsAreEachWithEachAndTheWayBackTheSame) {
  const std::vector<Station> a = stations(3, 2), b = stations(4, 3);
  const Intervisibility there = run(a, b), back = run(b, a);
  EXPECT_EQ(there.points_a, 3u);
  EXPECT_EQ(there.points_b, 4u);
  ASSERT_EQ(there.pairs.size(), 12u);
  for (const JudgedPair& pair : there.pairs) {
    const JudgedPair& reversed = back.pairs[pair.to * 3 + pair.from];
    EXPECT_NEAR(pair.sight.k, reversed.sight.k, 1e-6);
    EXPECT_EQ(pair.sight.verdict, reversed.sight.verdict);
  }
}

TEST_F(Intervisible, EmptyListsAndSinglePointsArePairsOfNone) {
  EXPECT_TRUE(run({}).pairs.empty());
  EXPECT_TRUE(run({}, stations(3, 4)).pairs.empty());
  EXPECT_TRUE(run(stations(1, 4)).pairs.empty());
  const Station twice = stations(1, 4)[0];
  EXPECT_TRUE(run({twice, twice}).pairs.empty());  // one place is no pair
}

TEST_F(Intervisible, PointsOutsideAndOnHolesAreToldNotRefused) {
  Grid<float> holed = heights();
  for (int r = 8; r < 13; ++r) {
    for (int c = 8; c < 13; ++c) holed.at(r, c) = kNan;
  }
  source_ = dem_of(std::move(holed));
  const Station good{25, -25, 2}, other{245, -205, 2}, hole{105, -105, 2}, outside{-500, 20, 2};
  const Intervisibility found = run({good, hole, outside, other});
  std::vector<PairStatus> told;
  for (const JudgedPair& pair : found.pairs) told.push_back(pair.status);
  using enum PairStatus;
  EXPECT_EQ(told, (std::vector{kNodata, kOutside, kJudged, kOutside, kNodata, kOutside}));
  EXPECT_EQ(found.pairs[0].sight.verdict, kNoVerdict);
  EXPECT_EQ(name_of(kNodata) + name_of(kOutside) + name_of(kJudged), "nodataoutsideok");
  // Without one line to judge the terrain is not even read.
  EXPECT_EQ(run({outside, outside}).pairs.at(0).status, kOutside);
}

TEST_F(Intervisible, FartherPairsAreLeftOutAndCounted) {
  const std::vector<Station> points = stations(12, 6);
  const Intervisibility all = run(points);
  reach_.max_distance = 100;
  const Intervisibility near = run(points);
  std::size_t within = 0;
  for (const JudgedPair& pair : all.pairs) {
    if (pair.sight.distance > 100) continue;
    const JudgedPair& kept = near.pairs.at(within++);
    EXPECT_EQ(std::make_pair(kept.from, kept.to), std::make_pair(pair.from, pair.to));
    EXPECT_EQ(kept.sight.k, pair.sight.k);  // whatever window was read
  }
  EXPECT_EQ(near.pairs.size(), within);
  EXPECT_EQ(near.too_far, all.pairs.size() - within);
  EXPECT_GT(within, 0u);
}

TEST_F(Intervisible, AreTheSameForAnyNumberOfThreads) {
  const std::vector<Station> points = stations(20, 7);
  extras_.whole_line = WholeLineOptions{40, 3, Stand::kGround};
  extras_.radio = RadioOptions{900, 0.6};
  const auto figures = [&](int threads) {
    options_.threads = threads;
    std::vector<double> all;
    for (const JudgedPair& pair : run(points).pairs) {
      const LineOfSight& s = pair.sight;
      all.insert(all.end(), {s.p, s.k, s.distance, s.azimuth, s.critical_x, s.critical_clearance,
                             s.whole_line->probability, s.whole_line->blocked_bound, s.fresnel->k});
    }
    return all;
  };
  const std::vector<double> one = figures(1), three = figures(3);
  ASSERT_EQ(one.size(), three.size());
  EXPECT_EQ(std::memcmp(one.data(), three.data(), one.size() * sizeof(double)), 0);
}

TEST_F(Intervisible, CanBeCancelledAndTellTheirProgress) {
  const std::vector<Station> points = stations(10, 8);
  Progress cancelled([](double) { return false; });
  EXPECT_THROW(run_intervisibility(*source_, points, {}, model(), options_, extras_, reach_, cancelled),
               Cancelled);
  double last = -1;
  Progress told([&](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
    return true;
  });
  run_intervisibility(*source_, points, {}, model(), options_, extras_, reach_, told);
  EXPECT_EQ(last, 1);
}

TEST_F(Intervisible, RefuseWhatCannotBe) {
  const std::vector<Station> points = stations(3, 9);
  reach_.max_distance = 0;
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { run(points); }), "max_distance is 0"));
  reach_ = {};
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { run({points[0], {kNan, 0, 1}}); }), "Point 2 of points_a"));
  options_.memory_budget = 1000;
  EXPECT_TRUE(says(complaint<OverBudget>([&] { run(points); }), "smaller max_distance"));
}

}  // namespace
}  // namespace sightbound
