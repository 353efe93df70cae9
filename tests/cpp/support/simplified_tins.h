// SPDX-License-Identifier: GPL-3.0-or-later
// TINs to simplify, simplified in the permission grid, and whether what comes out is sound.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "simplify/both_ways.h"
#include "simplify/simplify_tin.h"
#include "support/bodies.h"
#include "support/distance_oracle.h"
#include "support/tins.h"
#include "volume/error_volume.h"
#include "volume/tin_surface.h"

namespace sightbound::testing {

inline constexpr double kZ = 1.959963984540054;

// Faces cut into four, `times` times.
inline Tin finer(Tin tin, int times) {
  for (; times > 0; --times) {
    const std::vector<Face> faces = std::move(tin.faces);
    tin.faces.clear();
    std::map<std::array<std::int32_t, 2>, std::int32_t> middles;
    const auto middle = [&](std::int32_t a, std::int32_t b) {
      const auto [found, made] = middles.try_emplace({std::min(a, b), std::max(a, b)}, 0);
      if (made) {
        found->second = static_cast<std::int32_t>(tin.vertices.size());
        tin.vertices.push_back(0.5 * (tin.vertices[std::size_t(a)] + tin.vertices[std::size_t(b)]));
      }
      return found->second;
    };
    for (const Face& f : faces) {
      const std::int32_t a = middle(f[0], f[1]), b = middle(f[1], f[2]), c = middle(f[2], f[0]);
      for (const Face& part : {Face{f[0], a, c}, Face{f[1], b, a}, Face{f[2], c, b}, Face{a, b, c}})
        tin.faces.push_back(part);
    }
  }
  return tin;
}

inline Tin shaken(Tin tin, unsigned seed, double size) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-size, size);
  for (Xyz& v : tin.vertices) v = v + Xyz{unit(random), unit(random), unit(random)};
  return tin;
}

enum class Ways { kForward, kBoth };

// Distance to the original at most the tolerance (at each vertex), voxels of that size.
inline TinSimplified simplified(const Tin& tin, const std::vector<float>& tolerance, double voxel,
                                const TinSimplifyOptions& options = {}, int threads = 1,
                                Ways ways = Ways::kBoth) {
  TinError error;
  for (const float metres : tolerance)
    error.sampling.push_back(std::nextafter(metres / static_cast<float>(kZ), 0.0F));
  error.spacing_m = 1;
  const auto surface = std::make_shared<TinSurface>(tin, error, Metric::kNormal);
  VolumeOptions volume;
  volume.voxel_m = voxel;
  volume.threads = threads;
  Progress progress;
  CoverMasks covers = build_covers(surface, 0.95, volume, progress);
  GridContainment grid(PermissionGrid(covers.inner, covers.voxel_m, covers.voxel_height_m),
                       tin.vertices[0] - surface->vertex(0));
  BothWays both_ways(tin, tolerance, grid);
  Containment& containment = ways == Ways::kBoth ? static_cast<Containment&>(both_ways) : grid;
  return simplify_tin(tin, containment, options, progress);
}

inline TinSimplified simplified(const Tin& tin, double tolerance, double voxel,
                                const TinSimplifyOptions& options = {}, int threads = 1,
                                Ways ways = Ways::kBoth) {
  const std::vector<float> same(tin.vertices.size(), static_cast<float>(tolerance));
  return simplified(tin, same, voxel, options, threads, ways);
}

inline TinSimplified with_nothing_allowed(const Tin& tin, const TinSimplifyOptions& options = {}) {
  Progress progress;
  NothingContained nothing;
  return simplify_tin(tin, nothing, options, progress);
}

// No face without area, none doubled, no vertex unused.
inline void expect_sound(const Tin& tin) {
  std::set<std::array<std::int32_t, 3>> seen;
  std::set<std::int32_t> used;
  for (const Face& f : tin.faces) {
    const auto t = triangle_of(tin, f);
    EXPECT_GT(length(cross(t[1] - t[0], t[2] - t[0])), 0);
    std::array<std::int32_t, 3> sorted = f;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_TRUE(seen.insert(sorted).second);
    used.insert(f.begin(), f.end());
  }
  EXPECT_EQ(used.size(), tin.vertices.size());
}

struct Body {
  const char* name;
  Tin tin;
  double tolerance, voxel;
};

inline std::vector<Body> bodies() {
  return {{"building", shaken(finer(box({0, 0, 0}, {20, 12, 9}), 3), 1, 0.05), 0.6, 0.2},
          {"arch", shaken(finer(arch(10, 8, 9), 2), 2, 0.03), 0.5, 0.18},
          {"bridge over ground", shaken(finer(bridge(3), 1), 3, 0.05), 1.5, 0.5},
          {"ball", finer(rough_ball(4, 10, 0.1), 2), 0.8, 0.25}};
}

// Two faces to each square of 2 m, heights from 0 to `relief`.
inline Tin rough_lattice(int across, unsigned seed, double relief) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, relief);
  Tin tin;
  for (int r = 0; r <= across; ++r) {
    for (int c = 0; c <= across; ++c) tin.vertices.push_back({2.0 * c, 2.0 * r, unit(random)});
  }
  for (int r = 0; r < across; ++r) {
    for (int c = 0; c < across; ++c) {
      const std::int32_t a = r * (across + 1) + c, b = a + 1, d = a + across + 1, e = d + 1;
      tin.faces.push_back({a, b, e});
      tin.faces.push_back({a, e, d});
    }
  }
  return tin;
}

}  // namespace sightbound::testing
