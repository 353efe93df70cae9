// SPDX-License-Identifier: GPL-3.0-or-later
// Break lines stay edges, and outlines move by their tolerance at most.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "simplify/line_chain.h"
#include "simplify/simplify.h"
#include "support/says.h"
#include "support/simplify_promises.h"

namespace sightbound {
namespace {

using namespace testing;

using Place = std::pair<double, double>;  // column, row
using Segment = std::pair<Place, Place>;

constexpr double kRounding = 1e-6;  // cells

double distance(const Place& p, const Segment& s) {
  const double dx = s.second.first - s.first.first, dy = s.second.second - s.first.second;
  const double px = p.first - s.first.first, py = p.second - s.first.second, length2 = dx * dx + dy * dy;
  const double t = length2 > 0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0;
  return std::hypot(px - t * dx, py - t * dy);
}

double distance(const Place& p, const std::vector<Segment>& all) {
  double least = std::numeric_limits<double>::infinity();
  for (const Segment& s : all) least = std::min(least, distance(p, s));
  return least;
}

std::vector<Segment> segments_of(const std::vector<LineEdge>& edges) {
  std::vector<Segment> all;
  for (const LineEdge& e : edges) {
    const int down = e.direction == kLineEast ? 0 : 1, right = e.direction == kLineSouth ? 0 : 1;
    all.push_back({{e.col, e.row}, {e.col + right, e.row + down}});
  }
  return all;
}

// Edges of the TIN in columns and rows; those of one face only are its outline.
std::vector<Segment> edges_of(const DemTerrain& terrain, const Tin& tin, bool outline) {
  const auto place = [&](std::int32_t v) {
    const Xyz crs = tin.to_crs(tin.vertices[static_cast<std::size_t>(v)]);
    const Xy at = terrain.geotransform.to_raster(crs.x, crs.y);
    return Place{at.x, at.y};
  };
  std::multiset<std::pair<std::int32_t, std::int32_t>> seen;
  for (const Face& f : tin.faces) {
    for (std::size_t i = 0; i < 3; ++i) seen.insert(std::minmax(f[i], f[(i + 1) % 3]));
  }
  std::vector<Segment> all;
  for (auto edge = seen.begin(); edge != seen.end(); edge = seen.upper_bound(*edge)) {
    if (!outline || seen.count(*edge) == 1) all.push_back({place(edge->first), place(edge->second)});
  }
  return all;
}

bool is_sample_of(const Place& p, const std::vector<Segment>& chain) {
  return std::any_of(chain.begin(), chain.end(), [&](const Segment& s) {
    return std::hypot(p.first - s.first.first, p.second - s.first.second) < kRounding ||
           std::hypot(p.first - s.second.first, p.second - s.second.second) < kRounding;
  });
}

// Does a path of edges lead from `from` to `to`, each between samples of the chain, each sample and each edge
// within the tolerance of the other?
void expect_path(const std::vector<Segment>& edges, const std::vector<Segment>& chain, const Place& from,
                 const Place& to, double tolerance) {
  std::vector<Segment> along;
  for (const Segment& e : edges) {
    if (!is_sample_of(e.first, chain) || !is_sample_of(e.second, chain)) continue;
    bool near = true;
    for (int n = 0; n <= 16; ++n) {
      const double t = n / 16.0;
      const Place p{e.first.first + t * (e.second.first - e.first.first),
                    e.first.second + t * (e.second.second - e.first.second)};
      near = near && distance(p, chain) <= tolerance + kRounding;
    }
    if (near) along.push_back(e);
  }
  const auto same = [](const Place& a, const Place& b) {
    return std::hypot(a.first - b.first, a.second - b.second) < kRounding;
  };
  std::vector<Place> reached{from};
  for (std::size_t n = 0; n < reached.size(); ++n) {
    for (const Segment& e : along) {
      for (const auto& [one, other] : {e, Segment{e.second, e.first}}) {
        if (same(one, reached[n]) &&
            std::none_of(reached.begin(), reached.end(), [&](const Place& p) { return same(p, other); }))
          reached.push_back(other);
      }
    }
  }
  EXPECT_TRUE(std::any_of(reached.begin(), reached.end(), [&](const Place& p) { return same(p, to); }));
  for (const Segment& s : chain) {
    for (const Place& p : {s.first, s.second}) EXPECT_LE(distance(p, along), tolerance + kRounding);
  }
}

// One that does not come back to where it was.
std::vector<Xy> some_line(int rows, int cols, std::uint64_t seed) {
  std::vector<Xy> line;
  const bool across = noise(1, 1, seed) < 0.5;
  const int along = across ? cols : rows, aside = across ? rows : cols;
  for (int n = 0; n <= 4; ++n) {
    const double a = (0.1 + 0.2 * n) * (along - 1), b = (0.15 + 0.7 * noise(n, 2, seed)) * (aside - 1);
    line.push_back(across ? Xy{a, b} : Xy{b, a});
  }
  return line;
}

TEST(Lines, ChainsFollowTheirLines) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    const std::vector<std::vector<Xy>> lines{some_line(30, 41, seed)};
    const std::vector<LineEdge> edges = line_chains(lines, 30, 41);
    ASSERT_FALSE(edges.empty());
    std::vector<Segment> given;
    for (std::size_t n = 1; n < lines[0].size(); ++n) {
      given.push_back({{lines[0][n - 1].x, lines[0][n - 1].y}, {lines[0][n].x, lines[0][n].y}});
    }
    const std::vector<Segment> chain = segments_of(edges);
    for (const Segment& s : chain)
      EXPECT_LE(std::max(distance(s.first, given), distance(s.second, given)), 1);
    for (const Segment& s : given) EXPECT_LE(distance(s.first, chain), 0.71);
  }
}

