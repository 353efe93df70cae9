// SPDX-License-Identifier: GPL-3.0-or-later
// Which jobs are refused, and what is said of a job before it runs.
#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "base/error.h"
#include "jobs/volume_terrain.h"
#include "jobs/volume_viewshed_job.h"
#include "support/hidden_volumes.h"
#include "support/says.h"

namespace sightbound {
namespace {

using testing::complaint;
using testing::says;

// Level ground of 200 x 100 m at 50 m.
ErrorVolume plain(double west = 1000) {
  Tin tin;
  tin.vertices = {{west, 2000, 50}, {west + 200, 2000, 50}, {west + 200, 2100, 50}, {west, 2100, 50}};
  tin.faces = {{0, 1, 2}, {0, 2, 3}};
  ErrorModel model;
  model.vertical_rmse = 0.2;
  model.geologic_variation = 0.0;
  VolumeOptions options;
  options.voxel_m = 2;
  Progress progress;
  return build_volume(volume_terrain(tin, model), options, progress);
}

class VolumeViewshedJob : public ::testing::Test {
 protected:
  VolumeViewshedJob() {
    options_.targets = {10, 2, 8};
    options_.curvature = false;
  }
  SightEstimate estimate() {
    Progress progress;
    return estimate_sight(volume_, views_, options_, progress);
  }
  HiddenResult run() {
    Progress progress;
    return run_volume_viewshed(volume_, views_, options_, progress);
  }
  // Of the estimate and of the run alike.
  template <class Refusal>
  std::string refusal() {
    const std::string said = complaint<Refusal>([&] { estimate(); });
    EXPECT_EQ(complaint<Refusal>([&] { run(); }), said);
    return said;
  }

  ErrorVolume volume_ = plain();
  std::vector<ViewVolume> views_{ViewVolume{{{{1055, 2055}}}, 1.7, 1.7, ""}};
  VolumeSightOptions options_;
};

TEST_F(VolumeViewshedJob, IsToldBeforeItRuns) {
  views_ = {ViewVolume{{{{1010, 2010}, {1050, 2010}, {1050, 2050}, {1010, 2050}}}, 2, 6, ""}};
  options_.view_spacing = 10;
  const SightEstimate told = estimate();
  EXPECT_EQ(told.view_places, 32u);  // 4 x 4 in plan, at both heights
  EXPECT_EQ(told.targets, 20u * 10u * 4u);
  EXPECT_EQ(told.lines, 32.0 * 800);
  EXPECT_GT(told.seconds, 0);
  EXPECT_GT(told.bytes, 800u);
  const HiddenResult found = run();
  EXPECT_EQ(found.estimate.lines, told.lines);
  EXPECT_EQ(found.estimate.bytes, told.bytes);
  EXPECT_EQ(found.hidden.lattice().targets(), told.targets);
}

TEST_F(VolumeViewshedJob, AnAreaIsLookedFromEightPlacesAcrossUnlessSaid) {
  views_ = {ViewVolume{{{{1000, 2000}, {1200, 2000}, {1200, 2100}, {1000, 2100}}}, 2, 2, ""}};
  EXPECT_EQ(estimate().view_places, 32u);
  options_.view_spacing = 50;
  EXPECT_EQ(estimate().view_places, 8u);
}

TEST_F(VolumeViewshedJob, TooManyLinesAreRefusedWithTheSpacingThatFits) {
  options_.most_lines = 799;
  EXPECT_TRUE(says(refusal<InvalidInput>(), "Targets 11 m apart would fit"));
  options_.most_lines = 800;
  EXPECT_EQ(estimate().lines, 800);
}

TEST_F(VolumeViewshedJob, TooMuchMemoryIsRefused) {
  options_.memory_budget = 1000;
  EXPECT_TRUE(says(refusal<OverBudget>(), "800 targets"));
}

TEST_F(VolumeViewshedJob, NonsenseIsRefusedByName) {
  const auto refused = [&](auto change, const std::string& name) {
    const VolumeSightOptions before = options_;
    change(options_);
    EXPECT_TRUE(says(refusal<InvalidInput>(), name));
    options_ = before;
  };
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  refused([](auto& o) { o.confidence = 1; }, "confidence");
  refused([](auto& o) { o.confidence = 0; }, "confidence");
  refused([](auto& o) { o.refraction = 1.1; }, "refraction is 1.1");
  refused([&](auto& o) { o.refraction = kNothing; }, "refraction");
  refused([](auto& o) { o.max_distance = 0; }, "max_distance");
  refused([&](auto& o) { o.max_distance = kNothing; }, "max_distance");
  refused([](auto& o) { o.most_lines = -1; }, "most_lines");
  refused([](auto& o) { o.view_spacing = -1; }, "view_spacing");
  refused([](auto& o) { o.targets.spacing_m = 0; }, "target_spacing");
  refused([](auto& o) { o.targets.ceiling_m = -2; }, "target_ceiling");
  views_.clear();
  EXPECT_TRUE(says(refusal<InvalidInput>(), "views"));
}

TEST_F(VolumeViewshedJob, ConfidenceBeyondTheBandIsRefused) {
  options_.confidence = 0.99999;
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { run(); }), "larger largest_confidence"));
}

TEST_F(VolumeViewshedJob, AHiddenVolumeBelongsToItsErrorVolume) {
  Progress progress;
  const HiddenResult found = run();
  const ErrorVolume elsewhere = plain(1007);
  views_[0].rings = {{{1100, 2055}}};
  const auto subtract = [&](const ErrorVolume& volume, double height) {
    return subtract_observer(found.hidden, volume, views_, options_, height, progress);
  };
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { subtract(elsewhere, 1.8); }), "another error volume"));
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { subtract(volume_, 9); }), "height"));
  // Targets and confidence are those of the hidden volume.
  options_.targets.spacing_m = 3;
  options_.confidence = 0.5;
  const Subtraction rest = subtract(volume_, 1.8);
  EXPECT_EQ(rest.rest.lattice(), found.hidden.lattice());
  EXPECT_EQ(rest.rest.info().confidence, 0.95);
  EXPECT_GE(rest.gained_m3, 0);
}

}  // namespace
}  // namespace sightbound
