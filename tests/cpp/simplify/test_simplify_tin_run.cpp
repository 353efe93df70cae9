// SPDX-License-Identifier: GPL-3.0-or-later
// How simplifying a TIN runs: to a target, on any number of threads, in time, until cancelled; what it
// refuses.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "simplify/height_containment.h"
#include "support/simplified_tins.h"

namespace sightbound {
namespace {

using namespace testing;

TEST(SimplifyTin, StopsAtTheTarget) {
  const Tin tin = finer(rough_ball(4, 10, 0.1), 2);
  for (const std::int64_t target : {1000, 400}) {
    TinSimplifyOptions options;
    options.target_faces = target;
    const std::size_t faces = simplified(tin, 0.8, 0.25, options).tin.faces.size();
    EXPECT_LE(std::abs(static_cast<std::int64_t>(faces) - target), 2);
    EXPECT_GE(faces + 1, static_cast<std::size_t>(target));
  }
}

TEST(SimplifyTin, SameBytesForAnyNumberOfThreads) {
  for (const Body& body : bodies()) {
    const TinSimplified one = simplified(body.tin, body.tolerance, body.voxel, {}, 1),
                        two = simplified(body.tin, body.tolerance, body.voxel, {}, 2);
    EXPECT_EQ(one.tin.faces, two.tin.faces);
    EXPECT_EQ(one.tin.vertices, two.tin.vertices);
  }
}

// Each took minutes when work at a vertex grew with its faces, and a flat was drawn to one vertex.
TEST(SimplifyTin, FlatsAndHubsTakeTimeInProportionToTheirFaces) {
  TinSimplifyOptions options;
  options.height_field = true;
  Progress progress;
  const Tin flat = rough_lattice(200, 1, 0);
  HeightContainment level(flat, std::vector<float>(flat.vertices.size(), 0.1F), false);
  EXPECT_EQ(simplify_tin(flat, level, options, progress).tin.faces.size(), 2U);
  Tin fan;
  const std::int32_t rim = 20000;
  fan.vertices.push_back({0, 0, 5});
  for (std::int32_t i = 0; i < rim; ++i) {
    const double turn = 2 * 3.141592653589793 * i / rim;
    fan.vertices.push_back({100 * std::cos(turn), 100 * std::sin(turn), 0});
    fan.faces.push_back({0, 1 + i, 1 + (i + 1) % rim});
  }
  options.outline_tolerance_m = 0.2;
  HeightContainment cone(fan, std::vector<float>(fan.vertices.size(), 0.2F), false);
  EXPECT_LT(simplify_tin(fan, cone, options, progress).tin.faces.size(), 400U);
}

TEST(SimplifyTin, RefusesWhatMakesNoSense) {
  const Tin tin = triangle();
  TinSimplifyOptions options;
  options.keep.assign(2, 0);
  EXPECT_THROW(with_nothing_allowed(tin, options), InvalidInput);
  options = {};
  options.outline_tolerance_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(with_nothing_allowed(tin, options), InvalidInput);
  options = {};
  options.target_faces = -1;
  EXPECT_THROW(with_nothing_allowed(tin, options), InvalidInput);
  EXPECT_THROW(with_nothing_allowed(Tin{}), InvalidInput);
}

TEST(SimplifyTin, IsCancelled) {
  const Tin tin = finer(rough_ball(4, 10, 0.1), 4);
  Progress progress([](double) { return false; });
  NothingContained nothing;
  EXPECT_THROW(simplify_tin(tin, nothing, {}, progress), Cancelled);
}

}  // namespace
}  // namespace sightbound
