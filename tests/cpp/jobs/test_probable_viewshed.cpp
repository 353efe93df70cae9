// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "error_model/verdict.h"
#include "jobs/probable_viewshed_job.h"
#include "support/says.h"
#include "support/terrains.h"

namespace sightbound {
namespace {

using namespace testing;

ErrorModel no_error() {
  ErrorModel model;
  model.vertical_rmse = 0.0;
  model.geologic_variation = 0.0;
  return model;
}

// Samples of 10 m, at (5 + 10 c, 1000 - 5 - 10 r).
class Dem {
 public:
  template <class F>
  Dem(int rows, int cols, const F& height)
      : heights_(static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols)),
        dem_({heights_.data(), rows, cols, std::numeric_limits<double>::quiet_NaN(), 1, nullptr},
             Geotransform({0, 10, 0, 1000, 0, -10}), "") {
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < cols; ++c)
        heights_[static_cast<std::size_t>(r) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(c)] =
            static_cast<float>(height(r, c));
    }
  }
  const DemSource& source() const { return dem_; }
  ProbableViewshed seen(const Observer& observer, const ErrorModel& model,
                        const ProbableOptions& options = {}) const {
    Progress progress;
    return run_probable_viewshed(dem_, {observer}, model, options, progress);
  }

 private:
  std::vector<float> heights_;
  ArrayDem dem_;
};

Observer at(int row, int col, double height = 1.7, double target = 1.7) {
  Observer o;
  o.x = 5 + 10 * col, o.y = 995 - 10 * row, o.height = height, o.target_height = target;
  return o;
}

ProbableOptions flat(int realisations) {
  ProbableOptions options;
  options.curvature = false;
  options.realisations = realisations;
  return options;
}

TEST(ProbableViewshed, WithoutErrorItIsTheViewshed) {
  const Dem dem(90, 110, [](int r, int c) { return 3 * hills(r, c, 0.7, 5); });
  for (const Observer& observer : {at(40, 50), at(3, 100, 10, 0), at(89, 0, 1.7, 5)}) {
    const ProbableViewshed made = dem.seen(observer, no_error(), flat(1));
    Progress progress;
    ViewshedOptions options;
    options.curvature = false;
    const ViewshedResult exact = run_viewshed(dem.source(), {observer}, no_error(), options, progress);
    std::size_t differ = 0;
    for (std::size_t n = 0; n < made.probability.size(); ++n) {
      const float p = made.probability.data()[n];
      EXPECT_TRUE(p == 0 || p == 1);
      differ += (p > 0.5) != (exact.confidence.data()[n] > 0.5) ? 1 : 0;
    }
    EXPECT_LT(static_cast<double>(differ), 0.02 * static_cast<double>(made.probability.size()));
  }
}

TEST(ProbableViewshed, EveryCellIsAsked) {
  const Dem plain(37, 52, [](int, int) { return 12; });
  for (Observer observer : {at(18, 20), at(0, 0), at(36, 51), at(0, 30)}) {
    for (const double shift : {0.0, 3.3}) {
      if (observer.x + shift < 515) observer.x += shift;
      const ProbableViewshed made = plain.seen(observer, no_error(), flat(20));
      for (const float p : made.probability.values()) EXPECT_EQ(p, 1);
      for (const float e : made.standard_error.values()) EXPECT_EQ(e, 0);
    }
  }
}

// One doubtful sample in the way: it hides the target where it stands higher than the line between two heads.
TEST(ProbableViewshed, OneDoubtfulSampleHidesAsOftenAsItIsHigher) {
  const Dem plain(21, 41, [](int, int) { return 0; });
  auto sigma = Grid<float>(21, 41, 0);
  sigma.at(10, 20) = 4;
  ErrorModel model = no_error();
  model.vertical_rmse = std::make_shared<const Grid<float>>(std::move(sigma));
  // The posterior's share of it: four neighbours that are as doubtful say a quarter of the variance.
  const double spread = 4 * std::sqrt(0.25 / 1.25), expected = normal_cdf(1.7 / spread);
  constexpr int kRealisations = 8000;
  ProbableOptions options = flat(kRealisations);
  options.precision = 0;
  const ProbableViewshed made = plain.seen(at(10, 5), model, options);
  const double error = std::sqrt(expected * (1 - expected) / kRealisations);
  EXPECT_NEAR(made.probability.at(10, 35), expected, 4 * error);
  EXPECT_NEAR(made.standard_error.at(10, 35), error, 0.1 * error);
  EXPECT_EQ(made.probability.at(3, 35), 1);
  EXPECT_EQ(made.verdict.at(10, 35), kUncertain);
  EXPECT_EQ(made.verdict.at(3, 35), kVisible);
}