TEST(Lines, ChainsAreClippedToTheRaster) {
  const std::vector<std::vector<Xy>> lines{{{-1e9, 4}, {1e9, 4}}, {{3, -50}, {3, -2}}, {{7, 8.9}, {7, 40}}};
  const std::vector<LineEdge> edges = line_chains(lines, 10, 12);
  EXPECT_EQ(edges.size(), 11U);  // the fourth row alone
  for (const LineEdge& e : edges) EXPECT_EQ(e.row, 4);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(line_chains(std::vector<std::vector<Xy>>{{{0, 0}, {nan, 3}}}, 10, 12), InvalidInput);
}

TEST(Lines, S3BreakLinesStayEdgesWithinTheirTolerance) {
  std::size_t before = 0, after = 0;
  for (std::uint64_t seed = 0; seed < 45; ++seed) {
    SCOPED_TRACE(seed);
    const int rows = 24 + static_cast<int>(10 * noise(1, 0, seed)), cols = 26;
    const Grid<float> heights = grid_from(rows, cols, [&](int r, int c) { return hills(r, c, 0.8, seed); });
    const DemTerrain terrain = terrain_of(heights);
    const std::vector<LineEdge> edges =
        line_chains(std::vector<std::vector<Xy>>{some_line(rows, cols, seed)}, rows, cols);
    const std::vector<Segment> chain = segments_of(edges);
    const auto ends = [&](bool last) {
      const std::vector<Xy> line = some_line(rows, cols, seed);
      const Xy& end = last ? line.back() : line.front();
      return Place{static_cast<double>(std::lround(end.x)), static_cast<double>(std::lround(end.y))};
    };
    for (const double cells : {0.0, 0.8, 3.0}) {
      SCOPED_TRACE(cells);
      SimplifyOptions options = within(seed % 3 == 0 ? 1000 : 8);
      options.break_lines = edges;
      options.break_line_tolerance_m = 10 * cells;
      if (seed % 2 == 1) options.block = 7, options.samples_at_once = 1;
      const SimplifiedTin made = simplified(terrain, options);
      expect_kept(terrain, options, made);
      expect_path(edges_of(terrain, made.tin, false), chain, ends(false), ends(true), cells);
      EXPECT_EQ(made.report.break_line_edges_lost, 0U);
      if (cells == 3 && options.tolerance_m == 1000) before += chain.size(), after += made.tin.faces.size();
    }
  }
  EXPECT_LT(4 * after, 3 * before);  // they do go where they may
}

TEST(Lines, S2AndS1HoldWithAnyLines) {
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    SCOPED_TRACE(seed);
    const auto pick = [&](int n, int what) { return static_cast<int>(n * noise(what, 0, seed)); };
    const int rows = 3 + pick(14, 1), cols = 3 + pick(14, 2);
    const double holes = pick(3, 5) * 0.06;
    const Grid<float> heights = grid_from(rows, cols, [&](int r, int c) {
      if (noise(r, c, seed + 1) < holes) return static_cast<double>(kNan);
      return std::floor(5 * noise(r / 2, c / 2, seed + 2));
    });
    std::vector<std::vector<Xy>> lines;
    for (int n = 0; n < 4; ++n) {
      std::vector<Xy>& line = lines.emplace_back();
      for (int i = 0; i < 3; ++i)
        line.push_back(
            {cols * (1.4 * noise(n, i, seed + 3) - 0.2), rows * (1.4 * noise(n, i, seed + 4) - 0.2)});
    }
    SimplifyOptions options = within(pick(4, 6) * 0.5);
    options.break_lines = line_chains(lines, rows, cols);
    options.break_line_tolerance_m = 10.0 * pick(3, 7);
    options.block = pick(2, 8) == 0 ? 256 : 1 + pick(6, 9);
    options.samples_at_once = 1;
    try {
      expect_kept(terrain_of(heights), options, simplified(terrain_of(heights), options));
    } catch (const InvalidInput& error) {
      EXPECT_TRUE(says(error.what(), "no surface"));
    }
  }
}

