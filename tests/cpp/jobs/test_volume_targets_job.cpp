// SPDX-License-Identifier: GPL-3.0-or-later
// A ridge on level ground: what lies behind it is hidden, whether it is asked as a layer or as a list.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/error.h"
#include "jobs/volume_targets_job.h"
#include "jobs/volume_terrain.h"
#include "support/hidden_volumes.h"
#include "support/says.h"

namespace sightbound {
namespace {

using testing::complaint;
using testing::says;

// 200 x 100 m at 50 m, with a roof 12 m high from x = 1090 to 1110.
ErrorVolume ridge() {
  Tin tin;
  const double xs[] = {1000, 1090, 1100, 1110, 1200}, zs[] = {50, 50, 62, 50, 50};
  for (int n = 0; n < 5; ++n) {
    tin.vertices.push_back({xs[n], 2000, zs[n]});
    tin.vertices.push_back({xs[n], 2100, zs[n]});
  }
  for (std::int32_t n = 0; n < 8; n += 2) {
    tin.faces.push_back({n, n + 2, n + 3});
    tin.faces.push_back({n, n + 3, n + 1});
  }
  ErrorModel model;
  model.vertical_rmse = 0.2;
  model.geologic_variation = 0.0;
  VolumeOptions options;
  options.voxel_m = 1;
  Progress progress;
  return build_volume(volume_terrain(tin, model), options, progress);
}

class VolumeTargetsJob : public ::testing::Test {
 protected:
  VolumeTargetsJob() {
    options_.targets.spacing_m = 10;
    options_.curvature = false;
  }
  LayerResult layer(double height = 2) {
    Progress progress;
    return see_layer(volume_, views_, height, options_, progress);
  }
  TargetsResult list(const std::vector<TargetPoint>& targets,
                     HeightReference reference = HeightReference::kGround) {
    Progress progress;
    return see_targets(volume_, views_, targets, reference, options_, progress);
  }

  ErrorVolume volume_ = ridge();
  std::vector<ViewVolume> views_{ViewVolume{{{{1020, 2053}}}, 3, 3, ""}};
  VolumeSightOptions options_;
};

TEST_F(VolumeTargetsJob, ALayerIsARasterNorthUp) {
  const LayerResult found = layer();
  ASSERT_EQ(found.verdict.rows(), 10);
  ASSERT_EQ(found.verdict.cols(), 20);
  EXPECT_EQ(found.geotransform.coefficients(), (std::array<double, 6>{1000, 10, 0, 2100, 0, -10}));
  EXPECT_EQ(found.estimate.lines, 200);
  for (int row = 0; row < 10; ++row) {
    EXPECT_EQ(found.verdict.at(row, 5), kVisible);
    EXPECT_GT(found.confidence.at(row, 5), 0.99f);
    EXPECT_EQ(found.verdict.at(row, 13), kHidden);
    EXPECT_LT(found.confidence.at(row, 13), 0.01f);
  }
  // High enough up the far end is seen over the ridge: the line over it is there 72.7 m high.
  EXPECT_EQ(layer(20).verdict.at(5, 19), kHidden);
  EXPECT_EQ(layer(30).verdict.at(5, 19), kVisible);
}

TEST_F(VolumeTargetsJob, BeyondTheDistanceNothingIsAsked) {
  options_.max_distance = 50;
  const LayerResult found = layer();
  EXPECT_EQ(found.verdict.at(5, 19), kNoVerdict);
  EXPECT_TRUE(std::isnan(found.confidence.at(5, 19)));
  EXPECT_EQ(list({{1195, 2045, 2}}).answers[0].verdict, kNoVerdict);
}

TEST_F(VolumeTargetsJob, AListIsAnsweredInItsOrder) {
  const TargetsResult found = list({{1135, 2045, 2}, {5, 5, 2}, {1055, 2045, 2}, {1135, 2045, 30}});
  ASSERT_EQ(found.answers.size(), 4u);
  EXPECT_EQ(found.answers[0].verdict, kHidden);
  EXPECT_EQ(found.answers[1].verdict, kNoVerdict);
  EXPECT_EQ(found.answers[2].verdict, kVisible);
  EXPECT_EQ(found.answers[3].verdict, kVisible);
  ASSERT_EQ(found.warnings.size(), 1u);
  EXPECT_TRUE(says(found.warnings[0], "1 of 4 targets are not on the terrain"));
  EXPECT_EQ(found.estimate.targets, 3u);
}

TEST_F(VolumeTargetsJob, HeightsAreAboveGroundOrAbsolute) {
  const TargetPoint on_ridge{1100, 2045, 2};
  const TargetAnswer above = list({on_ridge}).answers[0];
  EXPECT_EQ(above, list({{1100, 2045, 64}}, HeightReference::kAbsolute).answers[0]);
  EXPECT_EQ(above.verdict, kVisible);
  const TargetsResult beneath =
      list({{1100, 2045, 55}, {1135, 2045, 49}, {1055, 2045, 52}}, HeightReference::kAbsolute);
  EXPECT_EQ(beneath.answers[0].verdict, kNoVerdict);
  EXPECT_EQ(beneath.answers[1].verdict, kNoVerdict);
  EXPECT_EQ(beneath.answers[2].verdict, kVisible);
  EXPECT_TRUE(says(beneath.warnings.at(0), "2 of 3 targets are beneath the ground"));
}

TEST_F(VolumeTargetsJob, SeenFromAllIsWorseThanFromAny) {
  views_.push_back(ViewVolume{{{{1180, 2053}}}, 3, 3, ""});
  const std::vector<TargetPoint> targets{{1055, 2045, 2}, {1135, 2045, 2}};
  for (const TargetAnswer& answer : list(targets).answers) EXPECT_EQ(answer.verdict, kVisible);
  options_.seen_from = SeenFrom::kAll;
  for (const TargetAnswer& answer : list(targets).answers) EXPECT_EQ(answer.verdict, kHidden);
}

TEST_F(VolumeTargetsJob, NonsenseIsRefusedByName) {
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [&](const std::vector<TargetPoint>& targets) {
    return complaint<InvalidInput>([&] { list(targets); });
  };
  EXPECT_TRUE(says(refused({}), "targets is empty"));
  EXPECT_TRUE(says(refused({{1055, 2045, 2}, {kNothing, 2045, 2}}), "Target 2 has a coordinate"));
  EXPECT_TRUE(says(refused({{1055, 2045, kNothing}}), "Target 1: height is nan"));
  EXPECT_TRUE(says(refused({{5, 5, 2}}), "None of the targets is on the terrain"));
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { layer(0); }), "target_height is 0"));
  options_.most_lines = 1;
  EXPECT_TRUE(says(refused({{1055, 2045, 2}, {1065, 2045, 2}}), "Fewer targets would fit"));
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { layer(); }), "m apart would fit"));
  options_.most_lines = 1e9;
  options_.memory_budget = 100;
  EXPECT_TRUE(says(complaint<OverBudget>([&] { layer(); }), "200 targets"));
  views_.clear();
  EXPECT_TRUE(says(refused({{1055, 2045, 2}}), "views"));
}

}  // namespace
}  // namespace sightbound