// A share of 0 or of all is no certainty when there are few, but for what no draw changes.
TEST(ProbableViewshed, ClaimsNeedEnoughRealisations) {
  const Dem walls(41, 41, [](int r, int c) { return c == 20 ? (r < 20 ? 14 : 800) : 0; });
  ErrorModel model = no_error();
  auto sigma = Grid<float>(41, 41, 0);
  for (int r = 0; r < 41; ++r) sigma.at(r, 20) = 3;
  model.vertical_rmse = std::make_shared<const Grid<float>>(std::move(sigma));
  const ProbableViewshed few = walls.seen(at(10, 5), model, flat(32)),
                         many = walls.seen(at(10, 5), model, flat(400));
  EXPECT_EQ(few.probability.at(10, 35), 0);
  EXPECT_EQ(few.verdict.at(10, 35), kUncertain);  // Wilson's upper end for 0 of 32 is 0.11
  EXPECT_EQ(many.verdict.at(10, 35), kHidden);
  EXPECT_EQ(many.realisations.at(10, 35), 192);  // the first look
  EXPECT_EQ(few.verdict.at(35, 35), kHidden);
  EXPECT_EQ(few.realisations.at(35, 35), 32);
  EXPECT_EQ(few.verdict.at(10, 8), kVisible);
}

