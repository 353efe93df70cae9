// SPDX-License-Identifier: GPL-3.0-or-later
// Deviations known in closed form, deviations by brute force in long double, and planted defects.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "verify/verify.h"
#include <gtest/gtest.h>

#include "base/error.h"
#include "support/says.h"
#include "support/tins.h"
#include "terrain/triangulate.h"

namespace sightbound {
namespace {

using testing::says;
using testing::tin_of;

// Corners 0 1 2 3 counterclockwise from the south-west, 10 m apart, cut from 0 to 2, or from 1 to 3.
Tin square(const std::array<double, 4>& z, bool other_way = false) {
  Tin tin = tin_of({{0, 0, z[0]}, {10, 0, z[1]}, {10, 10, z[2]}, {0, 10, z[3]}}, {{0, 1, 2}, {0, 2, 3}});
  if (other_way) tin.faces = {{0, 1, 3}, {1, 2, 3}};
  return tin;
}
// Four faces around the middle.
Tin tent(double top) {
  return tin_of({{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}, {5, 5, top}},
                {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}});
}

VerifyReport report_of(const Tin& original, const Tin& simplified, const Tolerance& tolerance,
                       int threads = 1) {
  Progress progress;
  VerifyOptions options;
  options.threads = threads;
  return verify(original, simplified, tolerance, options, progress);
}

void expect_near(const Extreme& found, double value, const Xyz& place) {
  EXPECT_NEAR(found.measured, value, 1e-10);
  EXPECT_GE(found.bound, found.measured);
  EXPECT_NEAR(found.bound, value, 1e-9);
  EXPECT_LT(length(found.place - place), 1e-9);
}

TEST(VerifyHeights, the_same_is_the_same) {
  const VerifyReport found = report_of(tent(3), tent(3), {0.5});
  EXPECT_EQ(found.method, "vertical");
  EXPECT_LT(found.largest_deviation.bound, 1e-12);
  EXPECT_TRUE(found.within_tolerance());
  EXPECT_TRUE(found.well_formed());
  EXPECT_EQ(found.uncovered.m2, 0);
  EXPECT_EQ(found.surplus.m2, 0);
  EXPECT_EQ(found.uncovered_vertices, 0u);
  EXPECT_EQ(found.original_faces, 4u);
}

TEST(VerifyHeights, a_vertex_of_the_one_in_a_face_of_the_other) {
  for (const double top : {1.0, -1.0}) {
    expect_near(report_of(square({}), tent(top), {0.5}).largest_deviation, 1, {5, 5, top});
    expect_near(report_of(tent(top), square({}), {0.5}).largest_deviation, 1, {5, 5, 0});
    expect_near(report_of(square({}), tent(top), {0.5}).largest_ratio, 2, {5, 5, top});
  }
}

// Both go through all four samples: no look at vertices sees it.
TEST(VerifyHeights, a_spike_where_edges_cross) {
  const std::array<double, 4> z{0, 1, 0, 1};
  const VerifyReport found = report_of(square(z), square(z, true), {0.8});
  expect_near(found.largest_deviation, 1, {5, 5, 1});
  EXPECT_EQ(found.rms_deviation, 0);
  EXPECT_FALSE(found.within_tolerance());
}

// E is 1 at 0 and 3 at 2, so 2 in the middle of the original's edge between them.
TEST(VerifyHeights, the_ratio_goes_with_the_tolerance_there) {
  const std::array<double, 4> z{0, 1, 0, 1};
  const std::vector<float> tolerance{1, 7, 3, 5};
  const VerifyReport found = report_of(square(z), square(z, true), {0, tolerance});
  expect_near(found.largest_ratio, 0.5, {5, 5, 1});
  EXPECT_TRUE(found.within_tolerance());
}

TEST(VerifyHeights, the_largest_ratio_need_not_be_where_the_deviation_is) {
  Tin lifted = square({});
  lifted.vertices[0].z = 0.4;
  lifted.vertices[2].z = 2;
  const std::vector<float> tolerance{0.5f, 4, 8, 4};
  const VerifyReport found = report_of(square({}), lifted, {0, tolerance});
  expect_near(found.largest_deviation, 2, {10, 10, 2});
  expect_near(found.largest_ratio, 0.8, {0, 0, 0.4});
}

TEST(VerifyHeights, histogram_and_spread_are_those_of_the_originals_vertices) {
  const VerifyReport found = report_of(square({0, 0, 0, 0}), square({1, 2, 3, 4}), {5});
  EXPECT_EQ(found.vertex_deviation, (std::vector<float>{1, 2, 3, 4}));
  EXPECT_NEAR(found.mean_deviation, 2.5, 1e-12);
  EXPECT_NEAR(found.rms_deviation, std::sqrt(7.5), 1e-12);
  EXPECT_EQ(found.histogram.low, 1);
  EXPECT_EQ(found.histogram.high, 4);
  std::size_t count = 0;
  for (const std::size_t n : found.histogram.counts) count += n;
  EXPECT_EQ(count, 4u);
  EXPECT_EQ(found.histogram.counts.front(), 1u);
  EXPECT_EQ(found.histogram.counts.back(), 1u);
}

TEST(VerifyHeights, a_vertex_moved_a_little_beyond_the_tolerance) {
  const double tolerance = 0.5;
  const VerifyReport within = report_of(tent(3), tent(3 + 0.9999 * tolerance), {tolerance});
  const VerifyReport beyond = report_of(tent(3), tent(3 + 1.0001 * tolerance), {tolerance});
  EXPECT_TRUE(within.within_tolerance());
  EXPECT_FALSE(beyond.within_tolerance());
  EXPECT_NEAR(beyond.largest_ratio.bound, 1.0001, 1e-8);
}

TEST(VerifyHeights, a_flipped_face) {
  Tin turned = tent(3);
  std::swap(turned.faces[2][0], turned.faces[2][1]);
  const VerifyReport found = report_of(tent(3), turned, {1});
  EXPECT_EQ(found.flipped.count, 1u);
  EXPECT_EQ(found.flipped.first, 2u);
  EXPECT_EQ(found.folded.count, 0u);
  EXPECT_FALSE(found.well_formed());
  EXPECT_EQ(found.uncovered.m2, 0);
}

// The middle is moved out over the eastern side: the face there turns over, and all others lie on it.
TEST(VerifyHeights, a_fold) {
  Tin folded = tent(0);
  folded.vertices[4].x = 12;
  const VerifyReport found = report_of(tent(0), folded, {1});
  EXPECT_EQ(found.flipped.count, 1u);
  EXPECT_EQ(found.flipped.first, 1u);
  EXPECT_EQ(found.folded.count, 4u);
  EXPECT_EQ(found.uncovered.m2, 0);
  EXPECT_NEAR(found.surplus.m2, 2 * 10.0 * 2 / 2, 1e-6);  // that triangle twice: its own, and its neighbours'
}

TEST(VerifyHeights, a_hole) {
  Tin torn = tent(3);
  torn.faces.erase(torn.faces.begin() + 1);
  const VerifyReport found = report_of(tent(3), torn, {1});
  EXPECT_NEAR(found.uncovered.m2, 25, 1e-9);
  EXPECT_NEAR(found.uncovered.place.x, (10 + 10 + 5) / 3.0, 1e-9);
  EXPECT_TRUE(found.within_tolerance());
}

// A hole where another face lies twice: the areas agree, and yet there is a hole.
TEST(VerifyHeights, a_hole_beside_a_face_that_lies_twice) {
  Tin torn = tent(3);
  torn.faces[1] = torn.faces[2];
  const VerifyReport found = report_of(square({}), torn, {9});
  EXPECT_EQ(found.folded.count, 2u);
  EXPECT_NEAR(found.uncovered.m2, 25, 1e-9);
}

TEST(VerifyHeights, faces_without_width) {
  Tin flat = tent(3);
  flat.vertices.push_back({10, 5, 0});
  flat.faces.push_back({1, 5, 2});
  flat.faces.push_back({1, 1, 2});
  const VerifyReport found = report_of(tent(3), flat, {1});
  EXPECT_EQ(found.degenerate.count, 2u);
  EXPECT_EQ(found.degenerate.first, 4u);
  EXPECT_EQ(found.folded.count, 0u);
}

TEST(VerifyHeights, ground_beyond_the_outline) {
  Tin wide = tent(0);
  wide.vertices[1].x = wide.vertices[2].x = 11;
  const VerifyReport found = report_of(tent(0), wide, {1});
  EXPECT_NEAR(found.surplus.m2, 10, 1e-9);
  EXPECT_GT(found.surplus.place.x, 5);
  EXPECT_EQ(found.uncovered.m2, 0);
  const VerifyReport back = report_of(wide, tent(0), {1});
  EXPECT_NEAR(back.uncovered.m2, 10, 1e-9);
  EXPECT_EQ(back.uncovered_vertices, 2u);
  EXPECT_TRUE(std::isnan(back.vertex_deviation[1]));
}

// Random points in a square of 100 m with its corners; heights up to 20 m.
Tin random_tin(unsigned seed, int points, const Xyz& from) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  SurveyedPoints survey;
  for (const double x : {0.0, 100.0}) {
    for (const double y : {0.0, 100.0}) survey.points.push_back(from + Xyz{x, y, 20 * unit(random)});
  }
  for (int n = 0; n < points; ++n)
    survey.points.push_back(from + Xyz{100 * unit(random), 100 * unit(random), 20 * unit(random)});
  Progress progress;
  return triangulate(survey, {}, progress).tin;
}

