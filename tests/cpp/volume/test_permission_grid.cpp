// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles against voxels: by exact whole-number overlap, and never true where a place lies outside.
#include <array>
#include <cmath>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "support/distance_oracle.h"
#include "support/tins.h"
#include "volume/error_volume.h"
#include "volume/permission_grid.h"
#include "volume/tin_surface.h"
#include "volume/triangle_box.h"

namespace sightbound {
namespace {

using Triangle = std::array<Xyz, 3>;

Triangle random_triangle(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> unit(-size, size);
  Triangle t;
  for (Xyz& p : t) p = {unit(random), unit(random), unit(random)};
  return t;
}

// By cutting the triangle with the cube's six sides: does anything remain?
bool touches_by_clipping(const Triangle& t, const Xyz& low, double size) {
  std::vector<Xyz> polygon(t.begin(), t.end());
  for (int side = 0; side < 6; ++side) {
    const double sign = side % 2 == 0 ? 1 : -1;
    const auto coordinate = [&](const Xyz& p) { return side / 2 == 0 ? p.x : side / 2 == 1 ? p.y : p.z; };
    const double limit = sign > 0 ? coordinate(low) : -(coordinate(low) + size);
    std::vector<Xyz> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Xyz &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const double da = sign * coordinate(a) - limit, db = sign * coordinate(b) - limit;
      if (da >= 0) kept.push_back(a);
      if ((da > 0 && db < 0) || (da < 0 && db > 0)) kept.push_back(a + (da / (da - db)) * (b - a));
    }
    polygon = kept;
  }
  return !polygon.empty();
}

TEST(TriangleInVoxels, TouchesWhatClippingLeaves) {
  std::mt19937 random(1);
  constexpr double kSlack = 1e-9;
  std::size_t touched = 0, all = 0;
  for (int n = 0; n < 300; ++n) {
    Triangle t = random_triangle(random, 6);
    if (n % 5 == 1) t[2] = t[0] + 0.3 * (t[1] - t[0]);              // a line
    if (n % 5 == 2) t[0].z = t[1].z = t[2].z = std::round(t[0].z);  // in a lattice plane
    if (n % 5 == 3) t[1] = t[2] = t[0];                             // a point
    if (n % 5 == 4) t[2] = {t[0].x, t[0].y, t[2].z};                // upright
    const TriangleInVoxels in_voxels(t, kSlack);
    for (int i = -7; i < 7; ++i) {
      for (int j = -7; j < 7; ++j) {
        for (int k = -7; k < 7; ++k) {
          const Xyz low{double(i), double(j), double(k)};
          const bool found = in_voxels.touches({i, j, k}, 1);
          if (touches_by_clipping(t, low, 1)) {
            EXPECT_TRUE(found) << n;
          }
          const Xyz wider{i - 1e-8, j - 1e-8, k - 1e-8};
          if (!touches_by_clipping(t, wider, 1 + 2e-8)) {
            EXPECT_FALSE(found) << n;
          }
          touched += found;
          ++all;
        }
      }
    }
  }
  EXPECT_GT(touched, all / 100);
}

TEST(PermissionGrid, HoldsNoTriangleWithAPlaceOutside) {
  const Tin tin = testing::box({0, 0, 0}, {20, 12, 9});
  TinError error;
  error.sampling.assign(tin.vertices.size(), 1.0F);
  error.spacing_m = 9;
  const auto surface = std::make_shared<TinSurface>(tin, error, Metric::kNormal);
  VolumeOptions options;
  options.voxel_m = 0.35;
  Progress progress;
  const CoverMasks covers = build_covers(surface, 0.95, options, progress);
  const PermissionGrid grid(covers.inner, covers.voxel_m, covers.voxel_height_m);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t held = 0, checked = 0;
  for (int n = 0; n < 4000; ++n) {
    // On or near a side of the box.
    Triangle t;
    const double level = (n % 2 == 0 ? 0.0 : 9.0);
    for (Xyz& p : t) p = {20 * unit(random), 12 * unit(random), level + 4.5 * (unit(random) - 0.5)};
    if (!grid.holds(t)) continue;
    ++held;
    testing::for_places(t, 12, [&](const Xyz& p) {
      EXPECT_LE(testing::distance_to_tin(tin, p), 1.96);
      const Voxel v{int(std::floor(p.x / grid.voxel_m())), int(std::floor(p.y / grid.voxel_m())),
                    int(std::floor(p.z / grid.voxel_height_m()))};
      EXPECT_TRUE(covers.inner.contains(v));
      ++checked;
    });
  }
  EXPECT_GT(held, 200U);
  EXPECT_GT(checked, 10000U);
}

TEST(PermissionGrid, HoldsWhatLiesDeepInside) {
  const Tin tin = testing::triangle();
  TinError error;
  error.sampling.assign(3, 1.0F);
  error.spacing_m = 10;
  const auto surface = std::make_shared<TinSurface>(tin, error, Metric::kNormal);
  VolumeOptions options;
  options.voxel_m = 0.4;
  Progress progress;
  const CoverMasks covers = build_covers(surface, 0.95, options, progress);
  const PermissionGrid grid(covers.inner, covers.voxel_m, covers.voxel_height_m);
  const double room = 1.95 - 0.4 * std::sqrt(3.0);
  EXPECT_TRUE(grid.holds({Xyz{0, 0, 0}, Xyz{10, 0, 0}, Xyz{0, 10, 0}}));
  EXPECT_TRUE(grid.holds({Xyz{0, 0, room}, Xyz{10, 0, -room}, Xyz{0, 10, room}}));
  EXPECT_FALSE(grid.holds({Xyz{0, 0, 0}, Xyz{10, 0, 0}, Xyz{0, 10, 2.1}}));
  EXPECT_FALSE(grid.holds({Xyz{0, 0, 0}, Xyz{10, 0, 0}, Xyz{10, 10, 0}}));  // its middle is, its corner not
}

}  // namespace
}  // namespace sightbound