bool same(const Grid<float>& a, const Grid<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

TEST(ProbableViewshed, D1SameBytesForAnyThreadsAndExtent) {
  const Dem dem(120, 140, [](int r, int c) { return 5 * hills(r, c, 0.7, 5); });
  ErrorModel model;  // learnt
  model.vertical_rmse = 0.5;
  ProbableOptions options;
  options.realisations = 40;
  options.threads = 1;
  const ProbableViewshed one = dem.seen(at(60, 70), model, options);
  options.threads = 2;
  EXPECT_TRUE(same(one.probability, dem.seen(at(60, 70), model, options).probability));
  options.extent = Extent{900, 300, 1300, 650};
  const ProbableViewshed part = dem.seen(at(60, 70), model, options);
  ASSERT_EQ(part.probability.rows(), 35);
  for (int r = 0; r < 35; ++r) {
    for (int c = 0; c < 40; ++c)
      EXPECT_EQ(part.probability.at(r, c), one.probability.at(35 + r, 90 + c)) << r << " " << c;
  }
  options.extent.reset();
  options.seed = 2;
  EXPECT_FALSE(same(one.probability, dem.seen(at(60, 70), model, options).probability));
}

// What a mean leaves open at its own place is no measurement's error: nothing of it is added to the DEM.
TEST(ProbableViewshed, PerturbingADemOfMeansAddsMeasurementErrorAlone) {
  const Dem dem(60, 70, [](int r, int c) { return 5 * hills(r, c, 0.7, 5); });
  ProbableOptions options = flat(48);
  options.method = Terrains::kPerturb;
  ErrorModel means, samples;  // learnt
  means.samples_or_means = CellContent::kMeans, samples.samples_or_means = CellContent::kSamples;
  means.tails = samples.tails = Tails::kNormal;
  const ProbableViewshed nothing = dem.seen(at(30, 30), means, options);
  for (const float p : nothing.probability.values()) EXPECT_TRUE(p == 0 || p == 1);
  EXPECT_TRUE(says(nothing.report.warnings.back(), "holds no measurement error"));
  means.vertical_rmse = samples.vertical_rmse = 0.5;
  const ProbableViewshed of_means = dem.seen(at(30, 30), means, options);
  EXPECT_TRUE(same(of_means.probability, dem.seen(at(30, 30), samples, options).probability));
  EXPECT_FALSE(same(of_means.probability, nothing.probability));
  EXPECT_TRUE(says(of_means.report.error_model, "means"));
}

TEST(ProbableViewshed, SeveralObserversSeeMore) {
  const Dem dem(60, 60, [](int r, int c) { return 5 * hills(r, c, 0.7, 9); });
  Progress progress;
  const ProbableOptions options = flat(64);
  const auto look = [&](const std::vector<Observer>& who) {
    return run_probable_viewshed(dem.source(), who, ErrorModel(), options, progress);
  };
  const ProbableViewshed a = look({at(10, 10)}), b = look({at(50, 40)}),
                         both = look({at(10, 10), at(50, 40)});
  for (std::size_t n = 0; n < a.probability.size(); ++n) {
    const float p = a.probability.data()[n], q = b.probability.data()[n], either = both.probability.data()[n];
    EXPECT_GE(either, std::max(p, q));
    EXPECT_LE(either, p + q + 1e-6f);
  }
}

TEST(ProbableViewshed, LimitsAndHoles) {
  const Dem dem(40, 60, [](int r, int c) { return c == 30 && r > 10 ? kNan : 0.0f; });
  Observer observer = at(30, 10);
  observer.max_distance = 300, observer.azimuth_from = 45, observer.azimuth_to = 135;
  const ProbableViewshed made = dem.seen(observer, no_error(), flat(100));
  const auto in_result = [&](int row, int col) {
    const double x = 5 + 10 * col, y = 995 - 10 * row;
    const Xy place = made.geotransform.to_raster(x, y);
    return made.probability.at(static_cast<int>(std::lround(place.y)),
                               static_cast<int>(std::lround(place.x)));
  };
  EXPECT_EQ(in_result(30, 20), 1);
  EXPECT_NEAR(in_result(30, 35), 0.5, 0.15);  // behind the hole: the coin
  EXPECT_TRUE(std::isnan(in_result(30, 30)));
  EXPECT_TRUE(std::isnan(in_result(30, 5)));  // to the west
  EXPECT_TRUE(std::isnan(in_result(5, 10)));
}

// What known ground hides is hidden, before the hole or behind it; the rest is not known.
TEST(ProbableViewshed, HolesClaimNothing) {
  const Dem dem(41, 81, [](int r, int c) {
    return c == 30 && r > 10 ? kNan : c == 20 && r < 18 ? 40.0f : c == 50 && r > 30 ? 40.0f : 0.0f;
  });
  const ProbableViewshed made = dem.seen(at(20, 5), no_error(), flat(1000));
  EXPECT_EQ(made.verdict.at(20, 28), kVisible);
  EXPECT_EQ(made.verdict.at(20, 60), kUncertain);
  EXPECT_NEAR(made.probability.at(20, 60), 0.5, 0.06);
  EXPECT_EQ(made.verdict.at(8, 60), kHidden);   // by the wall before the hole
  EXPECT_EQ(made.verdict.at(39, 70), kHidden);  // by the wall behind it
  EXPECT_TRUE(std::isnan(made.probability.at(20, 30)));
}

TEST(ProbableViewshed, SaysWhatIsWrong) {
  const Dem dem(20, 20, [](int, int c) { return c == 3 ? kNan : 0.0f; });
  EXPECT_TRUE(
      says(complaint<InvalidInput>([&] { dem.seen(at(5, 5), no_error(), flat(0)); }), "realisations"));
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { dem.seen(at(5, 3), no_error(), flat(8)); }), "nodata"));
  EXPECT_THROW(dem.seen(at(5, 50), no_error(), flat(8)), InvalidInput);
  ProbableOptions options = flat(8);
  options.memory_budget = 1000;
  EXPECT_THROW(dem.seen(at(5, 5), no_error(), options), OverBudget);
  Progress progress([](double) { return false; });
  EXPECT_THROW(run_probable_viewshed(dem.source(), {at(5, 5)}, no_error(), flat(8), progress), Cancelled);
}

}  // namespace
}  // namespace sightbound
