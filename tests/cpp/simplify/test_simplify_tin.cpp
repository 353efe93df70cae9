// SPDX-License-Identifier: GPL-3.0-or-later
// Any TIN in a permission grid: every promise of simplify_tin.h, by brute force.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "simplify/both_ways.h"
#include "simplify/break_lines.h"
#include "simplify/height_containment.h"
#include "simplify/simplify_tin.h"
#include "support/bodies.h"
#include "support/distance_oracle.h"
#include "support/says.h"
#include "support/tins.h"
#include "terrain/tin_cleaning.h"
#include "volume/error_volume.h"
#include "volume/tin_surface.h"

namespace sightbound {
namespace {

using namespace testing;

constexpr double kZ = 1.959963984540054;

// Faces cut into four, `times` times.
Tin finer(Tin tin, int times) {
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

Tin shaken(Tin tin, unsigned seed, double size) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-size, size);
  for (Xyz& v : tin.vertices) v = v + Xyz{unit(random), unit(random), unit(random)};
  return tin;
}

enum class Ways { kForward, kBoth };

// Distance to the original at most the tolerance (at each vertex), voxels of that size.
TinSimplified simplified(const Tin& tin, const std::vector<float>& tolerance, double voxel,
                         const TinSimplifyOptions& options = {}, int threads = 1, Ways ways = Ways::kBoth) {
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

TinSimplified simplified(const Tin& tin, double tolerance, double voxel,
                         const TinSimplifyOptions& options = {}, int threads = 1, Ways ways = Ways::kBoth) {
  const std::vector<float> same(tin.vertices.size(), static_cast<float>(tolerance));
  return simplified(tin, same, voxel, options, threads, ways);
}

TinSimplified with_nothing_allowed(const Tin& tin, const TinSimplifyOptions& options = {}) {
  Progress progress;
  NothingContained nothing;
  return simplify_tin(tin, nothing, options, progress);
}

// No face without area, none doubled, no vertex unused.
void expect_sound(const Tin& tin) {
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

std::vector<Body> bodies() {
  return {{"building", shaken(finer(box({0, 0, 0}, {20, 12, 9}), 3), 1, 0.05), 0.6, 0.2},
          {"arch", shaken(finer(arch(10, 8, 9), 2), 2, 0.03), 0.5, 0.18},
          {"bridge over ground", shaken(finer(bridge(3), 1), 3, 0.05), 1.5, 0.5},
          {"ball", finer(rough_ball(4, 10, 0.1), 2), 0.8, 0.25}};
}

TEST(SimplifyTin, EveryPlaceIsWithinTheTolerance) {
  for (const Body& body : bodies()) {
    TinSimplifyOptions options;
    options.outline_tolerance_m = body.tolerance;
    const TinSimplified made = simplified(body.tin, body.tolerance, body.voxel, options);
    EXPECT_LE(furthest(made.tin, body.tin), body.tolerance) << body.name;
    EXPECT_LE(furthest(body.tin, made.tin, 3), body.tolerance) << body.name;
    EXPECT_EQ(shape_of(made.tin), shape_of(body.tin)) << body.name;
    expect_sound(made.tin);
    EXPECT_EQ(made.faces_before, body.tin.faces.size());
    EXPECT_LT(made.tin.faces.size(), body.tin.faces.size() / 4) << body.name;
    RecordProperty(body.name, static_cast<int>(made.tin.faces.size()));
  }
}

// From 0.1 m at one end to so much more at the other.
std::vector<float> growing(const Tin& tin, double most) {
  const Box3 box = bounds_of(tin);
  std::vector<float> tolerance;
  for (const Xyz& v : tin.vertices)
    tolerance.push_back(
        static_cast<float>(0.1 + (most - 0.1) * (v.x - box.low.x) / (box.high.x - box.low.x)));
  return tolerance;
}

TEST(SimplifyTin, AToleranceThatVariesHoldsAtEveryPlace) {
  for (const Body& body : bodies()) {
    const std::vector<float> tolerance = growing(body.tin, 2 * body.tolerance);
    const Tin made = simplified(body.tin, tolerance, body.voxel / 2).tin;
    EXPECT_LT(made.faces.size(), body.tin.faces.size() / 2) << body.name;
    const auto of_place = [&](const Face& f, const Xyz& p) {  // linear on a face
      const auto t = triangle_of(body.tin, f);
      const Xyz normal = cross(t[1] - t[0], t[2] - t[0]);
      double value = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const Xyz &a = t[(i + 1) % 3], &b = t[(i + 2) % 3];
        value +=
            dot(cross(b - a, p - a), normal) / dot(normal, normal) * double(tolerance[std::size_t(f[i])]);
      }
      return value;
    };
    double most = 0;
    for (const Face& f : body.tin.faces) {
      for_places(triangle_of(body.tin, f), 3,
                 [&](const Xyz& p) { most = std::max(most, distance_to_tin(made, p) - of_place(f, p)); });
    }
    EXPECT_LE(most, 1e-6) << body.name;
    // Near enough to some place, judged by what is allowed there.
    for (const Face& f : made.faces) {
      for_places(triangle_of(made, f), 5, [&](const Xyz& p) {
        double spare = -1;
        for (const Face& g : body.tin.faces) {
          const auto t = triangle_of(body.tin, g);
          const double far = distance_to_triangle(t, p),
                       allowed = double(std::max({tolerance[std::size_t(g[0])], tolerance[std::size_t(g[1])],
                                                  tolerance[std::size_t(g[2])]}));
          spare = std::max(spare, allowed - far);
        }
        most = std::max(most, -spare);
      });
    }
    EXPECT_LE(most, 1e-6) << body.name;
  }
}

TEST(SimplifyTin, ABoxKeepsTwelveFacesAndAPlaneTwo) {
  EXPECT_EQ(with_nothing_allowed(finer(box({0, 0, 0}, {16, 8, 4}), 4)).tin.faces.size(), 12U);
  const Tin plane = finer(tin_of({{0, 0, 0}, {16, 0, 4}, {16, 8, 4}, {0, 8, 0}}, {{0, 1, 2}, {0, 2, 3}}), 4);
  EXPECT_EQ(with_nothing_allowed(plane).tin.faces.size(), 2U);
  EXPECT_EQ(simplified(finer(box({0, 0, 0}, {16, 8, 4}), 3), 0.3, 0.1).tin.faces.size(), 12U);
}

// The surface of the one lies on that of the other, and back.
TEST(SimplifyTin, NothingAllowedRemovesOnlyWhatIsCoplanar) {
  std::mt19937 random(5);
  for (unsigned seed = 0; seed < 12; ++seed) {
    // Heights of whole quarters: many plane places, many that are nearly.
    Tin tin = finer(seed % 2 == 0 ? box({0, 0, 0}, {8, 8, 8}) : arch(6, 8, 4), 2);
    std::uniform_int_distribution<int> pick(0, 9);
    for (Xyz& v : tin.vertices) {
      if (pick(random) == 0) v = v + Xyz{0, 0, pick(random) % 2 == 0 ? 0.25 : 0x1p-40};
    }
    const TinSimplified made = with_nothing_allowed(tin);
    EXPECT_LT(made.tin.faces.size(), tin.faces.size());
    EXPECT_LE(furthest(made.tin, tin, 4), 1e-13);
    EXPECT_LE(furthest(tin, made.tin, 2), 1e-13);
    EXPECT_EQ(shape_of(made.tin), shape_of(tin));
    for (const Xyz& v : made.tin.vertices)
      EXPECT_NE(std::find(tin.vertices.begin(), tin.vertices.end(), v), tin.vertices.end());
  }
}

// Three faces in one plane around a vertex, one of them folded back under the others: without the vertex what
// it reaches beyond them would vanish.
TEST(SimplifyTin, WhatIsFoldedInItsPlaneStays) {
  const Tin tin = tin_of({{3, 0, 0}, {3, 2, 0}, {2, 2, 0}, {2, 1, 0}, {1, 5, 2}, {5, 1, 2}},
                         {{0, 1, 2}, {0, 2, 3}, {1, 3, 2}, {4, 3, 1}, {5, 1, 0}});
  const Tin made = with_nothing_allowed(tin).tin;
  EXPECT_LE(furthest(tin, made, 6), 1e-13);
  EXPECT_LE(furthest(made, tin, 6), 1e-13);
}

Tin rough_ground(int across, unsigned seed, double relief) {
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

TEST(SimplifyTin, HeightFieldsKeepTheirFootprintAndLookUp) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    const Tin tin = rough_ground(16, seed, 1.5);
    TinSimplifyOptions options;
    options.height_field = true;
    HeightContainment containment(tin, std::vector<float>(tin.vertices.size(), 1.0F), false);
    Progress progress;
    const TinSimplified made = simplify_tin(tin, containment, options, progress);
    EXPECT_LT(made.tin.faces.size(), tin.faces.size() / 2);
    EXPECT_LE(made.largest_deviation_m, 1.0);
    double area = 0;
    for (const Face& f : made.tin.faces) {
      const auto t = triangle_of(made.tin, f);
      const double up = cross(t[1] - t[0], t[2] - t[0]).z;
      EXPECT_GT(up, 0);
      area += up / 2;
    }
    EXPECT_NEAR(area, 32 * 32, 1e-9);
    const std::vector<float>& deviation = made.tin.face_attributes.at(0).values;
    // Vertically: the height of the original under a place, by looking through all its faces.
    for (const Face& f : made.tin.faces) {
      for_places(triangle_of(made.tin, f), 6, [&](const Xyz& p) {
        for (const Face& g : tin.faces) {
          const auto t = triangle_of(tin, g);
          const Xyz n = cross(t[1] - t[0], t[2] - t[0]);
          std::array<double, 3> weight;
          for (std::size_t i = 0; i < 3; ++i)
            weight[i] = cross(t[(i + 2) % 3] - t[(i + 1) % 3], Xyz{p.x, p.y, 0} - t[(i + 1) % 3]).z / n.z;
          if (*std::min_element(weight.begin(), weight.end()) < 0) continue;
          EXPECT_LE(std::abs(weight[0] * t[0].z + weight[1] * t[1].z + weight[2] * t[2].z - p.z),
                    static_cast<double>(deviation[&f - made.tin.faces.data()]));
        }
      });
    }
  }
}

// A cone narrower than the tolerance: the plane without it lies near the original everywhere.
TEST(SimplifyTin, NothingThinVanishes) {
  Tin tin = finer(rough_ground(8, 3, 0), 2);
  const auto middle = std::find(tin.vertices.begin(), tin.vertices.end(), Xyz{8, 8, 0});
  ASSERT_NE(middle, tin.vertices.end());
  middle->z = 1.5;
  EXPECT_GT(furthest(tin, simplified(tin, 0.7, 0.1, {}, 1, Ways::kForward).tin, 2), 1.4);
  const Tin both = simplified(tin, 0.7, 0.1).tin;
  EXPECT_LE(furthest(tin, both, 4), 0.7);
  EXPECT_LT(both.faces.size(), 40U);
}

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
      const Tin tin = rough_ground(across, seed, 1.5);
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
  const Tin tin = rough_ground(6, 1, 1);
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

TEST(SimplifyTin, StopsAtTheTarget) {
  const Tin tin = finer(rough_ball(4, 10, 0.1), 2);
  for (const std::int64_t target : {1000, 400}) {
    TinSimplifyOptions options;
    options.target_faces = target;
    const std::size_t faces = simplified(tin, 0.8, 0.25, options).tin.faces.size();
    EXPECT_LE(std::abs(static_cast<std::int64_t>(faces) - target), 2);
    EXPECT_GE(faces + 1, static_cast<std::size_t>(target));
  }
}

TEST(SimplifyTin, SameBytesForAnyNumberOfThreads) {
  for (const Body& body : bodies()) {
    const TinSimplified one = simplified(body.tin, body.tolerance, body.voxel, {}, 1),
                        two = simplified(body.tin, body.tolerance, body.voxel, {}, 2);
    EXPECT_EQ(one.tin.faces, two.tin.faces);
    EXPECT_EQ(one.tin.vertices, two.tin.vertices);
  }
}

// Soups of triangles: refused, or every promise holds.
TEST(SimplifyTin, AnySoupIsRefusedOrSimplifiedSoundly) {
  std::size_t refused = 0, done = 0;
  for (unsigned seed = 0; seed < 150; ++seed) {
    std::mt19937 random(seed);
    const auto pick = [&](int n) { return std::uniform_int_distribution<int>(0, n - 1)(random); };
    Tin soup;
    const int vertices = 4 + pick(30), faces = 1 + pick(60);
    for (int v = 0; v < vertices; ++v) {  // on a coarse lattice, so that much coincides and lies in planes
      soup.vertices.push_back({double(pick(4)), double(pick(4)), double(pick(3))});
      if (pick(3) == 0) soup.vertices.back().z += 0.01 * pick(100);
    }
    if (pick(10) == 0)
      soup.vertices[std::size_t(pick(vertices))].y = std::numeric_limits<double>::quiet_NaN();
    for (int f = 0; f < faces; ++f) soup.faces.push_back({pick(vertices), pick(vertices), pick(vertices)});
    Tin tin;
    try {
      tin = clean(soup, "The TIN");
    } catch (const InvalidInput&) {
      ++refused;
      continue;
    }
    TinSimplifyOptions options;
    options.outline_tolerance_m = 0.1 * pick(3);
    const TinSimplified made = simplified(tin, 0.5, 0.15, options);
    EXPECT_LE(furthest(made.tin, tin, 5), 0.5) << seed;
    EXPECT_LE(furthest(tin, made.tin, 5), 0.5) << seed;
    const Tin same = with_nothing_allowed(tin).tin;
    EXPECT_LE(furthest(same, tin, 5), 1e-13) << seed;
    EXPECT_LE(furthest(tin, same, 5), 1e-13) << seed;
    EXPECT_EQ(shape_of(made.tin).euler, shape_of(tin).euler) << seed;
    EXPECT_EQ(shape_of(made.tin).components, shape_of(tin).components) << seed;
    expect_sound(made.tin);
    ++done;
  }
  EXPECT_GT(refused, 5U);
  EXPECT_GT(done, 100U);
}

// Each took minutes when work at a vertex grew with its faces, and a flat was drawn to one vertex.
TEST(SimplifyTin, FlatsAndHubsTakeTimeInProportionToTheirFaces) {
  TinSimplifyOptions options;
  options.height_field = true;
  Progress progress;
  const Tin flat = rough_ground(200, 1, 0);
  HeightContainment level(flat, std::vector<float>(flat.vertices.size(), 0.1F), false);
  EXPECT_EQ(simplify_tin(flat, level, options, progress).tin.faces.size(), 2U);
  Tin fan;
  const std::int32_t rim = 20000;
  fan.vertices.push_back({0, 0, 5});
  for (std::int32_t i = 0; i < rim; ++i) {
    const double turn = 2 * 3.141592653589793 * i / rim;
    fan.vertices.push_back({100 * std::cos(turn), 100 * std::sin(turn), 0});
    fan.faces.push_back({0, 1 + i, 1 + (i + 1) % rim});
  }
  options.outline_tolerance_m = 0.2;
  HeightContainment cone(fan, std::vector<float>(fan.vertices.size(), 0.2F), false);
  EXPECT_LT(simplify_tin(fan, cone, options, progress).tin.faces.size(), 400U);
}

TEST(SimplifyTin, RefusesWhatMakesNoSense) {
  const Tin tin = triangle();
  TinSimplifyOptions options;
  options.keep.assign(2, 0);
  EXPECT_THROW(with_nothing_allowed(tin, options), InvalidInput);
  options = {};
  options.outline_tolerance_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(with_nothing_allowed(tin, options), InvalidInput);
  options = {};
  options.target_faces = -1;
  EXPECT_THROW(with_nothing_allowed(tin, options), InvalidInput);
  EXPECT_THROW(with_nothing_allowed(Tin{}), InvalidInput);
}

TEST(SimplifyTin, IsCancelled) {
  const Tin tin = finer(rough_ball(4, 10, 0.1), 4);
  Progress progress([](double) { return false; });
  NothingContained nothing;
  EXPECT_THROW(simplify_tin(tin, nothing, {}, progress), Cancelled);
}

}  // namespace
}  // namespace sightbound
