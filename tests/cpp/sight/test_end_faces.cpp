// SPDX-License-Identifier: GPL-3.0-or-later
// What the faces near an end of a line prove: scenes known by construction. L = 10 m, so that the end zone is
// 15 m long.
#include <memory>

#include <gtest/gtest.h>

#include "sight/volume_sight.h"
#include "support/tins.h"

namespace sightbound {
namespace {

using testing::box;
using testing::tin_of;
using testing::together;

struct Scene {
  ErrorVolume volume;
  VolumeRays rays{volume};
  VolumeSight sight{rays, {}};
  Xyz shift;

  // amplitude: of the error between the samples 10 m from them; it grows as the distance does.
  explicit Scene(const Tin& tin, double amplitude = 0) : volume(build(tin, amplitude)) {
    shift = {bounds_of(tin).low.x, bounds_of(tin).low.y, 0};
  }
  static ErrorVolume build(const Tin& tin, double amplitude) {
    TinError error;
    error.sampling.assign(tin.vertices.size(), 0.1f);
    if (amplitude > 0) error.amplitude.assign(tin.vertices.size(), static_cast<float>(amplitude));
    error.spacing_m = 10;
    error.profile = {GeologicShape::kGrowth, 0, 1, 10};
    VolumeOptions options;
    options.voxel_m = amplitude > 0 ? 5 : 0.5;
    Progress progress;
    return ErrorVolume::build(std::make_shared<TinSurface>(tin, error, Metric::kNormal), options, progress);
  }
  std::uint8_t verdict(const Xyz& from, const Xyz& to) const {
    const auto of = [&](const Xyz& a, const Xyz& b) {
      return verdict_of(sight.ratio(sight.zone(a - shift), sight.zone(b - shift)), 1.96);
    };
    EXPECT_EQ(of(from, to), of(to, from)) << "the way back";
    return of(from, to);
  }
};

const Xyz kEye{0, 0, 0};

// Thinner than a voxel, 3 m from the eye.
TEST(EndFaces, a_thin_wall_hides_what_is_right_behind_it) {
  const Scene scene(box({3, -20, -10}, {3.3, 20, 10}));
  EXPECT_EQ(scene.verdict(kEye, {3.5, 0.3, 0.2}), kHidden);
  EXPECT_EQ(scene.verdict(kEye, {40, 1, 2}), kHidden);
  EXPECT_EQ(scene.verdict(kEye, {40, 1, 200}), kVisible);
  EXPECT_EQ(scene.verdict(kEye, {2.9, 0.3, 0.2}), kVisible);
  EXPECT_EQ(scene.verdict({3.4, 5, 0}, {3.4, -5, 0}), kVisible);  // along it
}

TEST(EndFaces, a_sheet_hides_away_from_its_border) {
  const Scene scene(tin_of({{3, -20, -10}, {3, 20, -10}, {3, 20, 10}, {3, -20, 10}}, {{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(scene.verdict(kEye, {3.5, 0.3, 0.2}), kHidden);
  EXPECT_EQ(scene.verdict(kEye, {40, 1, 2}), kHidden);
  EXPECT_EQ(scene.verdict({0, 0, 9.9}, {6, 0, 9.9}), kHidden);
  EXPECT_EQ(scene.verdict({0, 0, 9.999}, {6, 0, 9.999}), kUncertain);  // 1 mm from its border
  EXPECT_EQ(scene.verdict({0, 0, 10}, {6, 0, 10}), kUncertain);        // along it
  EXPECT_EQ(scene.verdict({0, 0, 10.1}, {6, 0, 10.1}), kVisible);
  EXPECT_EQ(scene.verdict({0, 19.9, 0}, {6, 20.1, 0}), kUncertain);  // past a corner, through the border
}

TEST(EndFaces, a_target_in_a_room_is_hidden_but_through_the_door) {
  // Walls of 0.2 m; the west side stays open.
  Tin room = together(box({0, 0, 0}, {8, 0.2, 3}), box({0, 7.8, 0}, {8, 8, 3}));
  room = together(room, box({7.8, 0.3, 0}, {8, 7.7, 3}));
  room = together(room, box({-20, -20, -1}, {30, 30, -0.1}));
  const Scene scene(room);
  const Xyz target{6, 4, 1.5};
  EXPECT_EQ(scene.verdict({-8, 4, 1.5}, target), kVisible);
  EXPECT_EQ(scene.verdict({5, -6, 1.5}, target), kHidden);
  EXPECT_EQ(scene.verdict({12, 5, 1.5}, target), kHidden);
  EXPECT_EQ(scene.verdict({12, 5, 8.5}, target), kVisible);  // there is no roof
  EXPECT_EQ(scene.verdict({7, 12, 1.5}, {7, 8.1, 1.5}), kVisible);
}

TEST(EndFaces, what_is_inside_a_body_is_hidden) {
  const Scene scene(box({0, 0, 0}, {30, 30, 30}));
  EXPECT_EQ(scene.verdict({10, 10, 10}, {14, 12, 11}), kHidden);
  EXPECT_EQ(scene.verdict({10, 10, 10}, {10, 10, 40}), kHidden);
  EXPECT_EQ(scene.verdict({-1, 15, 15}, {1, 15, 15}), kHidden);
  EXPECT_EQ(scene.verdict({-1, 15, 15}, {-3, 15, 15}), kVisible);
  // Cuts the edge by less than a millimetre, and touches a corner.
  EXPECT_EQ(scene.verdict({-0.9995, 15, 29}, {1.0005, 15, 31}), kUncertain);
  EXPECT_EQ(scene.verdict({-1, -1, 30}, {1, 1, 30}), kUncertain);
}

// In the middle of the wall the nearest sample is 22 m off: the error there is 1.9 amplitudes.
TEST(EndFaces, doubt_between_the_samples_needs_a_thicker_wall) {
  EXPECT_EQ(Scene(box({3, -20, -10}, {3.3, 20, 10}), 0.2).verdict(kEye, {3.5, 0.3, 0.2}), kUncertain);
  EXPECT_EQ(Scene(box({3, -20, -10}, {8, 20, 10}), 0.2).verdict(kEye, {8.5, 0.3, 0.2}), kHidden);
  EXPECT_EQ(Scene(box({3, -20, -10}, {8, 20, 10}), 0.7).verdict(kEye, {8.5, 0.3, 0.2}), kUncertain);
  const Tin sheet = tin_of({{3, -20, -10}, {3, 20, -10}, {3, 20, 10}, {3, -20, 10}}, {{0, 1, 2}, {0, 2, 3}});
  EXPECT_EQ(Scene(sheet, 0.2).verdict(kEye, {6, 0.3, 0.2}), kHidden);
  EXPECT_EQ(Scene(sheet, 0.2).verdict(kEye, {3.2, 0.3, 0.2}), kUncertain);
}

// The nearest face may lie outside the end zone.
TEST(EndFaces, great_doubt_reaches_into_the_zone) {
  const Tin far =
      tin_of({{17, -90, -90}, {17, 90, -90}, {17, 90, 90}, {17, -90, 90}}, {{0, 1, 2}, {0, 2, 3}});
  EXPECT_EQ(Scene(far, 1).verdict(kEye, {5, 0.3, 0.2}), kUncertain);
  EXPECT_EQ(Scene(far, 0.001).verdict(kEye, {5, 0.3, 0.2}), kVisible);
}

}  // namespace
}  // namespace sightbound
