// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "io/tin_crs.h"
#include "jobs/volume_terrain.h"
#include "support/hidden_volumes.h"
#include "support/says.h"
#include "support/tins.h"

namespace sightbound {
namespace {

using testing::box;
using testing::complaint;
using testing::says;

ErrorModel exact(double rmse = 0.5) {
  ErrorModel model;
  model.vertical_rmse = rmse;
  model.geologic_variation = 0.0;
  return model;
}

// 8 x 10 samples of 10 m, waves of some metres.
class Waves {
 public:
  explicit Waves(const std::string& crs = "", double cell = 10)
      : dem_({heights_.data(), 8, 10, std::numeric_limits<double>::quiet_NaN(), 1, nullptr},
             Geotransform({1000, cell, 0, 2080, 0, -cell}), crs) {
    for (std::size_t n = 0; n < heights_.size(); ++n)
      heights_[n] = static_cast<float>(50 + 3 * std::sin(static_cast<double>(n)));
  }
  VolumeTerrain terrain(const ErrorModel& model, const VolumeTerrainOptions& options = {}) const {
    Progress progress;
    return volume_terrain(dem_, model, options, progress);
  }

 private:
  std::vector<float> heights_ = std::vector<float>(80);
  ArrayDem dem_;
};

TEST(VolumeTerrain, OfADemMeasuresVertically) {
  const VolumeTerrain terrain = Waves().terrain(exact());
  EXPECT_EQ(terrain.surface->metric(), Metric::kVertical);
  EXPECT_FALSE(terrain.surface->has_between());
  EXPECT_EQ(terrain.surface->spacing_m(), 10);
  EXPECT_EQ(terrain.surface->frame().x, 1005);
  EXPECT_TRUE(says(terrain.error_model, R"("vertical_rmse": 0.5)"));
}

TEST(VolumeTerrain, OfAPartHasTheSamplesOfThatPart) {
  VolumeTerrainOptions options;
  options.extent = Extent{1020, 2020, 1060, 2060};
  const VolumeTerrain part = Waves().terrain(exact(), options);
  EXPECT_EQ(part.surface->frame().x, 1025);
  EXPECT_EQ(part.surface->bounds().high.x, 30);
  EXPECT_EQ(part.surface->bounds().high.y, 30);
}

TEST(VolumeTerrain, LearnsADemsErrorFromItself) {
  const VolumeTerrain terrain = Waves().terrain(ErrorModel{});
  EXPECT_TRUE(terrain.surface->has_between());
  EXPECT_FALSE(says(terrain.error_model, "null"));
}

TEST(VolumeTerrain, RefusesWhatItCannotMeasureOrHold) {
  EXPECT_TRUE(says(complaint<InvalidInput>([] { Waves(crs_from_text("EPSG:4326"), 0.01).terrain(exact()); }),
                   "reproject"));
  VolumeTerrainOptions tight;
  tight.memory_budget = 100;
  EXPECT_TRUE(says(complaint<OverBudget>([&] { Waves().terrain(exact(), tight); }), "8 samples"));
  EXPECT_TRUE(says(complaint<InvalidInput>([] { Waves().terrain(exact(-1)); }), "vertical_rmse"));
}

TEST(VolumeTerrain, OfATinMeasuresAsItsShapeAsks) {
  EXPECT_EQ(volume_terrain(testing::triangle(), exact()).surface->metric(), Metric::kVertical);
  Tin body = box({0, 0, 0}, {10, 10, 10});
  body.notes = {"turned"};
  const VolumeTerrain terrain = volume_terrain(body, exact());
  EXPECT_EQ(terrain.surface->metric(), Metric::kNormal);
  EXPECT_EQ(terrain.surface->sides(), Sides::kSolid);
  EXPECT_EQ(terrain.warnings, std::vector<std::string>{"turned"});
}

TEST(VolumeTerrain, NothingIsLearntFromATin) {
  ErrorModel model = exact();
  model.geologic_variation = ErrorModel{}.geologic_variation;
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { volume_terrain(testing::triangle(), model); }),
                   "geologic_variation"));
  model = exact();
  model.vertical_rmse = ErrorModel{}.vertical_rmse;
  EXPECT_TRUE(
      says(complaint<InvalidInput>([&] { volume_terrain(testing::triangle(), model); }), "cannot be learnt"));
  Tin known = testing::triangle();
  known.sigma_v = {0.1f, 0.2f, 0.3f};
  EXPECT_EQ(volume_terrain(known, model).surface->face(0)->sampling[1], static_cast<double>(0.2f));
}

TEST(VolumeTerrain, BecomesAVolumeThatKnowsItsErrorModel) {
  const VolumeTerrain terrain = Waves().terrain(exact());
  VolumeOptions options;
  options.voxel_m = 2;
  options.error_model = "another";
  Progress progress;
  const ErrorVolume volume = build_volume(terrain, options, progress);
  EXPECT_EQ(volume.error_model(), terrain.error_model);
  EXPECT_EQ(volume.shared_surface(), terrain.surface);
  const VolumeNeed need = need_of(terrain, options);
  EXPECT_EQ(need.voxel_m, 2);
  EXPECT_NEAR(need.voxels / static_cast<double>(volume.report().voxels), 1, 0.7);
}

}  // namespace
}  // namespace sightbound