using Real = long double;
struct Place {
  Real x, y;
};

// Every pair of faces, every corner of a piece, in long double.
struct Brute {
  Real deviation = 0, ratio = 0;

  Brute(const Tin& original, const Tin& simplified, const std::vector<float>& tolerance) {
    for (const Face& o : original.faces) {
      for (const Face& s : simplified.faces) {
        for (std::size_t i = 0; i < 3; ++i) {
          try_place(original, o, simplified, s, place(original, o[i]), tolerance);
          try_place(original, o, simplified, s, place(simplified, s[i]), tolerance);
          for (std::size_t j = 0; j < 3; ++j) {
            const Place a = place(original, o[i]), b = place(original, o[(i + 1) % 3]);
            const Place c = place(simplified, s[j]), d = place(simplified, s[(j + 1) % 3]);
            const Real side = cross(c, d, a) - cross(c, d, b);
            if (side == 0) continue;
            const Real t = cross(c, d, a) / side;
            if (t >= 0 && t <= 1)
              try_place(original, o, simplified, s, {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)},
                        tolerance);
          }
        }
      }
    }
  }

 private:
  static const Xyz& vertex(const Tin& tin, std::int32_t n) {
    return tin.vertices[static_cast<std::size_t>(n)];
  }
  static Place place(const Tin& tin, std::int32_t n) { return {vertex(tin, n).x, vertex(tin, n).y}; }
  static Real cross(const Place& a, const Place& b, const Place& c) {
    return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
  }
  // Weights of the corners; false outside.
  static bool weights(const Tin& tin, const Face& f, const Place& p, std::array<Real, 3>& w) {
    const Place a = place(tin, f[0]), b = place(tin, f[1]), c = place(tin, f[2]);
    const Real whole = cross(a, b, c);
    w = {cross(b, c, p) / whole, cross(c, a, p) / whole, cross(a, b, p) / whole};
    return std::ranges::all_of(w, [](Real v) { return v >= -1e-15L; });
  }
  void try_place(const Tin& original, const Face& o, const Tin& simplified, const Face& s, const Place& p,
                 const std::vector<float>& tolerance) {
    std::array<Real, 3> u, v;
    if (!weights(original, o, p, u) || !weights(simplified, s, p, v)) return;
    Real d = 0, e = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      d += v[i] * vertex(simplified, s[i]).z - u[i] * vertex(original, o[i]).z;
      e += u[i] * tolerance[static_cast<std::size_t>(o[i])];
    }
    deviation = std::max(deviation, std::abs(d));
    ratio = std::max(ratio, std::abs(d) / e);
  }
};

