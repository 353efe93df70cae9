// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "base/error.h"
#include "jobs/error_surfaces_job.h"
#include "support/says.h"
#include "support/terrains.h"

namespace sightbound {
namespace {

using testing::copy_of;
using testing::dem_of;
using testing::grid_from;
using testing::hills;
using testing::kNan;
using testing::says;

Grid<float> terrain() {
  return grid_from(50, 40,
                   [](int r, int c) { return r == 7 && c == 9 ? double(kNan) : 100 + hills(r, c, 1, 6); });
}

ErrorSurfaces surfaces(const DemSource& dem, const ErrorModel& model,
                       const ErrorSurfacesOptions& options = {}) {
  Progress progress;
  return run_error_surfaces(dem, model, options, progress);
}

ErrorModel given() {
  ErrorModel model;
  model.vertical_rmse = 0.5;
  model.geologic_variation = 2.0;
  model.geologic_range = 8;
  return model;
}

TEST(ErrorSurfaces, AreTheSumAtTheCellsCorner) {
  const auto dem = dem_of(terrain());
  const ErrorSurfaces out = surfaces(*dem, given());
  const double d = std::hypot(5, 5);  // cells of 10 m
  const double sigma = 0.5 + 2 / kZ95 * (1 - std::exp(-0.5 * d * d / 64));
  EXPECT_NEAR(out.sigma.at(20, 20), sigma, 1e-6);
  const double z = terrain().at(20, 20);
  EXPECT_NEAR(out.lower.at(20, 20), z - kZ95 * sigma, 1e-4);
  EXPECT_NEAR(out.upper.at(20, 20), z + kZ95 * sigma, 1e-4);
}

TEST(ErrorSurfaces, RoundOutward) {
  const auto dem = dem_of(terrain());
  const ErrorSurfaces out = surfaces(*dem, given());
  const Grid<float> heights = terrain();
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double z = heights.values()[i], sigma = 0.5f + static_cast<double>(static_cast<float>(2 / kZ95)) *
                                                             (1 - std::exp(-0.5 * 50 / 64));
    if (std::isnan(z)) continue;
    EXPECT_GE(out.sigma.values()[i], sigma * (1 - 1e-15));
    EXPECT_LE(out.lower.values()[i], (z - kZ95 * sigma) * (1 + 1e-15));
    EXPECT_GE(out.upper.values()[i], (z + kZ95 * sigma) * (1 - 1e-15));
  }
}

TEST(ErrorSurfaces, NodataStaysNodata) {
  const ErrorSurfaces out = surfaces(*dem_of(terrain()), given());
  for (const Grid<float>* grid : {&out.sigma, &out.lower, &out.upper}) {
    EXPECT_TRUE(std::isnan(grid->at(7, 9)));
    EXPECT_FALSE(std::isnan(grid->at(7, 10)));
  }
}

TEST(ErrorSurfaces, HaveAtLeastAMillimetre) {
  ErrorModel none;
  none.vertical_rmse = 0.0;
  none.geologic_variation = 0.0;
  const ErrorSurfaces out = surfaces(*dem_of(terrain()), none);
  EXPECT_FLOAT_EQ(out.sigma.at(3, 3), 0.001f);
  EXPECT_LT(out.lower.at(3, 3), out.upper.at(3, 3));
}

TEST(ErrorSurfaces, GrowWithConfidence) {
  const auto dem = dem_of(terrain());
  ErrorSurfacesOptions options;
  options.confidence = 0.99;
  const ErrorSurfaces wide = surfaces(*dem, given(), options), usual = surfaces(*dem, given());
  EXPECT_LT(wide.lower.at(3, 3), usual.lower.at(3, 3));
  EXPECT_EQ(wide.sigma.at(3, 3), usual.sigma.at(3, 3));
}

TEST(ErrorSurfaces, ComeInTheUsersRowOrder) {
  const ErrorSurfaces north = surfaces(*dem_of(terrain(), {0, 10, 0, 500, 0, -10}), ErrorModel());
  Grid<float> upside_down = terrain();
  upside_down.flip_rows();
  ErrorSurfaces south = surfaces(*dem_of(std::move(upside_down), {0, 10, 0, 0, 0, 10}), ErrorModel());
  EXPECT_EQ(south.geotransform.coefficients(), (std::array<double, 6>{0, 10, 0, 0, 0, 10}));
  south.sigma.flip_rows();
  EXPECT_EQ(std::memcmp(south.sigma.data(), north.sigma.data(), north.sigma.size() * sizeof(float)), 0);
}

TEST(ErrorSurfaces, OfAnExtentAreThoseOfTheWhole) {
  const auto dem = dem_of(terrain());
  ErrorSurfacesOptions options;
  options.extent = Extent{100, -300, 250, -120};
  options.threads = 3;
  const ErrorSurfaces part = surfaces(*dem, ErrorModel(), options), whole = surfaces(*dem, ErrorModel());
  ASSERT_EQ(part.sigma.cols(), 15);
  ASSERT_EQ(part.sigma.rows(), 18);
  const Grid<float> expected = testing::part_of(whole.upper, {10, 12, 15, 18});
  EXPECT_EQ(std::memcmp(part.upper.data(), expected.data(), expected.size() * sizeof(float)), 0);
  EXPECT_DOUBLE_EQ(part.geotransform.coefficients()[0], 100);
  EXPECT_DOUBLE_EQ(part.geotransform.coefficients()[3], -120);
}

TEST(ErrorSurfaces, SayWhatWasUsed) {
  const ErrorSurfaces out = surfaces(*dem_of(terrain()), ErrorModel());
  const ErrorModel used = ErrorModel::from_json(out.error_model);
  EXPECT_FALSE(used.needs_estimate());
  EXPECT_GT(*used.typical_m, 0);
}

TEST(ErrorSurfaces, KeepTheirMemoryBudget) {
  const auto dem = dem_of(terrain());
  ErrorSurfacesOptions options;
  options.memory_budget = 1000;
  try {
    surfaces(*dem, given(), options);
    FAIL();
  } catch (const OverBudget& error) {
    EXPECT_TRUE(says(error.what(), "smaller extent"));
  }
  options.memory_budget = surfaces(*dem, given()).memory_bytes;
  EXPECT_NO_THROW(surfaces(*dem, given(), options));
}

TEST(ErrorSurfaces, CanBeCancelledAndTellTheirProgress) {
  const auto dem = dem_of(terrain());
  Progress cancelled([](double) { return false; });
  EXPECT_THROW(run_error_surfaces(*dem, given(), {}, cancelled), Cancelled);
  double last = -1;
  Progress told([&](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
    return true;
  });
  run_error_surfaces(*dem, given(), {}, told);
  EXPECT_EQ(last, 1);
}

TEST(ErrorSurfaces, RefuseWhatIsNoConfidence) {
  ErrorSurfacesOptions options;
  options.confidence = 95;
  EXPECT_THROW(surfaces(*dem_of(terrain()), given(), options), InvalidInput);
}

}  // namespace
}  // namespace sightbound
