// SPDX-License-Identifier: GPL-3.0-or-later
// What is asked of the simplifiers for any small raster and any soup of triangles: a clear refusal, or all
// that they promise, by brute force over all pairs of new and original triangles. Shared by the libFuzzer
// targets and the short run in tests/cpp/simplify/test_simplify_fuzz.cpp.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <span>
#include <stdexcept>
#include <vector>

#include "base/error.h"
#include "simplify/both_ways.h"
#include "simplify/height_containment.h"
#include "simplify/simplify.h"
#include "simplify/simplify_tin.h"
#include "support/distance_oracle.h"
#include "support/overlay_oracle.h"
#include "terrain/tin_cleaning.h"
#include "terrain/tin_height_field.h"

namespace sightbound::fuzz {

inline void promise(bool kept, const char* what) {
  if (!kept) throw std::logic_error(what);
}

// Bytes one after the other; 0 when there are no more.
class Choices {
 public:
  explicit Choices(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  int next() { return at_ < bytes_.size() ? bytes_[at_++] : 0; }
  int below(int n) { return next() % n; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

struct DemCase {
  Grid<float> heights;
  SimplifyOptions options;
};

inline DemCase dem_case(Choices choices) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr std::array<double, 8> kTolerances{0, 1e-7, 0.25, 0.5, 1, 2.5, 40, 1e6};
  constexpr std::array<float, 8> kExtremes{1e9F, -1e9F, 1e-38F, -0.0F, 32767, -32768, 9999.125F, 1.7e7F};
  DemCase made;
  const int rows = 2 + choices.below(11), cols = 2 + choices.below(11);
  const int kinds = choices.next(), step = choices.below(4);
  const bool varies = (kinds & 1) != 0, keeps = (kinds & 2) != 0, holes = (kinds & 4) != 0,
             extremes = (kinds & 8) != 0;
  const float unit = std::array<float, 4>{1, 0.1F, 25, 0.001F}[static_cast<std::size_t>(step)];
  SimplifyOptions& options = made.options;
  options.tolerance_m = kTolerances[static_cast<std::size_t>(choices.below(8))];
  options.keep_border = (kinds & 16) != 0;
  options.target_faces = (kinds & 32) != 0 ? choices.below(100) : 0;
  options.block = 1 + choices.below(16);
  options.samples_at_once = 1 + choices.next();
  options.threads = 1;
  made.heights = Grid<float>(rows, cols);
  if (varies) options.tolerance = Grid<float>(rows, cols);
  if (keeps) options.keep = Grid<std::uint8_t>(rows, cols);
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) {
      const int b = choices.next();
      float z = static_cast<float>(b & 15) * unit;  // plateaus
      if (holes && b >= 224) z = kNan;
      if (extremes && b >= 192 && b < 200) z = kExtremes[static_cast<std::size_t>(b & 7)];
      made.heights.at(r, c) = z;
      if (varies) options.tolerance.at(r, c) = static_cast<float>(kTolerances[std::size_t(b >> 4 & 7)]);
      if (keeps) options.keep.at(r, c) = b % 16 == 7 ? 1 : 0;
    }
  }
  return made;
}

// What rounding in long double adds to the oracle's heights.
inline double oracle_rounding(const Grid<float>& heights) {
  double highest = 0;
  for (const float z : heights.values()) highest = std::max(highest, std::isnan(z) ? 0 : std::abs(double(z)));
  return 0x1p-58 * (1 + highest);
}

// True when the bytes made a surface. Anything but our own refusals comes out.
inline bool try_dem(std::span<const std::uint8_t> bytes) {
  const DemCase given = dem_case(Choices(bytes));
  const SimplifyOptions& options = given.options;
  // Cells of one unit about the origin: places are exact.
  const DemTerrain terrain{given.heights, Geotransform({0, 1, 0, 0, 0, -1}), 1, ""};
  SimplifiedTin made;
  try {
    Progress progress;
    made = simplify_dem(terrain, options, progress);
  } catch (const InvalidInput&) {
    return false;
  }
  const auto tolerance = [&](int r, int c) {
    return options.tolerance.empty() ? options.tolerance_m : static_cast<double>(options.tolerance.at(r, c));
  };
  const testing::OverlayReport seen =
      testing::overlay_report(given.heights, terrain.geotransform, tolerance, made.tin);
  const double rounding = oracle_rounding(given.heights);
  promise(seen.excess <= rounding, "every place is within the tolerance");
  promise(made.report.largest_deviation_m >= seen.deviation - rounding,
          "the deviation reported is not too small");
  bool judged = true;  // everywhere, by the ratio too
  for (int r = 0; r < given.heights.rows(); ++r) {
    for (int c = 0; c < given.heights.cols(); ++c)
      judged = judged && tolerance(r, c) >= std::max(made.report.kept_for_rounding_m, 1e-6);
  }
  if (judged) promise(made.report.largest_ratio >= seen.ratio - rounding * 1e6, "nor is the ratio");
  promise(seen.uncovered < 1e-6 && std::abs(seen.outside) < 1e-6, "the footprint stays");
  promise(seen.overlap < 1e-6 && seen.not_up == 0, "nothing is folded or turned over");
  promise(seen.non_manifold == 0, "edges have one face or two");
  promise(made.report.faces_after == made.tin.faces.size(), "faces are counted");
  std::set<std::array<double, 3>> vertices;
  for (const Xyz& v : made.tin.vertices) {
    const Xyz p = made.tin.to_crs(v);
    promise(vertices.insert({p.x, p.y, p.z}).second, "no vertex is there twice");
  }
  for (int r = 0; r < options.keep.rows(); ++r) {
    for (int c = 0; c < options.keep.cols(); ++c) {
      if (options.keep.at(r, c) == 0) continue;
      const auto solid = [&](int down, int right, int aside_down, int aside_right) {
        const auto there = [&](int y, int x) {
          return y >= 0 && x >= 0 && y < given.heights.rows() && x < given.heights.cols() &&
                 !std::isnan(given.heights.at(y, x));
        };
        return there(r, c) && there(r + down, c + right) && there(r + aside_down, c + aside_right);
      };
      const bool used = solid(1, 1, 1, 0) || solid(1, 1, 0, 1) || solid(-1, -1, -1, 0) ||
                        solid(-1, -1, 0, -1) || solid(1, 0, 0, -1) || solid(0, 1, -1, 0);
      const std::array<double, 3> place{c + 0.5, -(r + 0.5), static_cast<double>(given.heights.at(r, c))};
      promise(!used || vertices.contains(place), "kept samples stay");
    }
  }
  return true;
}

// Lets everything be.
class Anywhere final : public Containment {
 public:
  std::optional<Xyz> place(const StarChange& change) override { return change.to; }
};

inline void keeps_together(const Tin& made, const Tin& tin) {
  const testing::Shape before = testing::shape_of(tin), after = testing::shape_of(made);
  promise(before.euler == after.euler && before.components == after.components, "parts, holes, tunnels stay");
  std::set<std::array<std::int32_t, 3>> seen;
  for (const Face& face : made.faces) {
    const auto t = testing::triangle_of(made, face);
    promise(length(cross(t[1] - t[0], t[2] - t[0])) > 0, "faces have an area");
    Face sorted = face;
    std::sort(sorted.begin(), sorted.end());
    promise(seen.insert(sorted).second, "no face is there twice");
  }
}

inline bool try_soup(std::span<const std::uint8_t> bytes) {
  Choices choices(bytes);
  Tin soup;
  TinSimplifyOptions options;
  options.outline_tolerance_m = 0.25 * choices.below(4);
  options.target_faces = choices.below(8) == 1 ? choices.below(20) : 0;
  const auto tolerance = 0.25F * static_cast<float>(1 + choices.below(8));
  const int vertices = 3 + choices.below(40), faces = 1 + choices.below(60);
  for (int v = 0; v < vertices; ++v) {  // on a coarse lattice, so that much coincides and lies in planes
    const int b = choices.next(), c = choices.next();
    soup.vertices.push_back({double(b & 7), double(b >> 3 & 7), c < 128 ? double(c & 3) : 0.01 * c});
  }
  for (int f = 0; f < faces; ++f)
    soup.faces.push_back({choices.below(vertices), choices.below(vertices), choices.below(vertices)});
  Tin tin;
  try {
    tin = clean(soup, "The TIN");
  } catch (const InvalidInput&) {
    return false;
  }
  Progress progress;
  constexpr double kExact = 1e-12;
  NothingContained nothing;
  TinSimplifyOptions straight = options;
  straight.outline_tolerance_m = 0;
  const Tin same = simplify_tin(tin, nothing, straight, progress).tin;
  keeps_together(same, tin);
  promise(testing::furthest(same, tin, 4) <= kExact && testing::furthest(tin, same, 4) <= kExact,
          "where nothing is allowed the surface stays");
  const std::vector<float> allowed(tin.vertices.size(), tolerance);
  Anywhere anywhere;
  BothWays both_ways(tin, allowed, anywhere);
  const Tin near = simplify_tin(tin, both_ways, options, progress).tin;
  keeps_together(near, tin);
  promise(testing::furthest(tin, near, 4) <= static_cast<double>(tolerance),
          "the original has the result near");
  if (!is_height_field(tin)) return true;
  options.height_field = true;
  options.outline_tolerance_m = 0;
  HeightContainment heights(tin, allowed, false);
  const TinSimplified within = simplify_tin(tin, heights, options, progress);
  keeps_together(within.tin, tin);
  promise(is_height_field(within.tin), "height fields stay such");
  promise(testing::furthest(within.tin, tin, 4) <= static_cast<double>(tolerance),
          "the result is near the original");
  return true;
}

}  // namespace sightbound::fuzz
