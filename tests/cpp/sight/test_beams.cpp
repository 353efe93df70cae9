// SPDX-License-Identifier: GPL-3.0-or-later
// What is proven of all lines between two boxes, against lines drawn from them at random.
#include <array>
#include <random>

#include <gtest/gtest.h>

#include "sight/volume_sight.h"
#include "support/rolling_ground.h"
#include "volume/tin_surface.h"

namespace sightbound {
namespace {

using testing::kBent;
using testing::Lines;
using testing::RandomDem;
using testing::rolling_dem;
using testing::volume_of;

class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  double between(double a, double b) { return std::uniform_real_distribution(a, b)(random_); }
  Xyz within(const Box3& box) {
    return {between(box.low.x, box.high.x), between(box.low.y, box.high.y), between(box.low.z, box.high.z)};
  }
  // Somewhere over the ground, `half` as large as asked at most.
  Box3 box(const RandomDem& dem, const Box3& bounds, double half, double least_up, double most_up) {
    const Xyz room{between(0, half), between(0, half), between(0, half / 2)};
    const double x = between(room.x, bounds.high.x - room.x), y = between(room.y, bounds.high.y - room.y);
    const Xyz middle{x, y, dem.place(x, y).height + between(least_up, most_up)};
    return {middle - room, middle + room};
  }

 private:
  std::mt19937 random_;
};

TEST(Beams, prove_of_every_line_what_it_has) {
  int blocked = 0, doubtful = 0, finer = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    const RandomDem dem = rolling_dem(seed);
    const ErrorVolume volume = volume_of(dem.surface(), seed % 3 == 1 ? 0.5 : 1.5, 0.5);
    const VolumeRays rays(volume);
    const VolumeSight sight(rays, kBent);
    const double zone = 1.5 * volume.surface().spacing_m();
    Draw draw(seed);
    for (int n = 0; n < 300; ++n) {
      const double half = n % 3 == 0 ? 0 : n % 3 == 1 ? 2 : 15;
      const Box3 from = draw.box(dem, volume.surface().bounds(), half, -2, 12),
                 to = draw.box(dem, volume.surface().bounds(), half, -2, 12);
      const double ratio = std::array{0.5, 1.96, 3.2}[static_cast<std::size_t>(n / 3 % 3)];
      const bool coarse_block = sight.blocked(from, to, ratio, Grain::kBlocks),
                 block = sight.blocked(from, to, ratio, Grain::kVoxels),
                 doubt = sight.doubtful(from, to, ratio, Grain::kVoxels);
      EXPECT_LE(coarse_block, block) << seed << " " << n;
      EXPECT_LE(sight.doubtful(from, to, ratio, Grain::kBlocks), doubt) << seed << " " << n;
      finer += block && !coarse_block;
      blocked += block;
      doubtful += doubt;
      if (!block && !doubt) continue;
      for (int i = 0; i < 40; ++i) {
        const Xyz a = draw.within(from), b = draw.within(to);
        const VolumeLine line{a, b, kBent.drop(b.x - a.x, b.y - a.y)};
        const double share = zone / std::hypot(b.x - a.x, b.y - a.y);
        const RatioInterval k = rays.least(line, share, 1 - share);
        if (block) {
          EXPECT_LE(k.high, -ratio + 1e-3) << seed << " " << n << " " << i;
        }
        if (doubt) {
          EXPECT_LE(k.low, ratio + 1e-3) << seed << " " << n << " " << i;
        }
      }
    }
  }
  EXPECT_GT(blocked, 300);
  EXPECT_GT(doubtful, 1000);
  EXPECT_GT(finer, 50);
}

