// SPDX-License-Identifier: GPL-3.0-or-later
// TINs of any shape: known distances, bounds that hold between samples, planted defects.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "verify/nearest_face.h"
#include "verify/verify.h"
#include <gtest/gtest.h>

#include "base/error.h"
#include "support/says.h"
#include "support/tins.h"

namespace sightbound {
namespace {

using testing::box;
using testing::says;

VerifyReport report_of(const Tin& original, const Tin& simplified, const Tolerance& tolerance,
                       double resolution = 0.25, int threads = 1) {
  Progress progress;
  VerifyOptions options;
  options.resolution_m = resolution;
  options.threads = threads;
  return verify(original, simplified, tolerance, options, progress);
}

Xyz random_place(std::mt19937& random, double side) {
  std::uniform_real_distribution<double> unit(-side, side);
  return {unit(random), unit(random), unit(random)};
}

// By a net of places on the triangle, in two rounds.
double distance_by_net(const Triangle3& t, const Xyz& p) {
  const auto at = [&](double u, double v) { return t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]); };
  double best = 1e300, best_u = 0, best_v = 0, step = 0.02;
  for (int round = 0; round < 4; ++round, step /= 20) {
    const double u0 = best_u, v0 = best_v, reach = round == 0 ? 1 : 20 * step;
    for (double u = std::max(0.0, u0 - reach); u <= std::min(1.0, u0 + reach) + 1e-12; u += step) {
      for (double v = std::max(0.0, v0 - reach); u + v <= 1 + 1e-12 && v <= v0 + reach; v += step) {
        const double d = length(at(u, v) - p);
        if (d < best) best = d, best_u = u, best_v = v;
      }
    }
  }
  return best;
}

TEST(NearestFace, is_nearest) {
  std::mt19937 random(3);
  for (int n = 0; n < 40; ++n) {
    const Triangle3 t{random_place(random, 5), random_place(random, 5), random_place(random, 5)};
    const Xyz p = random_place(random, 8);
    const double found = length(nearest_place(t, p) - p), by_net = distance_by_net(t, p);
    EXPECT_LE(found, by_net + 1e-9);
    EXPECT_NEAR(found, by_net, 1e-3);
  }
  const Triangle3 line{Xyz{0, 0, 0}, Xyz{4, 0, 0}, Xyz{2, 0, 0}},
      point{Xyz{1, 1, 1}, Xyz{1, 1, 1}, Xyz{1, 1, 1}};
  EXPECT_EQ(nearest_place(line, {3, 5, 0}), (Xyz{3, 0, 0}));
  EXPECT_EQ(nearest_place(point, {3, 5, 0}), (Xyz{1, 1, 1}));
}

TEST(NearestFace, the_tree_finds_what_all_faces_have) {
  std::mt19937 random(5);
  std::vector<Triangle3> triangles;
  for (int n = 0; n < 300; ++n) {
    const Xyz at = random_place(random, 20);
    triangles.push_back({at, at + random_place(random, 3), at + random_place(random, 3)});
  }
  const NearestFace tree(triangles);
  for (int n = 0; n < 500; ++n) {
    const Xyz p = random_place(random, 30);
    double best = 1e300;
    for (const Triangle3& t : triangles) best = std::min(best, length(nearest_place(t, p) - p));
    const NearestFace::Found found = tree.nearest(p);
    EXPECT_EQ(found.distance, best);
    EXPECT_EQ(length(nearest_place(triangles[found.face], p) - p), best);
  }
}

TEST(VerifyDistances, a_box_in_a_box) {
  const VerifyReport found = report_of(box({0, 0, 0}, {10, 10, 10}), box({-1, -1, -1}, {11, 11, 11}), {2});
  EXPECT_EQ(found.method, "distance");
  // From the outer corner to the inner one; from the inner box never more than 1.
  EXPECT_NEAR(found.largest_deviation.measured, std::sqrt(3.0), 1e-12);
  EXPECT_GE(found.largest_deviation.bound, std::sqrt(3.0));
  EXPECT_LE(found.largest_deviation.bound, std::sqrt(3.0) + found.resolution_m + 1e-9);
  EXPECT_LE(found.resolution_m, 0.25);
  EXPECT_EQ(found.vertex_deviation, std::vector<float>(8, 1));
  EXPECT_TRUE(found.within_tolerance());
}

TEST(VerifyDistances, the_same_is_the_same) {
  const Tin one = box({0, 0, 0}, {10, 20, 5});
  const VerifyReport found = report_of(one, one, {1});
  EXPECT_LT(found.largest_deviation.bound, 1e-12);
  EXPECT_EQ(found.pieces, 24u);
  EXPECT_TRUE(found.well_formed());
}

// Triangles anywhere, in no order.
Tin random_triangles(unsigned seed, int count) {
  std::mt19937 random(seed);
  Tin tin;
  for (std::int32_t n = 0; n < count; ++n) {
    const Xyz at = random_place(random, 20) + Xyz{30, 40, 50};
    for (int corner = 0; corner < 3; ++corner) tin.vertices.push_back(at + random_place(random, 9));
    tin.faces.push_back({3 * n, 3 * n + 1, 3 * n + 2});
  }
  return tin;
}