TEST(VerifyHeights, is_what_brute_force_finds) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    const Xyz from = seed % 2 ? Xyz{0, 0, 0} : Xyz{54321.5, -87654.25, 300};
    const Tin original = random_tin(seed, 60, from), simplified = random_tin(seed + 100, 8 + seed % 30, from);
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0.2f, 6);
    std::vector<float> tolerance(original.vertices.size());
    for (float& e : tolerance) e = unit(random);
    const Brute brute(original, simplified, tolerance);
    const VerifyReport found = report_of(original, simplified, {0, tolerance});
    EXPECT_NEAR(found.largest_deviation.measured, static_cast<double>(brute.deviation), 1e-5);
    EXPECT_GE(found.largest_deviation.bound, static_cast<double>(brute.deviation));
    EXPECT_NEAR(found.largest_deviation.bound, static_cast<double>(brute.deviation), 1e-5);
    EXPECT_GE(found.largest_ratio.bound, static_cast<double>(brute.ratio));
    EXPECT_NEAR(found.largest_ratio.bound, static_cast<double>(brute.ratio), 1e-4);
    EXPECT_TRUE(found.well_formed());
    EXPECT_EQ(found.uncovered.m2, 0);
    EXPECT_EQ(found.surplus.m2, 0);
  }
}

