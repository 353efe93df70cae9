// SPDX-License-Identifier: GPL-3.0-or-later
// Any TIN in a permission grid: within its tolerance at every place, by brute force.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "simplify/height_containment.h"
#include "support/distance_oracle.h"
#include "support/simplified_tins.h"
#include "terrain/tin_cleaning.h"

namespace sightbound {
namespace {

using namespace testing;

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

TEST(SimplifyTin, HeightFieldsKeepTheirFootprintAndLookUp) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    const Tin tin = rough_lattice(16, seed, 1.5);
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
  Tin tin = finer(rough_lattice(8, 3, 0), 2);
  const auto middle = std::find(tin.vertices.begin(), tin.vertices.end(), Xyz{8, 8, 0});
  ASSERT_NE(middle, tin.vertices.end());
  middle->z = 1.5;
  EXPECT_GT(furthest(tin, simplified(tin, 0.7, 0.1, {}, 1, Ways::kForward).tin, 2), 1.4);
  const Tin both = simplified(tin, 0.7, 0.1).tin;
  EXPECT_LE(furthest(tin, both, 4), 0.7);
  EXPECT_LT(both.faces.size(), 40U);
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

}  // namespace
}  // namespace sightbound
