// SPDX-License-Identifier: GPL-3.0-or-later
// What stays of a TIN that is simplified: outline, break lines, kept vertices, edges of more than two faces.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "simplify/break_lines.h"
#include "simplify/height_containment.h"
#include "support/distance_oracle.h"
#include "support/simplified_tins.h"

namespace sightbound {
namespace {

using namespace testing;

// Both ways: from the outlines' places to the other outline.
TEST(SimplifyTin, TheOutlineKeepsToItsToleranceBothWays) {
  const auto border_of = [](const Tin& tin) {
    std::map<std::array<std::int32_t, 2>, int> edges;
    for (const Face& f : tin.faces) {
      for (std::size_t i = 0; i < 3; ++i)
        ++edges[{std::min(f[i], f[(i + 1) % 3]), std::max(f[i], f[(i + 1) % 3])}];
    }
    std::vector<std::array<Xyz, 2>> border;
    for (const auto& [e, n] : edges) {
      if (n == 1) border.push_back({tin.vertices[std::size_t(e[0])], tin.vertices[std::size_t(e[1])]});
    }
    return border;
  };
  const auto apart = [](const std::vector<std::array<Xyz, 2>>& from,
                        const std::vector<std::array<Xyz, 2>>& to) {
    double most = 0;
    for (const auto& [a, b] : from) {
      for (int s = 0; s <= 20; ++s) {
        const Xyz p = a + (s / 20.0) * (b - a);
        double least = std::numeric_limits<double>::infinity();
        for (const auto& [c, d] : to) {
          const double t = std::clamp(dot(p - c, d - c) / dot(d - c, d - c), 0.0, 1.0);
          least = std::min(least, length(c + t * (d - c) - p));
        }
        most = std::max(most, least);
      }
    }
    return most;
  };
  const Tin tin = shaken(finer(arch(12, 8, 9), 2), 6, 0.08);
  std::size_t before = 0;
  for (const double tolerance : {0.0, 0.1, 0.3}) {
    TinSimplifyOptions options;
    options.outline_tolerance_m = tolerance;
    const TinSimplified made = simplified(tin, 0.6, 0.12, options);
    const auto whole = border_of(tin), left = border_of(made.tin);
    EXPECT_LE(apart(whole, left), tolerance + 1e-12);
    EXPECT_LE(apart(left, whole), tolerance + 1e-12);
    if (before > 0) {
      EXPECT_LT(left.size(), before);
    }
    before = left.size();
    EXPECT_EQ(left.size() == whole.size(), tolerance == 0);
  }
}

// Of polylines in plan: places of a line, and how far a place is from it.
struct PlanLine {
  std::vector<Xyz> at;

  double distance(const Xyz& p) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < at.size(); ++i) {
      const Xyz a{at[i - 1].x, at[i - 1].y, 0}, b{at[i].x, at[i].y, 0}, q{p.x, p.y, 0};
      const double t = std::clamp(dot(q - a, b - a) / dot(b - a, b - a), 0.0, 1.0);
      least = std::min(least, length(a + t * (b - a) - q));
    }
    return least;
  }
};