void expect_near(const std::vector<Segment>& edges, const std::vector<Segment>& others, double tolerance) {
  for (const Segment& s : edges) {
    const Place middle{(s.first.first + s.second.first) / 2, (s.first.second + s.second.second) / 2};
    for (const Place& p : {s.first, s.second, middle}) EXPECT_LE(distance(p, others), tolerance + kRounding);
  }
}

TEST(Lines, S3OutlinesMoveByTheirToleranceAtMost) {
  std::size_t still = 0, moved = 0;
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    for (const double cells : {0.5, 1.0, 2.5}) {
      SCOPED_TRACE(seed);
      SCOPED_TRACE(cells);
      const Grid<float> heights = grid_from(28, 31, [&](int r, int c) {
        const bool sea = hills(r, c, 1.4, seed) < 0.1 * static_cast<double>(seed % 7);
        return sea || noise(r, c, seed) < 0.01 ? static_cast<double>(kNan) : hills(r, c, 0.8, seed + 1);
      });
      const DemTerrain terrain = terrain_of(heights);
      const auto seen_of = [&](const SimplifiedTin& made) {
        return overlay_report(
            heights, terrain.geotransform, [&](int, int) { return 4.0; }, made.tin);
      };
      SimplifyOptions options = within(4);
      if (seed % 2 == 1) options.block = 6, options.samples_at_once = 1;
      const SimplifiedTin stays = simplified(terrain, options);
      options.border_tolerance_m = 10 * cells;
      const SimplifiedTin made = simplified(terrain, options);
      const OverlayReport seen = seen_of(made);
      EXPECT_LE(seen.excess, kNoHeight);
      EXPECT_LT(seen.overlap, kNoArea);
      EXPECT_EQ(seen.not_up, 0U);
      EXPECT_EQ(seen.non_manifold, 0U);
      EXPECT_EQ(seen.holes, seen_of(stays).holes);
      const std::vector<Segment> now = edges_of(terrain, made.tin, true),
                                 given = edges_of(terrain, stays.tin, true);
      expect_near(given, now, cells);
      expect_near(now, given, cells);
      still += given.size(), moved += now.size();
    }
  }
  EXPECT_LT(10 * moved, 7 * still);
}

// Coarse heights, so that much is coplanar or just at the tolerance; coasts with bays, samples that stay,
// blocks.
TEST(Lines, S1AndS2HoldWhereOutlinesMove) {
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE(seed);
    const auto pick = [&](int n, int what) { return static_cast<int>(n * noise(what, 0, seed)); };
    const int rows = 4 + pick(14, 1), cols = 4 + pick(18, 2), steepness = 1 + pick(30, 3);
    const double holes = 0.05 + 0.1 * pick(4, 5);
    const Grid<float> heights = grid_from(rows, cols, [&](int r, int c) {
      if (noise(r / 2, c / 2, seed + 1) < holes || noise(r, c, seed + 5) < 0.03)
        return static_cast<double>(kNan);
      return std::floor(steepness * noise(r, c, seed + 2)) + (noise(r, c, seed + 3) < 0.03 ? 50 : 0);
    });
    const DemTerrain terrain = terrain_of(heights);
    SimplifyOptions options = within(pick(4, 6) * 0.3 * steepness);
    options.border_tolerance_m = 5.0 * (1 + pick(20, 7));
    options.block = pick(2, 8) == 0 ? 256 : 1 + pick(7, 9);
    options.samples_at_once = 1;
    if (pick(2, 10) == 1) {
      options.keep = Grid<std::uint8_t>(rows, cols, 0);
      for (std::uint8_t& keep : options.keep.values())
        keep = noise(static_cast<int>(&keep - options.keep.data()), 3, seed) < 0.06 ? 1 : 0;
    }
    if (pick(2, 11) == 1) {
      options.break_lines =
          line_chains(std::vector<std::vector<Xy>>{some_line(rows, cols, seed)}, rows, cols);
      options.break_line_tolerance_m = 10.0 * pick(2, 12);
    }
    try {
      const SimplifiedTin made = simplified(terrain, options);
      const OverlayReport seen = overlay_report(
          heights, terrain.geotransform, [&](int, int) { return options.tolerance_m; }, made.tin);
      EXPECT_LE(seen.excess, kNoHeight);
      EXPECT_GE(made.report.largest_deviation_m, seen.deviation - kNoHeight);
      EXPECT_LT(seen.overlap, kNoArea);
      EXPECT_EQ(seen.not_up, 0U);
      EXPECT_EQ(seen.non_manifold, 0U);
      SimplifyOptions all = within(0);
      all.keep = Grid<std::uint8_t>(rows, cols, 1);
      const SimplifiedTin full = simplified(terrain, all);
      const std::vector<Segment> now = edges_of(terrain, made.tin, true),
                                 given = edges_of(terrain, full.tin, true);
      expect_near(given, now, options.border_tolerance_m / 10);
      expect_near(now, given, options.border_tolerance_m / 10);
      EXPECT_EQ(seen.holes, overlay_report(
                                heights, terrain.geotransform, [](int, int) { return 0.0; }, full.tin)
                                .holes);
    } catch (const InvalidInput& error) {
      EXPECT_TRUE(says(error.what(), "no surface"));
    }
  }
}

