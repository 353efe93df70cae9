// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "base/error.h"
#include "error_model/error_model.h"
#include "support/says.h"

namespace sightbound {
namespace {

using testing::says;

std::string refusal(const std::string& text) {
  try {
    ErrorModel::from_json(text);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(ErrorModelJson, DefaultComesBack) {
  const ErrorModel back = ErrorModel::from_json(ErrorModel().to_json());
  EXPECT_TRUE(std::holds_alternative<FromDem>(back.vertical_rmse));
  EXPECT_TRUE(std::holds_alternative<FromDem>(back.geologic_variation));
  EXPECT_EQ(back.geologic_shape, GeologicShape::kGaussian);
  EXPECT_TRUE(back.needs_estimate());
}

TEST(ErrorModelJson, EveryFieldComesBackToTheLastBit) {
  ErrorModel model;
  model.vertical_rmse = 1.0 / 3;
  model.horizontal_rmse = 0.1 + 0.2;
  model.geologic_variation = RasterFile{"Δ \"ridge\".tif", 3};
  model.geologic_shape = GeologicShape::kStep;
  model.geologic_range = 2.0 / 7;
  model.terrain_types = TerrainTypes{"types.gpkg", "layer", "kind", {{"mud", 0.1}, {"scree", 3.3}}};
  const ErrorModel back = ErrorModel::from_json(model.to_json());
  EXPECT_EQ(std::get<double>(back.vertical_rmse), 1.0 / 3);
  EXPECT_EQ(back.horizontal_rmse, 0.1 + 0.2);
  EXPECT_EQ(std::get<RasterFile>(back.geologic_variation).path, "Δ \"ridge\".tif");
  EXPECT_EQ(std::get<RasterFile>(back.geologic_variation).band, 3);
  EXPECT_EQ(back.geologic_shape, GeologicShape::kStep);
  EXPECT_EQ(back.geologic_range, 2.0 / 7);
  EXPECT_EQ(back.terrain_types->path, "types.gpkg");
  EXPECT_EQ(back.terrain_types->layer, "layer");
  EXPECT_EQ(back.terrain_types->field, "kind");
  EXPECT_EQ(back.terrain_types->table, model.terrain_types->table);
  EXPECT_EQ(back.to_json(), model.to_json());
}

TEST(ErrorModelJson, TheNatureOfErrorsComesBackToTheLastBit) {
  ErrorModel model;
  model.tails = Tails::kLaplace;
  model.correlation_length = 100.0 / 3;
  model.shared_bias = -0.1;
  model.samples_or_means = CellContent::kMeans;
  model.ridge_gain = 1.0 / 7;
  model.level_variance = 1.0 / 3;
  model.step_variance = 7.0 / 3;
  model.level_tail = 4.0 / 3;
  model.step_tail = 0.1;
  const ErrorModel back = ErrorModel::from_json(model.to_json());
  EXPECT_EQ(back.level_variance, 1.0 / 3);
  EXPECT_EQ(back.step_variance, 7.0 / 3);
  EXPECT_EQ(back.level_tail, 4.0 / 3);
  EXPECT_EQ(back.step_tail, 0.1);
  EXPECT_EQ(back.tails, Tails::kLaplace);
  EXPECT_EQ(back.correlation_length, 100.0 / 3);
  EXPECT_EQ(back.shared_bias, -0.1);
  EXPECT_EQ(back.samples_or_means, CellContent::kMeans);
  EXPECT_EQ(back.ridge_gain, 1.0 / 7);
  EXPECT_EQ(back.to_json(), model.to_json());
}

TEST(ErrorModelJson, TheNatureOfErrorsIsWrittenOnlyWhenSaid) {
  const std::string text = ErrorModel().to_json();
  for (const char* name : {"tails", "correlation_length", "shared_bias", "samples_or_means", "ridge_gain"}) {
    EXPECT_EQ(text.find(name), std::string::npos) << name;
  }
  const ErrorModel none =
      ErrorModel::from_json(R"({"tails": null, "samples_or_means": null, "ridge_gain": null})");
  EXPECT_FALSE(none.tails || none.samples_or_means || none.ridge_gain);
  EXPECT_TRUE(says(refusal(R"({"tails": "cauchy"})"), "'normal', 'laplace' and 'student'"));
  EXPECT_TRUE(says(refusal(R"({"samples_or_means": "both"})"), "'samples' and 'means'"));
  EXPECT_TRUE(says(refusal(R"({"shared_bias": "much"})"), "shared_bias"));
}

TEST(ErrorModelJson, ACompletedRecipeComesBack) {
  ErrorModel model;
  model.vertical_rmse = 0.0;
  model.geologic_shape = GeologicShape::kGrowth;
  model.growth_exponent = 0.9312345678901234;
  model.typical_m = 1.2;
  const ErrorModel back = ErrorModel::from_json(model.to_json());
  EXPECT_FALSE(back.needs_estimate());
  EXPECT_TRUE(std::holds_alternative<FromDem>(back.geologic_variation));
  EXPECT_EQ(back.growth_exponent, model.growth_exponent);
  EXPECT_EQ(back.typical_m, model.typical_m);
  EXPECT_NO_THROW(back.validate());
}

TEST(ErrorModelJson, GivenGrowthKeepsItsExponent) {
  ErrorModel model;
  model.geologic_variation = 2.0;
  model.geologic_shape = GeologicShape::kGrowth;
  model.growth_exponent = 1.1;
  EXPECT_EQ(ErrorModel::from_json(model.to_json()).growth_exponent, 1.1);
}

TEST(ErrorModelJson, PeopleMayWriteLittle) {
  const ErrorModel model = ErrorModel::from_json(R"({"vertical_rmse": 2, "geologic_variation": null})");
  EXPECT_EQ(std::get<double>(model.vertical_rmse), 2);
  EXPECT_TRUE(std::holds_alternative<FromDem>(model.geologic_variation));
}

TEST(ErrorModelJson, ArraysAreDescribedButNotWritten) {
  ErrorModel model;
  model.vertical_rmse = std::make_shared<const Grid<float>>(3, 4, 1.0f);
  EXPECT_THROW(model.to_json(), InvalidInput);
  EXPECT_TRUE(says(model.describe(), "\"array\""));
  EXPECT_TRUE(says(refusal(model.describe()), "vertical_rmse was an array"));
}

TEST(ErrorModelJson, MistakesAreNamed) {
  EXPECT_TRUE(says(refusal("{"), "not readable"));
  EXPECT_TRUE(says(refusal("[]"), "an object"));
  EXPECT_TRUE(says(refusal(R"({"vertical_rms": 2})"), "unknown name 'vertical_rms'"));
  EXPECT_TRUE(says(refusal(R"({"vertical_rmse": "2"})"), "vertical_rmse"));
  EXPECT_TRUE(says(refusal(R"({"vertical_rmse": {"band": 2}})"), "'raster'"));
  EXPECT_TRUE(says(refusal(R"({"geologic_model": "Gauss"})"), "'Gauss'"));
  EXPECT_TRUE(says(refusal(R"({"geologic_range": "far"})"), "geologic_range"));
  EXPECT_TRUE(says(refusal(R"({"geologic_variation": {"from_dem": {"H": 1}}})"), "unknown name 'H'"));
  EXPECT_TRUE(says(refusal(R"({"sightbound_error_model": 2})"), "reads 1"));
  EXPECT_TRUE(says(refusal(R"({"terrain_types": {"table": {"mud": "deep"}}})"), "terrain_types.table.mud"));
}

}  // namespace
}  // namespace sightbound