// Edges that lie near the line all along form a chain from its one end to the other, and no place of the line
// is far from them.
void expect_edges_along(const Tin& made, const PlanLine& line, double tolerance) {
  std::map<std::int32_t, std::set<std::int32_t>> next;
  std::vector<PlanLine> edges;
  for (const Face& f : made.faces) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Xyz a = made.vertices[std::size_t(f[i])], b = made.vertices[std::size_t(f[(i + 1) % 3])];
      bool near = true;
      for (int s = 0; s <= 32; ++s)
        near = near && line.distance(a + (s / 32.0) * (b - a)) <= tolerance + 1e-12;
      if (!near) continue;
      next[f[i]].insert(f[(i + 1) % 3]);
      next[f[(i + 1) % 3]].insert(f[i]);
      edges.push_back({{a, b}});
    }
  }
  const auto number = [&](const Xyz& p) {
    const auto at = std::find_if(made.vertices.begin(), made.vertices.end(),
                                 [&](const Xyz& v) { return v.x == p.x && v.y == p.y; });
    EXPECT_NE(at, made.vertices.end());
    return static_cast<std::int32_t>(at - made.vertices.begin());
  };
  std::set<std::int32_t> reached{number(line.at.front())};
  std::vector<std::int32_t> todo(reached.begin(), reached.end());
  while (!todo.empty()) {
    const std::int32_t v = todo.back();
    todo.pop_back();
    for (const std::int32_t w : next[v]) {
      if (reached.insert(w).second) todo.push_back(w);
    }
  }
  EXPECT_TRUE(reached.contains(number(line.at.back())));
  for (std::size_t i = 1; i < line.at.size(); ++i) {
    for (int s = 0; s <= 8; ++s) {
      double least = std::numeric_limits<double>::infinity();
      for (const PlanLine& edge : edges)
        least = std::min(least, edge.distance(line.at[i - 1] + (s / 8.0) * (line.at[i] - line.at[i - 1])));
      EXPECT_LE(least, tolerance + 1e-12);
    }
  }
}

// On a lattice of 2 m: a column, a curve that crosses it, and a ring.
std::vector<PlanLine> break_lines(int across) {
  PlanLine column, curve, ring;
  for (int r = 2; r <= across - 2; ++r) column.at.push_back({10, 2.0 * r, 0});
  for (int c = 0; c <= across; ++c) curve.at.push_back({2.0 * c, 2.0 * std::floor(3 + 0.02 * c * c), 0});
  for (int c = 12; c <= 18; ++c) ring.at.push_back({2.0 * c, 30, 0});
  for (int r = 16; r <= 20; ++r) ring.at.push_back({36, 2.0 * r, 0});
  for (int c = 17; c >= 12; --c) ring.at.push_back({2.0 * c, 40, 0});
  for (int r = 19; r >= 15; --r) ring.at.push_back({24, 2.0 * r, 0});
  return {column, curve, ring};
}

TEST(SimplifyTin, EdgesStillRunAlongBreakLines) {
  const int across = 24;
  const std::vector<PlanLine> lines = break_lines(across);
  std::vector<std::vector<Xyz>> given;
  for (const PlanLine& line : lines) given.push_back(line.at);
  std::size_t before = 0;
  for (unsigned seed = 0; seed < 4; ++seed) {
    for (const double tolerance : {0.0, 0.5, 2.5}) {
      const Tin tin = rough_lattice(across, seed, 1.5);
      TinSimplifyOptions options;
      options.height_field = true;
      options.break_tolerance_m = tolerance;
      Progress progress;
      options.break_lines = edges_along(tin, given, true, progress);
      HeightContainment containment(tin, std::vector<float>(tin.vertices.size(), 2.0F), false);
      const Tin made = simplify_tin(tin, containment, options, progress).tin;
      expect_sound(made);
      for (const PlanLine& line : lines) expect_edges_along(made, line, tolerance);
      if (tolerance > 0) {
        EXPECT_LE(made.faces.size(), before);
      }
      before = made.faces.size();
      EXPECT_LT(made.faces.size(), tin.faces.size() / 2);
      EXPECT_EQ(shape_of(made).euler, shape_of(tin).euler);
    }
  }
}

