// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <map>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "support/bodies.h"
#include "terrain/tin_topology.h"
#include "volume/error_volume.h"
#include "volume/tin_surface.h"

namespace sightbound {
namespace {

using testing::nearest_by_hand;
using testing::NearestByHand;
using testing::winding;

struct Scene {
  Tin tin;
  TinError error;
  ErrorVolume volume;
  Xyz shift;  // from local coordinates to the Tin's
};

Scene scene_of(const Tin& tin, const TinError& error, double voxel, double height = 0, int threads = 1) {
  VolumeOptions options;
  options.voxel_m = voxel;
  options.voxel_height_m = height;
  options.threads = threads;
  Progress progress;
  const Box3 box = bounds_of(tin);
  return {tin,
          error,
          ErrorVolume::build(std::make_shared<TinSurface>(tin, error, Metric::kNormal), options, progress),
          {box.low.x, box.low.y, 0}};
}

// Places at random within a box around the terrain, half of them near its faces, at corners and faces of
// voxels too.
template <class F>
void for_places(const Scene& scene, unsigned seed, int count, double reach, const F& f) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const Box3 box = bounds_of(scene.tin);
  for (int n = 0; n < count; ++n) {
    Xyz x{box.low.x - reach + unit(random) * (box.high.x - box.low.x + 2 * reach),
          box.low.y - reach + unit(random) * (box.high.y - box.low.y + 2 * reach),
          box.low.z - reach + unit(random) * (box.high.z - box.low.z + 2 * reach)};
    if (n % 2 == 0) {  // off a place of a face
      const Face& face =
          scene.tin
              .faces[static_cast<std::size_t>(unit(random) * static_cast<double>(scene.tin.faces.size()))];
      double u = unit(random), v = unit(random);
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
      if (n % 6 == 0) u = 0;
      const auto at = [&](std::size_t i) { return scene.tin.vertices[static_cast<std::size_t>(face[i])]; };
      const auto off = [&] { return reach * (2 * unit(random) - 1); };
      x = at(0) + u * (at(1) - at(0)) + v * (at(2) - at(0)) + Xyz{off(), off(), off()};
    }
    Xyz local = x - scene.shift;
    const double side = scene.volume.voxel_m(), height = scene.volume.voxel_height_m();
    if (n % 5 == 0) local.x = std::round(local.x / side) * side;
    if (n % 7 == 0) local.y = std::round(local.y / side) * side;
    if (n % 11 == 0) local.z = std::round(local.z / height) * height;
    x = local + scene.shift;
    // A place between voxels belongs to all of them.
    const double hair = 1e-7;
    for (const double dx : {-hair, hair}) {
      const Voxel voxel = scene.volume.voxel_of(local + Xyz{dx, dx, dx});
      f(x, voxel, nearest_by_hand(scene.tin, scene.error, x));
    }
  }
}

void expect_within(const RatioInterval& bounds, double k, double most, const std::string& what) {
  ASSERT_LE(std::min(static_cast<double>(bounds.low), most), std::max(k, -most)) << what << " k " << k;
  ASSERT_GE(std::max(static_cast<double>(bounds.high), -most), std::min(k, most)) << what << " k " << k;
}

TEST(NearestFill, ClosedBodies) {
  std::size_t in_band = 0, inside = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    Tin tin = testing::rough_ball(seed, 20, seed % 3 == 0 ? 0.05 : 0.45);
    if (seed % 4 == 3) {  // long in one direction: thin faces
      for (Xyz& v : tin.vertices) v.z = 30 + 0.2 * (v.z - 30);
    }
    const TinError error =
        testing::random_error(tin, seed, 0.4, seed % 2 == 0 ? 2 : 0.5, seed % 3 == 1 ? 2 : 0);
    const double voxel = std::array{0.8, 1.5, 3.0}[seed % 3];
    const Scene scene = scene_of(tin, error, voxel, seed % 5 == 0 ? voxel / 2 : 0);
    ASSERT_EQ(scene.volume.surface().sides(), Sides::kSolid);
    EXPECT_EQ(scene.volume.report().ambiguous_voxels, 0u);
    const double most = scene.volume.largest_ratio();
    for_places(scene, seed, 1500, 6, [&](const Xyz& x, const Voxel& voxel_at, const NearestByHand& nearest) {
      const bool in = winding(tin, x) > 0.5;
      const double k = in ? -nearest.ratio : nearest.ratio;
      in_band += nearest.ratio < most;
      inside += in && nearest.ratio > most;
      expect_within(scene.volume.at(voxel_at), k, most, "seed " + std::to_string(seed));
    });
  }
  EXPECT_GT(in_band, 5000u);
  EXPECT_GT(inside, 1000u);
}

// The middle of a body larger than a leaf, and beyond, is inside by tiles.
TEST(NearestFill, InsideByTiles) {
  const Tin tin = testing::rough_ball(3, 20, 0.1);
  const Scene scene = scene_of(tin, testing::random_error(tin, 1, 0.05, 0.1, 0), 0.25);
  const float end = scene.volume.beyond_ratio();
  EXPECT_EQ(scene.volume.at(scene.volume.voxel_of(Xyz{50, 40, 30} - scene.shift)),
            (RatioInterval{-end, -end}));
  EXPECT_EQ(scene.volume.at(scene.volume.voxel_of(Xyz{50, 40, 60} - scene.shift)), (RatioInterval{end, end}));
}

