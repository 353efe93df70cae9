// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "error_model/check_points.h"
#include "support/says.h"
#include "support/terrains.h"

namespace sightbound {
namespace {

using testing::noise;
using testing::says;

// Places with slopes from 0 to 1, whose errors are normal with sigma(slope).
std::vector<CheckedPlace> places_of(int n, const std::function<double(double)>& sigma, double between = 0) {
  std::vector<CheckedPlace> places;
  for (int i = 0; i < n; ++i) {
    CheckedPlace place;
    place.slope = (i + 0.5) / n;
    place.curvature = noise(i, 0, 2) - 0.5;
    place.between = between;
    place.error = sigma(place.slope) * one_sided_quantile(1e-6 + (1 - 2e-6) * noise(i, 0, 1), Tails::kNormal);
    places.push_back(place);
  }
  return places;
}

ErrorCheck judged(const std::vector<CheckedPlace>& places) {
  ErrorCheck check;
  judge(places, check);
  return check;
}

TEST(CheckPoints, GrowthWithSlopeIsKoppes) {
  const ErrorCheck found = judged(places_of(20000, [](double t) { return 0.4 + 1.5 * t; }));
  EXPECT_NEAR(found.at_flat, 0.4, 0.04);
  EXPECT_NEAR(found.per_slope, 1.5, 0.1);
  EXPECT_EQ(found.tails, Tails::kNormal);  // mixed sizes have heavy tails, but not in units of their sigma
  EXPECT_GT(found.slope.explained, 0.15);
  EXPECT_LT(found.curvature.explained, 0.01);
  EXPECT_EQ(found.slope.bins.size(), 10u);
  EXPECT_NEAR(found.quantiles[4], 1.96, 0.06);  // 95 %
}

TEST(CheckPoints, EqualErrorsHaveNoSlopePart) {
  const ErrorCheck found = judged(places_of(3000, [](double) { return 2.0; }));
  EXPECT_NEAR(found.at_flat, 2, 0.1);
  EXPECT_EQ(found.per_slope, 0);
}

TEST(CheckPoints, ErrorsOfSlopesAloneHaveNoneOnFlatGround) {
  const ErrorCheck found = judged(places_of(20000, [](double t) { return 3 * t; }));
  EXPECT_LT(found.at_flat, 0.1);
  EXPECT_NEAR(found.per_slope, 3, 0.2);
}

TEST(CheckPoints, WhatTheModelHasAlreadyIsTakenOff) {
  // Both parts together 1.3; 0.5 of it lies between the samples.
  const ErrorCheck found = judged(places_of(
      20000, [](double) { return 1.3; }, 0.5));
  EXPECT_NEAR(found.at_flat, 1.2, 0.04);
  EXPECT_DOUBLE_EQ(found.between, 0.5);
  const ErrorCheck nothing_left = judged(places_of(
      2000, [](double) { return 1.3; }, 2.0));
  EXPECT_EQ(nothing_left.at_flat, 0);
  EXPECT_TRUE(says(nothing_left.warnings.back(), "nothing is left"));
}

TEST(CheckPoints, RidgeBiasIsTheRiseOfTheTruthPerCurvature) {
  std::vector<CheckedPlace> places = places_of(500, [](double) { return 0.01; });
  for (CheckedPlace& place : places) place.error = 3 - 0.6 * place.curvature;
  EXPECT_NEAR(judged(places).ridge_bias, 0.6, 0.02);
}

TEST(CheckPoints, TooFewAreRefused) {
  try {
    judged(places_of(9, [](double) { return 1.0; }));
    FAIL();
  } catch (const InvalidInput& refused) {
    EXPECT_TRUE(says(refused.what(), "Only 9 places"));
    EXPECT_TRUE(says(refused.what(), "at least 10"));
  }
}

TEST(CheckPoints, PerfectOnesLeaveNoError) {
  const ErrorCheck found = judged(places_of(50, [](double) { return 0.0; }));
  EXPECT_EQ(found.at_flat, 0);
  EXPECT_EQ(found.statistics.median, 0);
  EXPECT_EQ(found.tails, Tails::kNormal);
}

TEST(WithCheck, FillsOnlyWhatNobodySaid) {
  ErrorCheck check = judged(places_of(2000, [](double) { return 1.0; }));
  check.variogram.sill = 1, check.variogram.length = 55;
  const ErrorModel learnt = with_check(ErrorModel(), check);
  EXPECT_EQ(std::get<double>(learnt.vertical_rmse), check.at_flat);
  EXPECT_EQ(learnt.tails, Tails::kNormal);
  EXPECT_EQ(learnt.correlation_length, 55);
  EXPECT_EQ(learnt.shared_bias, check.statistics.median);
  ErrorModel said;
  said.vertical_rmse = 0.2, said.tails = Tails::kLaplace, said.correlation_length = 3, said.shared_bias = -1;
  const ErrorModel kept = with_check(said, check);
  EXPECT_EQ(kept.to_json(), said.to_json());
}

TEST(WithCheck, FewPlacesSayNothingOfTails) {
  EXPECT_FALSE(with_check(ErrorModel(), judged(places_of(99, [](double) { return 1.0; }))).tails);
}

}  // namespace
}  // namespace sightbound