TEST(SimplifyTin, BreakLinesRunOverTheVerticesThatLieOnThem) {
  const Tin tin = rough_lattice(6, 1, 1);
  Progress progress;
  EXPECT_EQ(edges_along(tin, {{{2, 2, 9}, {2, 10, 9}}}, true, progress).size(), 4U);
  EXPECT_EQ(edges_along(tin, {{{2, 2, 9}, {8, 8, 9}, {8, 4, 9}}}, true, progress).size(), 5U);
  EXPECT_EQ(edges_along(tin, {{tin.vertices[8], tin.vertices[9]}}, false, progress).size(), 1U);
  const auto refused = [&](const std::vector<std::vector<Xyz>>& lines, bool in_plan) {
    try {
      edges_along(tin, lines, in_plan, progress);
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused({{{2, 2, 0}, {2, 4, 0}}, {{2, 4, 0}, {4, 2, 0}, {4.1, 2, 0}}}, true),
            "break_lines has 3 pieces, of which 2 do not run along edges of the TIN (the first from (2, 4) "
            "to (4, 2)); "
            "their vertices must be vertices of the TIN, to a millimetre.");
  EXPECT_NE(refused({{{2, 2, 50}, {2, 4, 50}}}, false), "");
  TinSimplifyOptions options;
  for (const TinEdge edge : {TinEdge{0, 2}, TinEdge{0, 0}, TinEdge{-1, 2}, TinEdge{0, 49}}) {
    options.break_lines = {edge};
    EXPECT_THROW(with_nothing_allowed(tin, options), InvalidInput);
  }
}

// The ridge of a roof: its ends stay on the gables, and it stays one straight edge when coplanar faces go.
TEST(SimplifyTin, BreakLinesInCoplanarFacesStay) {
  const Tin plane = finer(tin_of({{0, 0, 0}, {16, 0, 4}, {16, 8, 4}, {0, 8, 0}}, {{0, 1, 2}, {0, 2, 3}}), 3);
  Progress progress;
  TinSimplifyOptions options;
  options.break_lines = edges_along(plane, {{{0, 4, 0}, {16, 4, 4}}}, false, progress);
  EXPECT_EQ(options.break_lines.size(), 8U);
  const Tin made = with_nothing_allowed(plane, options).tin;
  EXPECT_EQ(made.faces.size(), 4U);
  expect_edges_along(made, {{{0, 4, 0}, {16, 4, 4}}}, 0);
}

TEST(SimplifyTin, KeptVerticesStay) {
  const Tin tin = shaken(finer(box({0, 0, 0}, {20, 12, 9}), 3), 1, 0.05);
  TinSimplifyOptions options;
  options.keep.assign(tin.vertices.size(), 0);
  for (std::size_t v = 0; v < tin.vertices.size(); v += 11) options.keep[v] = 1;
  const TinSimplified made = simplified(tin, 0.8, 0.2, options);
  for (std::size_t v = 0; v < tin.vertices.size(); v += 11)
    EXPECT_NE(std::find(made.tin.vertices.begin(), made.tin.vertices.end(), tin.vertices[v]),
              made.tin.vertices.end());
  options.keep.assign(tin.vertices.size(), 1);
  EXPECT_EQ(simplified(tin, 0.8, 0.2, options).tin.faces, tin.faces);
}

TEST(SimplifyTin, WhatIsNotManifoldStays) {
  // Three walls that meet in one edge, and two cones that touch in a point.
  Tin walls =
      tin_of({{0, 0, 0}, {0, 0, 4}, {4, 0, 0}, {4, 0, 4}, {-3, 3, 0}, {-3, 3, 4}, {-3, -3, 0}, {-3, -3, 4}},
             {{0, 2, 3}, {0, 3, 1}, {0, 4, 5}, {0, 5, 1}, {0, 6, 7}, {0, 7, 1}});
  walls = finer(walls, 3);
  TinSimplifyOptions options;
  options.outline_tolerance_m = 0.3;
  const TinSimplified made = simplified(walls, 0.3, 0.08, options);
  EXPECT_GE(made.fixed_vertices, 9U);
  EXPECT_EQ(shape_of(made.tin).euler, shape_of(walls).euler);
  EXPECT_EQ(shape_of(made.tin).non_manifold, 8U);
  EXPECT_LT(made.tin.faces.size(), walls.faces.size() / 3);
  EXPECT_LE(furthest(made.tin, walls), 0.3);
}

}  // namespace
}  // namespace sightbound
