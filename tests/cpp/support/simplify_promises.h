// SPDX-License-Identifier: GPL-3.0-or-later
// What the simplifier promises, held against the oracle; and small terrains to hold it on.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "simplify/simplify.h"
#include "support/overlay_oracle.h"
#include "support/terrains.h"

namespace sightbound::testing {

// What rounding adds to an area in raster coordinates, cells.
inline constexpr double kNoArea = 1e-6;
// What it adds to the oracle's heights, metres: 2^-63 of them, not more than a dozen times.
inline constexpr double kNoHeight = 1e-15;

inline DemTerrain terrain_of(const Grid<float>& heights, const std::array<double, 6>& map = kNorthUp) {
  return {heights, Geotransform(map), 1, ""};
}

inline SimplifyOptions within(double tolerance) {
  SimplifyOptions options;
  options.tolerance_m = tolerance;
  return options;
}

inline SimplifiedTin simplified(const DemTerrain& terrain, const SimplifyOptions& options) {
  Progress progress;
  return simplify_dem(terrain, options, progress);
}

inline double tolerance_at(const SimplifyOptions& options, int r, int c) {
  return options.tolerance.empty() ? options.tolerance_m : options.tolerance.at(r, c);
}

// Every promise of the header, by the oracle.
inline OverlayReport expect_kept(const DemTerrain& terrain, const SimplifyOptions& options,
                                 const SimplifiedTin& made) {
  const OverlayReport seen = overlay_report(
      terrain.heights, terrain.geotransform, [&](int r, int c) { return tolerance_at(options, r, c); },
      made.tin);
  EXPECT_LE(seen.excess, kNoHeight);
  EXPECT_GE(made.report.largest_deviation_m, seen.deviation - kNoHeight);  // S5
  EXPECT_GE(made.report.largest_ratio, seen.ratio);
  EXPECT_LT(seen.uncovered, kNoArea);
  EXPECT_LT(std::abs(seen.outside), kNoArea);
  EXPECT_LT(seen.overlap, kNoArea);
  EXPECT_EQ(seen.not_up, 0U);
  EXPECT_EQ(seen.non_manifold, 0U);
  EXPECT_EQ(made.report.faces_after, made.tin.faces.size());
  EXPECT_LE(made.report.faces_after, made.report.faces_before);
  return seen;
}

struct Scene {
  std::string name;
  Grid<float> heights;
};

inline std::vector<Scene> scenes() {
  std::vector<Scene> all;
  const auto add = [&](const char* name, int rows, int cols, const std::function<double(int, int)>& f) {
    all.push_back({name, grid_from(rows, cols, f)});
  };
  add("hills", 40, 33, [](int r, int c) { return hills(r, c, 0.8, 1); });
  add("rough", 21, 30, [](int r, int c) { return 30 * noise(r, c, 2); });
  add("a plain", 12, 17, [](int, int) { return 7.25; });
  add("a slope", 15, 15, [](int r, int c) { return 0.1 * r - 0.3 * c; });
  add("terraces", 26, 26, [](int r, int c) { return std::floor(hills(r, c, 1.2, 3) / 8) * 8; });
  add("a spike", 17, 19, [](int r, int c) { return r == 8 && c == 9 ? 100 : 0; });
  add("a ridge", 20, 20, [](int r, int c) { return -std::abs(r - c); });
  add("one square", 2, 2, [](int r, int c) { return r + 2 * c; });
  add("a strip", 2, 40, [](int r, int c) { return 5 * noise(r, c, 4); });
  add("one triangle", 2, 2,
      [](int r, int c) { return r == 1 && c == 0 ? kNan : 3.0f + static_cast<float>(c); });
  add("a hole", 24, 24,
      [](int r, int c) { return std::hypot(r - 11, c - 12) < 5 ? kNan : hills(r, c, 0.8, 5); });
  add("islands", 24, 31,
      [](int r, int c) { return noise(r / 4, c / 4, 6) < 0.4 ? kNan : hills(r, c, 0.9, 7); });
  add("sieve", 20, 20, [](int r, int c) { return noise(r, c, 8) < 0.12 ? kNan : hills(r, c, 0.9, 9); });
  return all;
}

}  // namespace sightbound::testing