// Edges of one face: the border of a sheet.
std::vector<std::array<Xyz, 2>> border_of(const Tin& tin) {
  std::map<std::pair<std::int32_t, std::int32_t>, int> uses;
  for (const Face& f : tin.faces) {
    for (std::size_t i = 0; i < 3; ++i) ++uses[std::minmax(f[i], f[(i + 1) % 3])];
  }
  std::vector<std::array<Xyz, 2>> border;
  for (const auto& [edge, count] : uses) {
    if (count != 1) continue;
    border.push_back({tin.vertices[static_cast<std::size_t>(edge.first)],
                      tin.vertices[static_cast<std::size_t>(edge.second)]});
  }
  return border;
}

bool lies_on(const std::vector<std::array<Xyz, 2>>& edges, const Xyz& place) {
  return std::any_of(edges.begin(), edges.end(), [&](const std::array<Xyz, 2>& edge) {
    const Xyz along = edge[1] - edge[0];
    const double t = std::clamp(dot(place - edge[0], along) / dot(along, along), 0.0, 1.0);
    return length(edge[0] + t * along - place) < 1e-9;
  });
}

// Above and below as the faces look; at borders both.
TEST(NearestFill, Sheets) {
  std::size_t at_border = 0, sided = 0, clear = 0, ambiguous = 0;
  for (unsigned seed = 0; seed < 8; ++seed) {
    const Tin tin = seed % 2 == 0 ? testing::bridge(seed) : testing::arch(seed % 4 == 1 ? 3 : 12, 15, 20);
    const TinError error = testing::random_error(tin, seed, 0.3, 0.8, seed % 3 == 1 ? 1 : 0);
    const Scene scene = scene_of(tin, error, seed % 3 == 0 ? 0.6 : 1.1);
    ASSERT_EQ(scene.volume.surface().sides(), Sides::kSheet);
    const double most = scene.volume.largest_ratio();
    const auto border = border_of(tin);
    for_places(scene, seed, 1500, 3, [&](const Xyz& x, const Voxel& voxel, const NearestByHand& nearest) {
      if (nearest.ratio > most) return;
      const RatioInterval bounds = scene.volume.at(voxel);
      if (lies_on(border, nearest.place)) {
        ++at_border;
        EXPECT_TRUE(scene.volume.is_ambiguous(voxel));
        expect_within(bounds, nearest.ratio, most, "border");
        expect_within(bounds, -nearest.ratio, most, "border");
        return;
      }
      // The faces that come as near all say which side; at a sharp fold they may differ, there either is as
      // good.
      bool above = false, below = false;
      for (const std::size_t f : nearest.faces) {
        const double height =
            dot(x - tin.vertices[static_cast<std::size_t>(tin.faces[f][0])], normal_of(tin, tin.faces[f]));
        above = above || height > 0;
        below = below || height < 0;
      }
      if (above == below) return;
      ++sided;
      ambiguous += scene.volume.is_ambiguous(voxel);
      clear += bounds.low > 0 || bounds.high < 0;
      expect_within(bounds, above ? nearest.ratio : -nearest.ratio, most, "seed " + std::to_string(seed));
    });
  }
  EXPECT_GT(at_border, 500u);
  EXPECT_GT(sided, 5000u);
  EXPECT_GT(clear, sided / 3);  // not all bounds reach across
  EXPECT_LT(ambiguous, sided / 4);
}

TEST(NearestFill, NothingIsInsideASheet) {
  const Tin tin = testing::arch(12, 15, 20);
  const Scene scene = scene_of(tin, testing::random_error(tin, 0, 0.3, 0.8, 0), 1);
  const float end = scene.volume.beyond_ratio();
  EXPECT_EQ(scene.volume.at(scene.volume.voxel_of(Xyz{15, 10, 8} - scene.shift)), (RatioInterval{end, end}));
}

// Masks hold what they say, in three dimensions.
TEST(NearestFill, CoversHoldAndMissNothing) {
  std::size_t held = 0, touched = 0;
  for (unsigned seed = 0; seed < 4; ++seed) {
    const Tin tin = testing::rough_ball(seed, 12, 0.2);
    const TinError error = testing::random_error(tin, seed, 1.5, 2.5, 0);
    const Scene scene = scene_of(tin, error, 0.9);
    const VolumeMask inner = scene.volume.inner(0.95), outer = scene.volume.outer(0.95);
    for_places(scene, seed, 3000, 7, [&](const Xyz&, const Voxel& voxel, const NearestByHand& nearest) {
      if (inner.contains(voxel)) {
        ++held;
        EXPECT_LE(nearest.ratio, 1.96);
        EXPECT_TRUE(outer.contains(voxel));
      }
      if (nearest.ratio <= 1.9599) {
        ++touched;
        EXPECT_TRUE(outer.contains(voxel));
      }
    });
  }
  EXPECT_GT(held, 1000u);
  EXPECT_GT(touched, held);
}

TEST(NearestFill, SameForAnyNumberOfThreads) {
  const Tin tin = testing::rough_ball(5, 20, 0.3);
  const TinError error = testing::random_error(tin, 2, 0.4, 2, 1);
  const Scene one = scene_of(tin, error, 0.8, 0, 1), two = scene_of(tin, error, 0.8, 0, 2);
  EXPECT_TRUE(one.volume.outer(0.99) == two.volume.outer(0.99));
  one.volume.outer(0.99).for_each([&](const Voxel& low, const Voxel& high) {
    for (Voxel v = low; v.k <= high.k; ++v.k) ASSERT_EQ(one.volume.at(v), two.volume.at(v));
  });
}

}  // namespace
}  // namespace sightbound