// Edges upon edges and vertices upon vertices, but for rounding: a grid and some of its samples, turned.
TEST(VerifyHeights, is_what_brute_force_finds_where_edges_run_along_edges) {
  constexpr int kSide = 9;
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    const double angle = 0.1 + unit(random), c = std::cos(angle), s = std::sin(angle);
    Tin original;
    SurveyedPoints survey;
    for (int row = 0; row < kSide; ++row) {
      for (int col = 0; col < kSide; ++col) {
        const Xyz p{40000 + 10 * (c * col - s * row), -30000 + 10 * (s * col + c * row), 15 * unit(random)};
        const std::int32_t n = static_cast<std::int32_t>(original.vertices.size());
        original.vertices.push_back(p);
        if (row > 0 && col > 0) {
          original.faces.push_back({n - kSide - 1, n - kSide, n});
          original.faces.push_back({n - kSide - 1, n, n - 1});
        }
        const bool corner = row % (kSide - 1) == 0 && col % (kSide - 1) == 0;
        const bool border = row % (kSide - 1) == 0 || col % (kSide - 1) == 0;
        if (corner || (!border && unit(random) < 0.4)) survey.points.push_back(p);
      }
    }
    Progress progress;
    const Tin simplified = triangulate(survey, {}, progress).tin;
    const std::vector<float> tolerance(original.vertices.size(), 2);
    const Brute brute(original, simplified, tolerance);
    const VerifyReport found = report_of(original, simplified, {2});
    EXPECT_GE(found.largest_deviation.bound, static_cast<double>(brute.deviation));
    EXPECT_NEAR(found.largest_deviation.bound, static_cast<double>(brute.deviation), 1e-6);
    EXPECT_NEAR(found.largest_ratio.bound, static_cast<double>(brute.ratio), 1e-6);
    EXPECT_TRUE(found.well_formed());
    EXPECT_EQ(found.uncovered.m2, 0);
    EXPECT_EQ(found.surplus.m2, 0);
    EXPECT_EQ(found.uncovered_vertices, 0u);
  }
}

// Without its corners' hull in common, and with a face left out here and there: areas by the other way round.
TEST(VerifyHeights, areas_add_up) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Tin original = random_tin(seed, 50, {});
    Tin torn = random_tin(seed + 100, 30, {});
    double missing = 0;
    for (int n = 0; n < 5; ++n) {
      missing += 0.5 * normal_of(torn, torn.faces.back()).z;
      torn.faces.pop_back();
    }
    EXPECT_NEAR(report_of(original, torn, {1}).uncovered.m2, missing, 1e-6);
    EXPECT_NEAR(report_of(torn, original, {1}).surplus.m2, missing, 1e-6);
    Tin moved = original;
    for (Xyz& p : moved.vertices) p.x += 7;
    EXPECT_NEAR(report_of(original, moved, {50}).uncovered.m2, 700, 1e-6);
    EXPECT_NEAR(report_of(original, moved, {50}).surplus.m2, 700, 1e-6);
  }
}

