// SPDX-License-Identifier: GPL-3.0-or-later
// Sight in the volume against the other engine, against the definition sampled along the line, and on scenes
// whose answer is known by construction.
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "sight/volume_sight.h"
#include "support/rolling_ground.h"
#include "volume/tin_surface.h"

namespace sightbound {
namespace {

using testing::kBent;
using testing::kPlane;
using testing::Lines;
using testing::RandomDem;
using testing::rolling_dem;
using testing::volume_of;

// Guarantee V5: the engines differ only where one says uncertain. And the volume's bounds hold what the other
// engine's judged places say, since they are among the places of the line.
TEST(VolumeSight, agrees_with_the_other_engine_on_height_fields) {
  int visible = 0, hidden = 0, both_sure = 0, lines = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    const RandomDem dem = rolling_dem(seed);
    const bool curvature = seed % 2 == 0;
    const auto surface = dem.surface();
    const ErrorVolume volume = volume_of(surface, seed % 3 == 1 ? 0.5 : 1.0, 0.25);
    const VolumeRays rays(volume);
    const VolumeSight sight(rays, curvature ? kBent : kPlane);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    const auto place = [&](double col, double row, double z) {
      const Xy plan = surface->place_of(col, row);
      return Xyz{plan.x, plan.y, z};
    };
    const double col = unit(random) * (dem.cols - 1), row = unit(random) * (dem.rows - 1);
    const Xyz eye_plan = place(col, row, 0);
    const double eye = dem.place(eye_plan.x, eye_plan.y).height + 1 + 15 * unit(random);
    const Lines other(dem, col, row, eye, curvature);
    const EndZone from = sight.zone(place(col, row, eye));
    for (int n = 0; n < 400; ++n, ++lines) {
      const double to_col = unit(random) * (dem.cols - 1), to_row = unit(random) * (dem.rows - 1);
      const Xyz plan = place(to_col, to_row, 0);
      const double top = dem.place(plan.x, plan.y).height + (n % 2 ? 0.1 : 12 * unit(random));
      const RatioInterval k = sight.ratio(from, sight.zone(place(to_col, to_row, top)));
      ASSERT_LE(k.low, k.high);
      const double exact = other.ratio(to_col, to_row, top);
      const std::uint8_t mine = verdict_of(k, 1.96), theirs = verdict_of({float(exact), float(exact)}, 1.96);
      EXPECT_NE(std::abs(int(mine) - int(theirs)), 2)
          << seed << " " << n << " " << k.low << ".." << k.high << " " << exact;
      // Beyond K nothing more is said.
      EXPECT_LE(std::clamp(double(k.low), -3.29, 3.29), exact + 1e-4) << seed << " " << n;
      visible += mine == kVisible;
      hidden += mine == kHidden;
      both_sure += mine != kUncertain && theirs != kUncertain;
    }
  }
  EXPECT_GT(visible, lines / 20);
  EXPECT_GT(hidden, lines / 20);
  EXPECT_GT(both_sure, lines / 5);
}

// Up to 10 m above the ground.
Xyz place_above(const RandomDem& dem, const Box3& box, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  const double x = unit(random) * box.high.x, y = unit(random) * box.high.y;
  return {x, y, dem.place(x, y).height + 10 * unit(random)};
}

// Guarantee V1 for this engine: bounds hold k of every place between the end zones.
TEST(VolumeSight, bounds_hold_the_definition_along_the_line) {
  int judged = 0;
  for (unsigned seed = 0; seed < 8; ++seed) {
    const RandomDem dem = rolling_dem(seed);
    const ErrorVolume volume = volume_of(dem.surface(), 1.0, 0.5);
    const VolumeRays rays(volume);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    const auto somewhere = [&] { return place_above(dem, volume.surface().bounds(), random); };
    for (int n = 0; n < 60; ++n) {
      const VolumeLine line{somewhere(), somewhere(), 3 * unit(random)};
      const RatioInterval k = rays.least(line, 0.1, 0.9);
      double least = volume.largest_ratio();
      constexpr int kSamples = 4000;
      for (int i = 0; i <= kSamples; ++i) {
        const Xyz at = line.at(0.1 + 0.8 * i / kSamples);
        least = std::min(least, dem.k(at.x, at.y, at.z));
      }
      const double most = volume.largest_ratio();
      least = std::max(least, -most);
      EXPECT_LE(std::clamp(double(k.low), -most, most), least + 1e-6) << seed << " " << n;
      EXPECT_GE(std::clamp(double(k.high), -most, most), least - 0.02)
          << seed << " " << n;  // samples lie 1 / 4000 of the line apart
      judged += std::abs(least) < volume.largest_ratio();
      const double first = rays.first(line, 1.0, 0.1, 0.9);
      EXPECT_EQ(first <= 1, k.low < 1) << seed << " " << n;
    }
  }
  EXPECT_GT(judged, 100);
}

// A hint says where to look first, not what is found.
TEST(VolumeSight, hints_change_no_bounds) {
  int known = 0, hidden = 0;
  for (unsigned seed = 0; seed < 4; ++seed) {
    const RandomDem dem = rolling_dem(seed);
    const ErrorVolume volume = volume_of(dem.surface(), 1.0, 0.5);
    const VolumeRays rays(volume);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    const auto somewhere = [&] { return place_above(dem, volume.surface().bounds(), random); };
    for (int n = 0; n < 200; ++n) {
      const VolumeLine line{somewhere(), somewhere(), 3 * unit(random)};
      const LeastOnLine plain = rays.least_near(line, 0.1, 0.9, VolumeRays::kNever),
                        hinted = rays.least_near(line, 0.1, 0.9, 1.2 * unit(random) - 0.1);
      const auto most = static_cast<float>(volume.largest_ratio());
      if (plain.k.high > -most) {
        EXPECT_EQ(hinted.k, plain.k) << seed << " " << n;
        ++known;
      } else {
        EXPECT_LE(hinted.k.high, -most) << seed << " " << n;
        ++hidden;
      }
      if (plain.at > 1) continue;
      const LeastOnLine at_it = rays.least_near(line, 0.1, 0.9, plain.at);
      EXPECT_LE(std::abs(at_it.at - plain.at), 1e-9 + 2 * std::sqrt(2.0) / plan_length(line))
          << seed << " " << n;
    }
  }
  EXPECT_GT(known, 100);
  EXPECT_GT(hidden, 100);
}

// Guarantees V4 and V3: other voxels and the other direction may be less sure, never of the opposite.
TEST(VolumeSight, smaller_voxels_and_the_way_back_never_swap_verdicts) {
  int sure = 0, lines = 0;
  for (unsigned seed = 0; seed < 6; ++seed) {
    const RandomDem dem = rolling_dem(seed);
    const auto surface = dem.surface();
    const ErrorVolume fine = volume_of(surface, 0.7, 0.3), coarse = volume_of(surface, 2.5, 1);
    const VolumeRays fine_rays(fine), coarse_rays(coarse);
    const VolumeSight sights[] = {VolumeSight(fine_rays, kBent), VolumeSight(coarse_rays, kBent)};
    std::mt19937 random(seed + 100);
    std::uniform_real_distribution<double> unit(0, 1);
    const Box3 box = surface->bounds();
    const auto somewhere = [&](double up) {
      const double x = unit(random) * box.high.x, y = unit(random) * box.high.y;
      return Xyz{x, y, dem.place(x, y).height + up * unit(random)};
    };
    for (int n = 0; n < 300; ++n, ++lines) {
      const Xyz from = somewhere(20), to = somewhere(8);
      bool seen = false, hidden = false;
      for (const VolumeSight& sight : sights) {
        for (const bool back : {false, true}) {
          const RatioInterval k = sight.ratio(sight.zone(back ? to : from), sight.zone(back ? from : to));
          seen = seen || verdict_of(k, 1.96) == kVisible;
          hidden = hidden || verdict_of(k, 1.96) == kHidden;
        }
      }
      EXPECT_FALSE(seen && hidden) << seed << " " << n;
      sure += seen || hidden;
    }
  }
  EXPECT_GT(sure, lines / 3);
}

// ---- scenes known by construction

Tin box_tin(double x0, double y0, double z0, double x1, double y1, double z1) {
  Tin tin;
  for (const double z : {z0, z1}) {
    for (const double y : {y0, y1}) {
      for (const double x : {x0, x1}) tin.vertices.push_back({x, y, z});
    }
  }
  tin.faces = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
               {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return tin;
}

std::shared_ptr<const TinSurface> surface_of(Tin tin, double sigma) {
  TinError error;
  error.sampling.assign(tin.vertices.size(), static_cast<float>(sigma));
  error.profile.half_spacing_m = 1;
  error.spacing_m = 0.5;
  const Metric metric = TinSurface::metric_of(tin);
  return std::make_shared<TinSurface>(std::move(tin), std::move(error), metric);
}

struct Expected {
  const char* what;
  Xyz from, to;
  std::uint8_t verdict;
};

void expect_verdicts(const std::shared_ptr<const TinSurface>& surface, double voxel,
                     const std::vector<Expected>& lines) {
  const ErrorVolume volume = volume_of(surface, voxel);
  const VolumeRays rays(volume);
  const VolumeSight sight(rays, kPlane);
  const Xyz shift = surface->vertex(0) - surface->tin().vertices[0];
  for (const Expected& line : lines) {
    const RatioInterval there = sight.ratio(sight.zone(line.from + shift), sight.zone(line.to + shift));
    const RatioInterval back = sight.ratio(sight.zone(line.to + shift), sight.zone(line.from + shift));
    EXPECT_EQ(verdict_of(there, 1.96), line.verdict)
        << line.what << ": k in " << there.low << " .. " << there.high;
    EXPECT_EQ(verdict_of(back, 1.96), line.verdict) << line.what << ", back";
  }
}

// A bridge's deck alone: a sheet 20 m long and 8 m wide, 6 m up.
TEST(VolumeSight, a_deck_hides_what_lies_beyond_it_and_nothing_else) {
  Tin deck;
  deck.vertices = {{0, 0, 6}, {20, 0, 6}, {20, 8, 6}, {0, 8, 6}};
  deck.faces = {{0, 1, 2}, {0, 2, 3}};
  // Tilted a little, so that it is a sheet and not a height field on level ground.
  deck.vertices.push_back({0, 8, 7});
  deck.vertices.push_back({20, 8, 7});
  deck.faces.push_back({3, 2, 5});
  deck.faces.push_back({3, 5, 4});
  expect_verdicts(surface_of(deck, 0.1), 0.1,
                  {{"under it, across", {10, -10, 3}, {10, 18, 3}, kVisible},
                   {"under it, along", {-10, 4, 3}, {30, 4, 3}, kVisible},
                   {"over it", {10, -10, 9}, {10, 18, 9}, kVisible},
                   {"through it from above", {10, 4, 12}, {10, 4.5, 0}, kHidden},
                   {"through it from below, aslant", {4, 4, 1}, {16, 4, 11}, kHidden},
                   {"both below, close to it", {2, 4, 5}, {18, 4, 5}, kVisible},
                   {"along its edge", {-10, 0, 6}, {30, 0, 6}, kUncertain}});
}

// A closed block with a tunnel's worth of air beside it.
TEST(VolumeSight, a_block_hides_what_stands_behind_it) {
  expect_verdicts(surface_of(box_tin(0, 0, 0, 10, 6, 8), 0.1), 0.1,
                  {{"through it", {-10, 3, 4}, {20, 3, 4}, kHidden},
                   {"past its side", {-10, 8, 4}, {20, 8, 4}, kVisible},
                   {"over it", {-10, 3, 9}, {20, 3, 9}, kVisible},
                   {"under it", {-10, 3, -2}, {20, 3, -2}, kVisible},
                   {"grazing its roof", {-10, 3, 8.1}, {20, 3, 8.1}, kUncertain},
                   {"cutting a corner by much", {-3, 5, 4}, {5, -3, 4}, kHidden}});
}

// A cave: four walls and a roof, open to the west.
TEST(VolumeSight, a_cave_is_seen_into_through_its_mouth_only) {
  Tin cave;
  cave.vertices = {{0, 0, 0}, {20, 0, 0}, {20, 10, 0}, {0, 10, 0},
                   {0, 0, 6}, {20, 0, 6}, {20, 10, 6}, {0, 10, 6}};
  cave.faces = {{0, 1, 4}, {1, 5, 4}, {1, 2, 5}, {2, 6, 5}, {2, 3, 6}, {3, 7, 6}, {4, 5, 6}, {4, 6, 7}};
  expect_verdicts(surface_of(cave, 0.1), 0.1,
                  {{"in through the mouth", {-15, 5, 3}, {15, 5, 3}, kVisible},
                   {"through the south wall", {10, -10, 3}, {10, 5, 3}, kHidden},
                   {"through both walls", {10, -10, 3}, {10, 20, 3}, kHidden},
                   {"through the roof", {10, 5, 12}, {10, 5.5, 3}, kHidden},
                   {"within", {2, 2, 2}, {17, 8, 4}, kVisible}});
}

TEST(VolumeSight, proves_no_more_than_its_bounds) {
  EXPECT_EQ(proven_probability({-0.5f, 0.5f}, Tails::kNormal), 0.5);
  EXPECT_NEAR(proven_probability({1.0f, 2.0f}, Tails::kNormal), 0.8413, 1e-4);
  EXPECT_NEAR(proven_probability({-2.0f, -1.0f}, Tails::kNormal), 0.1587, 1e-4);
  EXPECT_EQ(verdict_of({1.97f, 3}, 1.96), kVisible);
  EXPECT_EQ(verdict_of({1.95f, 3}, 1.96), kUncertain);
  EXPECT_EQ(verdict_of({-3, -1.97f}, 1.96), kHidden);
}

}  // namespace
}  // namespace sightbound
