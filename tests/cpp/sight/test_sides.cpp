// SPDX-License-Identifier: GPL-3.0-or-later
// Sheets have two sides, no inside: a line is hidden when it goes through one, not when the near side
// changes.
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "sight/volume_sight.h"
#include "support/tins.h"
#include "volume/tin_surface.h"

namespace sightbound {
namespace {

using testing::tin_of;
using testing::together;

constexpr double kSigma = 0.1;

// 40 by 12 m, `middle` high at x = 20 and `ends` at x = 0 and 40; faces of 2 m look up.
Tin sheet(double middle, double ends) {
  Tin tin;
  constexpr int kCols = 20, kRows = 6;
  for (int r = 0; r <= kRows; ++r) {
    for (int c = 0; c <= kCols; ++c)
      tin.vertices.push_back({2.0 * c, 2.0 * r, middle + (ends - middle) * std::abs(c - 10) / 10});
  }
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kCols; ++c) {
      const std::int32_t a = r * (kCols + 1) + c, b = a + 1, d = a + kCols + 1, e = d + 1;
      tin.faces.push_back({a, b, e});
      tin.faces.push_back({a, e, d});
    }
  }
  return tin;
}

struct Scene {
  ErrorVolume volume;
  VolumeRays rays{volume};
  VolumeSight sight{rays, {}};

  Scene(const Tin& tin, double voxel) : volume(build(tin, voxel)) {}
  static ErrorVolume build(const Tin& tin, double voxel) {
    TinError error;
    error.sampling.assign(tin.vertices.size(), static_cast<float>(kSigma));
    error.spacing_m = 2;
    error.profile.half_spacing_m = 1;
    VolumeOptions options;
    options.voxel_m = voxel;
    Progress progress;
    return ErrorVolume::build(std::make_shared<TinSurface>(tin, error, Metric::kNormal), options, progress);
  }
  std::uint8_t verdict(const Xyz& from, const Xyz& to) const {
    return verdict_of(sight.ratio(sight.zone(from), sight.zone(to)), 1.96);
  }
};

// From the upper side of the lower sheet to the lower side of the upper one, 0.6 m apart: 3 sigma halfway.
TEST(Sides, change_between_two_sheets_without_hiding) {
  for (const double voxel : {0.05, 0.1}) {
    const Scene scene(together(sheet(10, 10), sheet(10.6, 10.6)), voxel);
    for (const double y : {3.3, 8.4}) {
      EXPECT_NE(scene.verdict({2.2, y, 10.2}, {37.8, y, 10.4}), kHidden) << voxel;
      EXPECT_NE(scene.verdict({37.8, y, 10.22}, {2.2, y, 10.37}), kHidden) << voxel;
    }
  }
}

// The same 1 m apart: halfway no side is known at all.
TEST(Sides, change_far_between_two_sheets_without_hiding) {
  const Scene scene(together(sheet(10, 10), sheet(11, 11)), 0.05);
  EXPECT_NE(scene.verdict({2.2, 5.3, 10.2}, {37.8, 5.3, 10.8}), kHidden);
  EXPECT_NE(scene.verdict({37.8, 5.3, 10.2}, {2.2, 5.3, 10.8}), kHidden);
}

// An hourglass: in its middle the sheets are nearer to one another than a voxel is wide.
TEST(Sides, change_in_a_narrow_passage_without_hiding) {
  const Scene scene(together(sheet(10, 8), sheet(10.2, 12.2)), 0.3);
  EXPECT_NE(scene.verdict({2, 5.3, 8.6}, {38, 5.3, 11.6}), kHidden);
  EXPECT_NE(scene.verdict({2, 5.3, 11.6}, {38, 5.3, 8.6}), kHidden);
  EXPECT_EQ(scene.verdict({2, 5.3, 6}, {20, 5.3, 16}), kHidden);  // where they are well apart
}

TEST(Sides, tell_a_line_through_both_sheets) {
  const Scene scene(together(sheet(10, 10), sheet(10.9, 10.9)), 0.05);
  EXPECT_EQ(scene.verdict({5.1, 5.2, 5}, {25.3, 9.2, 16}), kHidden);
  EXPECT_EQ(scene.verdict({25.3, 9.2, 16}, {5.1, 5.2, 5}), kHidden);
}

// A steep line past the rim of a deck: the voxels of one column come in the order of the line, so that the
// rim lies between what is above it and what is below.
TEST(Sides, are_not_told_past_a_rim) {
  const Scene scene(together(sheet(10, 10), sheet(0, 0)), 0.1);
  for (const double off : {0.0, 0.03, 0.07, 0.11, 0.2}) {
    EXPECT_NE(scene.verdict({20.1, -off, 16}, {20.1, -off, 4}), kHidden) << off;
    EXPECT_NE(scene.verdict({20.1, -off - 0.05, 4}, {20.1, -off + 0.05, 16}), kHidden) << off;
  }
  EXPECT_EQ(scene.verdict({20.1, 0.5, 16}, {20.1, 0.5, 4}), kHidden);
}

}  // namespace
}  // namespace sightbound