// Places drawn on both, against all faces of the other.
TEST(VerifyDistances, bounds_hold_everywhere) {
  const auto corners = [](const Tin& tin, std::size_t face) {
    Triangle3 found;
    for (std::size_t i = 0; i < 3; ++i) found[i] = tin.vertices[static_cast<std::size_t>(tin.faces[face][i])];
    return found;
  };
  const auto distance = [&](const Tin& tin, const Xyz& p) {
    double best = 1e300;
    for (std::size_t n = 0; n < tin.faces.size(); ++n)
      best = std::min(best, length(nearest_place(corners(tin, n), p) - p));
    return best;
  };
  for (unsigned seed = 0; seed < 12; ++seed) {
    const Tin original = random_triangles(seed, 12), simplified = random_triangles(seed + 50, 6);
    std::vector<float> tolerance(original.vertices.size(), 3);
    if (seed % 2) {
      for (std::size_t n = 0; n < tolerance.size(); ++n) tolerance[n] = 1 + static_cast<float>(n % 5);
    }
    const double resolution = seed % 3 == 0 ? 0 : 0.05;
    const VerifyReport found = report_of(original, simplified, {0, tolerance}, resolution);
    double largest = 0, ratio = 0;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    for (const bool of_original : {true, false}) {
      const Tin &from = of_original ? original : simplified, &to = of_original ? simplified : original;
      for (int n = 0; n < 4000; ++n) {
        const auto face = static_cast<std::size_t>(random() % from.faces.size());
        const Triangle3 t = corners(from, face);
        double u = unit(random), v = unit(random);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const double d = distance(to, t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]));
        largest = std::max(largest, d);
        if (!of_original) continue;
        std::array<double, 3> e{};
        for (std::size_t i = 0; i < 3; ++i)
          e[i] = static_cast<double>(tolerance[static_cast<std::size_t>(from.faces[face][i])]);
        ratio = std::max(ratio, d / (e[0] + u * (e[1] - e[0]) + v * (e[2] - e[0])));
      }
    }
    EXPECT_GE(found.largest_deviation.bound, largest);
    EXPECT_GE(found.largest_ratio.bound, ratio);
    EXPECT_GE(found.largest_deviation.measured, largest - 0.5);
    EXPECT_LE(found.largest_deviation.bound - found.largest_deviation.measured, found.resolution_m + 1e-9);
    EXPECT_LE(found.resolution_m, resolution > 0 ? resolution : found.largest_deviation.bound / 64);
  }
}

// A dent that no vertex of either shows: the faces between the same vertices run the other way.
TEST(VerifyDistances, between_the_vertices) {
  Tin bent = box({0, 0, 0}, {10, 10, 10}), other = bent;
  bent.vertices[4].z = other.vertices[4].z = 14;
  bent.vertices[6].z = other.vertices[6].z = 14;
  other.faces[2] = {4, 5, 7};
  other.faces[3] = {5, 6, 7};
  const VerifyReport found = report_of(bent, other, {1});
  EXPECT_EQ(found.vertex_deviation, std::vector<float>(8, 0));
  // The ridge from 4 to 6 is 4 m over the valley from 5 to 7, which falls away at 4 in 5 sqrt(2).
  EXPECT_GT(found.largest_deviation.bound, 4 * std::cos(std::atan(4 / std::hypot(5.0, 5.0))) - 1e-9);
  EXPECT_FALSE(found.within_tolerance());
}

TEST(VerifyDistances, a_hole_is_as_deep_as_it_is_wide) {
  const Tin whole = box({0, 0, 0}, {10, 10, 10});
  Tin torn = whole;
  torn.faces.erase(torn.faces.begin() + 2);  // half of the top
  const VerifyReport found = report_of(whole, torn, {1});
  // The place in the right triangle farthest from its three sides: its inradius.
  EXPECT_NEAR(found.largest_deviation.measured, 10 - 5 * std::sqrt(2.0), 0.25);
  EXPECT_GE(found.largest_deviation.bound, 10 - 5 * std::sqrt(2.0));
}

TEST(VerifyDistances, the_ratio_takes_the_tolerance_of_the_original) {
  const Tin inner = box({0, 0, 0}, {10, 10, 10}), outer = box({-1, -1, -1}, {11, 11, 11});
  const VerifyReport even = report_of(inner, outer, {4});
  EXPECT_NEAR(even.largest_ratio.bound, even.largest_deviation.bound / 4, 1e-12);
  std::vector<float> tolerance(8, 4);
  tolerance[6] = 0.5f;
  const VerifyReport varying = report_of(inner, outer, {0, tolerance});
  EXPECT_NEAR(varying.largest_ratio.measured, std::sqrt(3.0) / 0.5, 1e-9);
  EXPECT_FALSE(varying.within_tolerance());
}

TEST(VerifyDistances, faces_without_area_are_counted) {
  Tin flat = box({0, 0, 0}, {10, 10, 10});
  flat.vertices.push_back({5, 0, 0});
  flat.faces.push_back({0, 8, 1});
  const VerifyReport found = report_of(box({0, 0, 0}, {10, 10, 10}), flat, {1});
  EXPECT_EQ(found.degenerate.count, 1u);
  EXPECT_EQ(found.degenerate.first, 12u);
}

TEST(VerifyDistances, same_report_for_any_number_of_threads) {
  const Tin a = box({0, 0, 0}, {10, 10, 10}), b = box({0.1, 0.2, 0.3}, {10, 10, 11});
  const VerifyReport one = report_of(a, b, {1}, 0.05, 1), two = report_of(a, b, {1}, 0.05, 2);
  EXPECT_EQ(one.largest_deviation.bound, two.largest_deviation.bound);
  EXPECT_EQ(one.largest_deviation.place, two.largest_deviation.place);
  EXPECT_EQ(one.pieces, two.pieces);
}

TEST(VerifyDistances, a_resolution_is_chosen_or_refused) {
  const Tin one = box({0, 0, 0}, {10, 10, 10});
  const Tin other = box({-1, -1, -1}, {11, 11, 11});
  EXPECT_LE(report_of(one, other, {1}, 0).resolution_m, std::sqrt(3.0) / 64);
  try {
    report_of(one, one, {1}, -1);
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_TRUE(says(error.what(), "resolution is -1"));
  }
}

}  // namespace
}  // namespace sightbound