// Heights between vertices, drawn at random: never above the bound.
TEST(VerifyHeights, bounds_hold_everywhere) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const Tin original = random_tin(seed, 300, {}), simplified = random_tin(seed + 50, 40, {});
    const VerifyReport found = report_of(original, simplified, {1});
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 100);
    std::vector<Xyz> places;
    // A TIN of the drawn places as "original" tells the deviation at each of them.
    SurveyedPoints survey;
    for (int n = 0; n < 300; ++n) survey.points.push_back({unit(random), unit(random), 0});
    Progress progress;
    const Tin level = triangulate(survey, {}, progress).tin;
    const std::vector<float> a = report_of(level, original, {1}).vertex_deviation,
                             b = report_of(level, simplified, {1}).vertex_deviation;
    for (std::size_t n = 0; n < a.size(); ++n)
      EXPECT_LE(std::abs(static_cast<double>(a[n]) - static_cast<double>(b[n])),
                found.largest_deviation.bound + 1e-5);
  }
}

TEST(VerifyHeights, same_report_for_any_number_of_threads) {
  const Tin original = random_tin(7, 6000, {}), simplified = random_tin(8, 700, {});
  const VerifyReport one = report_of(original, simplified, {2}, 1),
                     two = report_of(original, simplified, {2}, 2);
  EXPECT_EQ(one.largest_deviation.bound, two.largest_deviation.bound);
  EXPECT_EQ(one.largest_deviation.place, two.largest_deviation.place);
  EXPECT_EQ(one.largest_ratio.bound, two.largest_ratio.bound);
  EXPECT_EQ(one.pieces, two.pieces);
  EXPECT_EQ(one.vertex_deviation, two.vertex_deviation);
  EXPECT_EQ(one.rms_deviation, two.rms_deviation);
}

TEST(VerifyHeights, origins_may_differ) {
  Tin moved = tent(1);
  moved.origin = {1000, 2000, 0};
  for (Xyz& p : moved.vertices) p = p - moved.origin;
  const VerifyReport found = report_of(square({}), moved, {0.5});
  expect_near(found.largest_deviation, 1, {5, 5, 1});
  EXPECT_EQ(found.uncovered.m2, 0);
}

TEST(VerifyHeights, nonsense_is_refused_by_name) {
  const auto refused = [](const Tin& original, const Tin& simplified, const Tolerance& tolerance) {
    try {
      report_of(original, simplified, tolerance);
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  const Tin good = tent(1);
  EXPECT_TRUE(says(refused(good, good, {0}), "tolerance is 0"));
  EXPECT_TRUE(says(refused(good, good, {kNothing}), "tolerance is nan"));
  const std::vector<float> few{1, 2}, bad{1, 1, -1, 1, 1};
  EXPECT_TRUE(says(refused(good, good, {0, few}), "2 values; original has 5 vertices"));
  EXPECT_TRUE(says(refused(good, good, {0, bad}), "tolerance of vertex 2 is -1"));
  EXPECT_TRUE(says(refused(good, Tin{}, {1}), "simplified"));
  EXPECT_TRUE(says(refused(Tin{}, good, {1}), "original"));
  Tin wrong = good;
  wrong.faces[3][1] = 5;
  EXPECT_TRUE(says(refused(good, wrong, {1}), "simplified: face 3 has a corner 5"));
  wrong = good;
  wrong.vertices[2].z = kNothing;
  EXPECT_TRUE(says(refused(good, wrong, {1}), "simplified: vertex 2 is not finite"));
  wrong = good;
  for (Xyz& p : wrong.vertices) p.x += 100;
  EXPECT_TRUE(says(refused(good, wrong, {1}), "no place in common"));
  wrong = good;
  wrong.metres_per_unit = 0.3048;
  EXPECT_TRUE(says(refused(good, wrong, {1}), "units of length"));
}

TEST(VerifyHeights, stops_when_asked) {
  Progress progress([](double) { return false; });
  EXPECT_THROW(verify(random_tin(1, 3000, {}), random_tin(2, 300, {}), {1}, {}, progress), Cancelled);
}

}  // namespace
}  // namespace sightbound
