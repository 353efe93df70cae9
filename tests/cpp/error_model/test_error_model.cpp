// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "base/error.h"
#include "error_model/error_model.h"
#include "support/says.h"

namespace sightbound {
namespace {

using testing::says;

ErrorModel given() {
  ErrorModel model;
  model.vertical_rmse = 1.0;
  model.geologic_variation = 0.5;
  return model;
}

// What validate() says of a model changed by `change`; empty when it is content.
std::string complaint(const std::function<void(ErrorModel&)>& change) {
  ErrorModel model = given();
  change(model);
  try {
    model.validate();
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(ErrorModel, DefaultIsToBeLearnt) {
  const ErrorModel model;
  EXPECT_NO_THROW(model.validate());
  EXPECT_TRUE(model.needs_estimate());
}

TEST(ErrorModel, ZeroIsMeant) {
  ErrorModel model;
  model.vertical_rmse = 0.0;
  model.geologic_variation = 0.0;
  EXPECT_NO_THROW(model.validate());
  EXPECT_FALSE(model.needs_estimate());
}

TEST(ErrorModel, EitherPartMayBeLeftToTheDem) {
  ErrorModel model = given();
  model.vertical_rmse = FromDem{};
  EXPECT_TRUE(model.needs_estimate());
  model = given();
  model.geologic_variation = FromDem{};
  EXPECT_TRUE(model.needs_estimate());
  model.growth_exponent = 1;
  EXPECT_TRUE(model.needs_estimate());
  model.typical_m = 0.3;
  EXPECT_FALSE(model.needs_estimate());
}

TEST(ErrorModel, NumbersOutOfRangeNameFieldValueAndRange) {
  EXPECT_TRUE(says(complaint([](ErrorModel& m) { m.vertical_rmse = -1.0; }),
                   "vertical_rmse is -1; allowed are 0 to 10000 m"));
  EXPECT_TRUE(says(complaint([](ErrorModel& m) { m.vertical_rmse = 10000.5; }), "vertical_rmse is 10000.5"));
  EXPECT_TRUE(says(complaint([](ErrorModel& m) { m.vertical_rmse = std::nan(""); }), "vertical_rmse is nan"));
  EXPECT_TRUE(
      says(complaint([](ErrorModel& m) { m.horizontal_rmse = std::numeric_limits<double>::infinity(); }),
           "horizontal_rmse is inf"));
  EXPECT_TRUE(
      says(complaint([](ErrorModel& m) { m.geologic_variation = 1e9; }), "geologic_variation is 1000000000"));
  EXPECT_TRUE(says(complaint([](ErrorModel& m) { m.geologic_range = 0; }), "geologic_range is 0"));
  EXPECT_EQ(complaint([](ErrorModel& m) { m.vertical_rmse = 10000.0; }), "");
}

TEST(ErrorModel, TheNatureOfErrorsHasRanges) {
  EXPECT_TRUE(says(complaint([](ErrorModel& m) { m.correlation_length = -1; }),
                   "correlation_length is -1; allowed are 0 to 1000000 m"));
  EXPECT_TRUE(says(complaint([](ErrorModel& m) { m.shared_bias = -10001; }), "shared_bias is -10001"));
  EXPECT_TRUE(says(complaint([](ErrorModel& m) { m.shared_bias = std::nan(""); }), "shared_bias is nan"));
  EXPECT_TRUE(
      says(complaint([](ErrorModel& m) { m.ridge_gain = 2.5; }), "ridge_gain is 2.5; allowed are -2 to 2"));
  EXPECT_EQ(complaint([](ErrorModel& m) {
              m.correlation_length = 30;
              m.shared_bias = -4;
              m.ridge_gain = -0.1;
              m.tails = Tails::kStudent;
              m.samples_or_means = CellContent::kMeans;
            }),
            "");
  EXPECT_EQ(ErrorModel().tails_used(), Tails::kNormal);
}

TEST(ErrorModel, StepNeedsARange) {
  EXPECT_TRUE(
      says(complaint([](ErrorModel& m) { m.geologic_shape = GeologicShape::kStep; }), "geologic_range"));
  EXPECT_EQ(complaint([](ErrorModel& m) {
              m.geologic_shape = GeologicShape::kStep;
              m.geologic_range = 5;
            }),
            "");
}

TEST(ErrorModel, GrowthNeedsAnExponentAndNoRange) {
  EXPECT_TRUE(
      says(complaint([](ErrorModel& m) { m.geologic_shape = GeologicShape::kGrowth; }), "growth_exponent"));
  const auto growth = [](ErrorModel& m) {
    m.geologic_shape = GeologicShape::kGrowth;
    m.growth_exponent = 1.2;
  };
  EXPECT_EQ(complaint(growth), "");
  EXPECT_TRUE(says(complaint([&](ErrorModel& m) {
                     growth(m);
                     m.geologic_range = 3;
                   }),
                   "geologic_range"));
  EXPECT_TRUE(says(complaint([](ErrorModel& m) { m.growth_exponent = 1.2; }), "choose 'growth'"));
  EXPECT_TRUE(says(complaint([&](ErrorModel& m) {
                     growth(m);
                     m.growth_exponent = 3;
                   }),
                   "0.1 to 2"));
}

TEST(ErrorModel, AnEstimateTakesNeitherRangeNorStep) {
  EXPECT_TRUE(says(complaint([](ErrorModel& m) {
                     m.geologic_variation = FromDem{};
                     m.geologic_range = 20;
                   }),
                   "Give geologic_variation too"));
  EXPECT_TRUE(says(complaint([](ErrorModel& m) {
                     m.geologic_variation = FromDem{};
                     m.geologic_shape = GeologicShape::kStep;
                   }),
                   "Give geologic_variation"));
}

TEST(ErrorModel, RastersArraysAndPolygonsAreChecked) {
  EXPECT_TRUE(says(complaint([](ErrorModel& m) { m.vertical_rmse = RasterFile{}; }), "without a path"));
  EXPECT_TRUE(says(complaint([](ErrorModel& m) {
                     m.vertical_rmse = RasterFile{"a.tif", 0};
                   }),
                   "bands count from 1"));
  EXPECT_TRUE(says(complaint([](ErrorModel& m) { m.geologic_variation = SharedGrid{}; }), "empty array"));
  EXPECT_TRUE(
      says(complaint([](ErrorModel& m) { m.terrain_types = TerrainTypes{}; }), "terrain_types has no path"));
  EXPECT_TRUE(says(complaint([](ErrorModel& m) {
                     m.terrain_types = TerrainTypes{"a.gpkg", "", "", {}};
                   }),
                   "terrain_field is missing"));
  EXPECT_TRUE(says(complaint([](ErrorModel& m) {
                     m.terrain_types = TerrainTypes{"a.gpkg", "", "kind", {{"mud", -1}}};
                   }),
                   "terrain_table['mud'] is -1"));
}

TEST(ErrorModel, ShapesHaveNames) {
  for (const auto shape : {GeologicShape::kGaussian, GeologicShape::kStep, GeologicShape::kGrowth}) {
    EXPECT_EQ(geologic_shape_from(name_of(shape)), shape);
  }
  EXPECT_THROW(geologic_shape_from("Gauss"), InvalidInput);
}

TEST(TerrainTable, HasThePapersEnds) {
  const auto& table = default_terrain_table();
  EXPECT_DOUBLE_EQ(table.at("grassland"), 0.5);
  EXPECT_DOUBLE_EQ(table.at("craggy"), 4.0);
  for (const auto& [name, metres] : table) {
    EXPECT_GE(metres, 0.5) << name;
    EXPECT_LE(metres, 4.0) << name;
  }
}

}  // namespace
}  // namespace sightbound