// The other engine judges lines drawn from the two rooms.
TEST(Beams, are_clear_only_when_all_lines_are) {
  int clear = 0, coarsely = 0, hidden = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    const RandomDem dem = rolling_dem(seed);
    const auto surface = dem.surface();
    const ErrorVolume volume = volume_of(surface, 1, 0.5);
    const VolumeRays rays(volume);
    const VolumeSight sight(rays, kBent);
    Draw draw(seed);
    const auto col_row = [&](const Xyz& at) {
      return Xy{at.x / dem.cell_x, (at.y + dem.cell_y * (dem.rows - 1)) / dem.cell_y};
    };
    for (int n = 0; n < 90; ++n) {
      const double half = n % 2 ? 0 : 1.5, ratio = n % 3 ? 1.96 : 0.5;
      const Box3 from = draw.box(dem, surface->bounds(), half, 2, 25),
                 to = draw.box(dem, surface->bounds(), n % 4 < 2 ? 1.5 : 12, 2, 25);
      const auto room = [&](const Box3& box) {
        return sight.room(0.5 * (box.low + box.high), 0.5 * (box.high - box.low));
      };
      const bool fine = sight.clear(room(from), room(to), ratio), coarse = sight.clear(room(from), to, ratio);
      const bool block = sight.blocked(room(from), room(to), ratio);
      EXPECT_FALSE((fine || coarse) && block);
      clear += fine;
      coarsely += coarse;
      hidden += block;
      if (!fine && !coarse && !block) continue;
      for (int a = 0; a < 3; ++a) {
        const Xyz eye = draw.within(from);
        const Xy at = col_row(eye);
        const Lines other(dem, at.x, at.y, eye.z, true);
        for (int b = 0; b < 12; ++b) {
          const Xyz place = draw.within(to);
          const Xy target = col_row(place);
          const double k = other.ratio(target.x, target.y, place.z);
          if (block) {
            EXPECT_LT(k, ratio) << seed << " "
                                << n;  // of which one is sure, the other is not of the opposite
          } else {
            EXPECT_GE(k, ratio - 1e-4) << seed << " " << n;
          }
        }
      }
    }
  }
  EXPECT_GT(clear, 60);
  EXPECT_GT(coarsely, 30);
  EXPECT_GT(hidden, 30);
}

// Lines past a deck are clear, those through it are not; sheets are too thin for beams to be blocked.
TEST(Beams, are_clear_past_a_sheet) {
  Tin deck;
  deck.vertices = {{0, 0, 6}, {20, 0, 6}, {20, 8, 6}, {0, 8, 6}, {0, 8, 7}, {20, 8, 7}};
  deck.faces = {{0, 1, 2}, {0, 2, 3}, {3, 2, 5}, {3, 5, 4}};
  TinError error;
  error.sampling.assign(deck.vertices.size(), 0.1f);
  error.profile.half_spacing_m = 1;
  error.spacing_m = 0.5;
  const auto surface = std::make_shared<TinSurface>(std::move(deck), std::move(error), Metric::kNormal);
  const ErrorVolume volume = volume_of(surface, 0.1);
  const VolumeRays rays(volume);
  const VolumeSight sight(rays, GroundBend{});
  const Xyz shift = surface->vertex(0) - surface->tin().vertices[0];
  const auto box = [&](const Xyz& middle, double half) {
    const Xyz room{half, half, half};
    return Box3{middle + shift - room, middle + shift + room};
  };
  const auto room = [&](const Box3& b) { return sight.room(0.5 * (b.low + b.high), 0.5 * (b.high - b.low)); };
  const Box3 below = box({4, 4, 1}, 0.4), above = box({16, 4, 11}, 0.4);
  EXPECT_FALSE(sight.clear(room(below), room(above), 1.96));
  EXPECT_FALSE(sight.blocked(below, above, 1.96, Grain::kVoxels));
  const Box3 south = box({10, -10, 3}, 0.4), north = box({10, 18, 3}, 0.4);
  EXPECT_TRUE(sight.clear(room(south), room(north), 1.96));
  const Box3 level = box({-10, 4, 5}, 2), beyond = box({30, 4, 5}, 2);
  EXPECT_FALSE(sight.clear(room(level), room(beyond), 1.96));  // some under it, some through
}

TEST(Beams, prove_nothing_where_the_boxes_overlap) {
  const RandomDem dem = rolling_dem(1);
  const ErrorVolume volume = volume_of(dem.surface(), 1);
  const VolumeRays rays(volume);
  const VolumeSight sight(rays, kBent);
  const Box3 box{{10, 10, 0}, {90, 90, 400}};
  EXPECT_FALSE(sight.blocked(box, box, 0.5, Grain::kVoxels));
  EXPECT_FALSE(sight.doubtful(box, box, 3, Grain::kVoxels));
}

}  // namespace
}  // namespace sightbound
