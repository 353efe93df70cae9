// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/says.h"
#include "support/terrains.h"
#include "support/tins.h"
#include "terrain/tin_height_field.h"
#include "terrain/triangulate.h"
#include "terrain/triangulate_polygon.h"

namespace sightbound {
namespace {

using testing::all_notes;
using testing::noise;
using testing::says;

Triangulation made(const SurveyedPoints& given, const TriangulationOptions& options = {}) {
  Progress progress;
  return triangulate(given, options, progress);
}

double plan_area(const Tin& tin) {
  double twice = 0;
  for (const Face& f : tin.faces) twice += normal_of(tin, f).z;
  return twice / 2;
}

bool has_edge(const Tin& tin, std::int32_t a, std::int32_t b) {
  return std::any_of(tin.faces.begin(), tin.faces.end(), [&](const Face& f) {
    return std::count(f.begin(), f.end(), a) == 1 && std::count(f.begin(), f.end(), b) == 1;
  });
}

std::vector<Xyz> scattered(int count, std::uint64_t seed) {
  std::vector<Xyz> points;
  for (int i = 0; i < count; ++i) {
    points.push_back(
        {500000 + 100 * noise(i, 0, seed), 4000000 + 100 * noise(i, 1, seed), noise(i, 2, seed)});
  }
  return points;
}

// Oracle: no point lies in the circle round a face, tried one by one.
TEST(Triangulate, IsDelaunay) {
  const SurveyedPoints given{scattered(200, 7), {}};
  const Triangulation found = made(given);
  ASSERT_EQ(found.tin.vertices, given.points);
  EXPECT_TRUE(is_height_field(found.tin));
  for (const Face& f : found.tin.faces) {
    const Xyz a = given.points[static_cast<std::size_t>(f[0])],
              b = given.points[static_cast<std::size_t>(f[1])] - a,
              c = given.points[static_cast<std::size_t>(f[2])] - a;
    const double d = 2 * (b.x * c.y - b.y * c.x), bb = b.x * b.x + b.y * b.y, cc = c.x * c.x + c.y * c.y;
    const double ux = (c.y * bb - b.y * cc) / d, uy = (b.x * cc - c.x * bb) / d, r = std::hypot(ux, uy);
    for (const Xyz& p : given.points) EXPECT_GE(std::hypot(p.x - a.x - ux, p.y - a.y - uy), r * (1 - 1e-9));
  }
}

TEST(Triangulate, GridsAndDuplicates) {
  SurveyedPoints given;
  for (int r = 0; r < 20; ++r) {
    for (int c = 0; c < 30; ++c) given.points.push_back({c * 2.0, r * 2.0, r + c / 100.0});
  }
  given.points.push_back({4, 6, 9});  // that of row 3, column 2 is 3.02
  const Triangulation found = made(given);
  EXPECT_EQ(found.tin.vertices.size(), 600U);
  EXPECT_EQ(found.tin.faces.size(), 2U * 19 * 29);
  EXPECT_EQ(plan_area(found.tin), 58.0 * 38);
  EXPECT_NEAR(found.tin.vertices[92].z, (3.02 + 9) / 2, 1e-12);
  EXPECT_TRUE(says(all_notes(found.tin), "1 points lie where another does"));
  EXPECT_TRUE(says(all_notes(found.tin), "5.98 apart"));
  EXPECT_TRUE(is_height_field(found.tin));
}

TEST(Triangulate, EdgesRunAlongBreaklines) {
  SurveyedPoints given{scattered(300, 11), {}};
  given.breaklines = {{0, 1, 2}, {5, 6}};
  // Without crossings between them (this seed) all pieces are chains of edges: with crossings vertices would
  // be added.
  const Triangulation free = made({given.points, {}});
  const Triangulation found = made(given);
  EXPECT_TRUE(is_height_field(found.tin));
  EXPECT_NEAR(plan_area(found.tin), plan_area(free.tin), 1e-6);
  EXPECT_TRUE(has_edge(found.tin, 0, 1) || found.tin.vertices.size() > 300);
  EXPECT_FALSE(has_edge(free.tin, 5, 6));
  EXPECT_TRUE(has_edge(found.tin, 5, 6) || found.tin.vertices.size() > 300);
}

TEST(Triangulate, CrossingBreaklinesMeetAtTheMeanHeight) {
  const SurveyedPoints given{{{0, 0, 0}, {10, 10, 10}, {0, 10, 4}, {10, 0, 4}, {5, 20, 1}}, {{0, 1}, {2, 3}}};
  const Triangulation found = made(given);
  ASSERT_EQ(found.tin.vertices.size(), 6U);
  EXPECT_EQ(found.points.back(), Triangulation::kCrossing);
  EXPECT_NEAR(found.tin.vertices[5].x, 5, 1e-12);
  EXPECT_NEAR(found.tin.vertices[5].z, 4.5, 1e-12);
  EXPECT_TRUE(says(all_notes(found.tin), "cross at 1 places"));
  EXPECT_TRUE(says(all_notes(found.tin), "1 apart"));
  for (std::int32_t p = 0; p < 4; ++p) EXPECT_TRUE(has_edge(found.tin, p, 5));
}

TEST(Triangulate, ManyCrossingBreaklines) {
  SurveyedPoints given{scattered(120, 5), {}};
  for (std::int32_t i = 0; i + 1 < 120; i += 2) given.breaklines.push_back({i, i + 1});
  const Triangulation found = made(given);
  EXPECT_GT(found.tin.vertices.size(), 200U);
  EXPECT_TRUE(is_height_field(found.tin)) << height_field_test(found.tin).reason;
  EXPECT_EQ(found.points.size(), found.tin.vertices.size());
}

TEST(Triangulate, LongestEdgeLeavesGaps) {
  const SurveyedPoints given{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {50, 0, 0}, {51, 0, 0}, {50, 1, 0}}, {}};
  EXPECT_EQ(made(given, {.longest_edge = 2}).tin.faces.size(), 2U);
  EXPECT_GT(made(given).tin.faces.size(), 2U);
  EXPECT_THROW(made(given, {.longest_edge = 0.5}), InvalidInput);
  EXPECT_THROW(made(given, {.longest_edge = 0}), InvalidInput);
}

TEST(Triangulate, Refuses) {
  EXPECT_THROW(made({{{0, 0, 0}, {1, 0, 0}}, {}}), InvalidInput);
  EXPECT_THROW(made({{{0, 0, 0}, {1, 1, 0}, {2, 2, 0}, {3, 3, 5}}, {}}), InvalidInput);
  EXPECT_THROW(made({{{0, 0, 0}, {1, 1, 0}, {2, 2, 0}}, {{0, 2}}}), InvalidInput);
  EXPECT_THROW(made({{{0, 0, 0}, {1, std::nan(""), 0}, {2, 5, 0}}, {}}), InvalidInput);
  EXPECT_THROW(made({{{0, 0, 0}, {1, 0, 0}, {2, 5, 0}}, {{0, 3}}}), InvalidInput);
  Progress cancelled([](double) { return false; });
  EXPECT_THROW(triangulate({scattered(100000, 1), {}}, {}, cancelled), Cancelled);
}

TEST(SplitQuad, AlongTheShorterDiagonalInside) {
  EXPECT_EQ(split_quad({{{0, 0, 0}, {2, 0, 0}, {3, 2, 0}, {0, 2, 0}}})[0], (Face{0, 1, 3}));
  EXPECT_EQ(split_quad({{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}})[0], (Face{0, 1, 2}));
  // An arrowhead: the longer diagonal is the one inside.
  EXPECT_EQ(split_quad({{{0, 0, 0}, {2, 1, 0}, {9, 0, 0}, {2, 5, 0}}})[0], (Face{0, 1, 3}));
  EXPECT_EQ(split_quad({{{0, 0, 0}, {10, -1, 0}, {1, 0, 0}, {10, 1, 0}}})[0], (Face{0, 1, 2}));
}

double area(const std::vector<std::vector<Xyz>>& rings, const std::vector<Face>& faces,
            Xyz* direction = nullptr) {
  std::vector<Xyz> corners;
  for (const auto& ring : rings) corners.insert(corners.end(), ring.begin(), ring.end());
  Xyz sum;
  double total = 0;
  for (const Face& f : faces) {
    const auto at = [&](std::size_t i) { return corners[static_cast<std::size_t>(f[i])]; };
    const Xyz n = cross(at(1) - at(0), at(2) - at(0));
    sum = sum + n;
    total += length(n) / 2;
  }
  if (direction != nullptr) *direction = sum;
  return total;
}

TEST(TriangulatePolygon, ConcaveWithHoleInAnyPlaneAndTurn) {
  const std::vector<std::vector<Xyz>> flat{{{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {5, 4, 0}, {0, 10, 0}},
                                           {{2, 1, 0}, {4, 1, 0}, {3, 3, 0}}};
  const double wanted = (100 - 30) - 2;
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool mirrored : {false, true}) {
      auto rings = flat;
      for (auto& ring : rings) {
        for (Xyz& p : ring) p = axis == 0 ? p : axis == 1 ? Xyz{p.z, p.x, p.y} : Xyz{p.y, p.z, p.x};
        if (mirrored) std::reverse(ring.begin(), ring.end());
      }
      const auto faces = triangulate_polygon(rings);
      ASSERT_TRUE(faces);
      Xyz direction;
      EXPECT_NEAR(area(rings, *faces, &direction), wanted, 1e-9);
      const double along = axis == 0 ? direction.z : axis == 1 ? direction.x : direction.y;
      EXPECT_NEAR(along, mirrored ? -2 * wanted : 2 * wanted, 1e-9);
    }
  }
}

TEST(TriangulatePolygon, RefusesWhatCrossesItself) {
  EXPECT_FALSE(triangulate_polygon({{{0, 0, 0}, {10, 9, 0}, {10, 0, 0}, {0, 10, 0}, {-1, 5, 0}}}));
  EXPECT_FALSE(triangulate_polygon({{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {4, 4, 4}}}));
  EXPECT_FALSE(triangulate_polygon({{{0, 0, 0}, {1, 1, 1}}}));
  EXPECT_FALSE(triangulate_polygon({}));
}

}  // namespace
}  // namespace sightbound