// The ear with the peak goes first; then the outline comes back over it, in the plane of what is left.
TEST(Lines, S4OutlinesDoNotAdvanceOverGroundThatTheyGaveUp) {
  const float n = kNan;
  const std::vector<std::vector<float>> rows{
      {n, n, n, n}, {100, n, 50, 50}, {50, 50, 50, 50}, {n, 50, 50, 50}};
  const Grid<float> heights = grid_from(
      4, 4, [&](int r, int c) { return rows[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)]; });
  SimplifyOptions options = within(0);
  options.border_tolerance_m = 15;
  const SimplifiedTin made = simplified(terrain_of(heights), options);
  EXPECT_EQ(made.report.largest_deviation_m, 0);
  EXPECT_LE(overlay_report(
                heights, terrain_of(heights).geotransform, [](int, int) { return 0.0; }, made.tin)
                .deviation,
            kNoHeight);
}

TEST(Lines, ChainsOnCornersOfCellsHaveNoGaps) {
  for (const auto& [from, to] : {std::pair{Xy{1.5, 9.5}, Xy{56.5, 9.5}},
                                 {Xy{0.5, 0.5}, Xy{30.5, 30.5}},
                                 {Xy{30.5, 1.5}, Xy{2.5, 29.5}},
                                 {Xy{7.5, 33.5}, Xy{7.5, 0.5}}}) {
    const std::vector<LineEdge> edges = line_chains(std::vector<std::vector<Xy>>{{from, to}}, 40, 70);
    std::map<Place, int> ends;
    for (const Segment& s : segments_of(edges)) ++ends[s.first], ++ends[s.second];
    EXPECT_EQ(std::count_if(ends.begin(), ends.end(), [](const auto& end) { return end.second == 1; }), 2);
    EXPECT_EQ(edges.size(), ends.size() - 1);
  }
}

TEST(Lines, BreakLinesAlongTheOutlineStay) {
  const Grid<float> heights = grid_from(20, 30, [](int r, int c) { return r + c < 12 ? kNan : 5.0f; });
  const DemTerrain terrain = terrain_of(heights);
  SimplifyOptions options = within(1);
  options.border_tolerance_m = 25;
  // Along the northern border, and down the stairs of the coast.
  options.break_lines =
      line_chains(std::vector<std::vector<Xy>>{{{15, 0}, {22, 0}}, {{11, 2}, {2, 11}}}, 20, 30);
  const SimplifiedTin made = simplified(terrain, options);
  const std::vector<Segment> now = edges_of(terrain, made.tin, false);
  for (const Place& end : {Place{15, 0}, Place{22, 0}}) EXPECT_TRUE(is_sample_of(end, now));
  for (const Segment& s : segments_of(options.break_lines)) {
    if (std::isnan(heights.at(static_cast<int>(s.first.second), static_cast<int>(s.first.first)))) continue;
    if (std::isnan(heights.at(static_cast<int>(s.second.second), static_cast<int>(s.second.first)))) continue;
    EXPECT_LT(distance({(s.first.first + s.second.first) / 2, (s.first.second + s.second.second) / 2}, now),
              kRounding);
  }
}

TEST(Lines, SayWhatIsWrong) {
  const Grid<float> heights = grid_from(9, 9, [](int r, int c) { return r == 4 ? kNan : 1.0 * c; });
  SimplifyOptions options = within(1);
  options.break_lines = line_chains(std::vector<std::vector<Xy>>{{{3, 0}, {3, 8}}}, 9, 9);
  EXPECT_EQ(simplified(terrain_of(heights), options).report.break_line_edges_lost, 2U);
  for (double* tolerance : {&options.border_tolerance_m, &options.break_line_tolerance_m}) {
    *tolerance = -1;
    EXPECT_THROW(simplified(terrain_of(heights), options), InvalidInput);
    *tolerance = 0;
  }
  options.keep_border = true;
  options.border_tolerance_m = 5;
  EXPECT_THROW(simplified(terrain_of(heights), options), InvalidInput);
}

}  // namespace
}  // namespace sightbound
