// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "support/says.h"
#include "support/terrains.h"
#include "support/tins.h"
#include "terrain/regular_tin.h"
#include "terrain/tin_cleaning.h"
#include "terrain/tin_height_field.h"

namespace sightbound {
namespace {

using testing::noise;
using testing::says;
using testing::tin_of;
using testing::together;

Tin square(double x, double y, double size, double z) {
  return tin_of({{x, y, z}, {x + size, y, z}, {x + size, y + size, z}, {x, y + size, z}},
                {{0, 1, 2}, {0, 2, 3}});
}

TEST(HeightField, OneFaceAndAPlainWithAHole) {
  EXPECT_TRUE(is_height_field(testing::triangle()));
  Grid<float> z = testing::grid_from(
      9, 9, [](int r, int c) { return r == 4 && c == 4 ? testing::kNan : noise(r, c, 1); });
  Progress progress;
  EXPECT_TRUE(is_height_field(regular_tin(*testing::dem_of(std::move(z)), 1, MemoryBudget(), progress).tin));
}

TEST(HeightField, WallsAndBoxesAreNone) {
  EXPECT_TRUE(says(height_field_test(testing::box({0, 0, 0}, {1, 1, 1})).reason, "10 faces are vertical or look down, face 0"));
  EXPECT_FALSE(is_height_field(tin_of({{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, {{0, 1, 2}})));
}

TEST(HeightField, PartsBesideEachOtherAreOneFieldAboveEachOtherNot) {
  EXPECT_TRUE(is_height_field(together(square(0, 0, 10, 0), square(10, 0, 10, 5))));  // touching, with a step
  EXPECT_TRUE(is_height_field(together(square(0, 0, 10, 0), square(10, 3, 4, 5))));
  EXPECT_TRUE(
      says(height_field_test(together(square(0, 0, 10, 0), square(3, 3, 2, 5))).reason, "above or below"));
  EXPECT_TRUE(says(height_field_test(together(square(0, 0, 10, 0), square(9, 9, 10, 5))).reason, "cross"));
  EXPECT_FALSE(is_height_field(together(square(0, 0, 10, 0), square(0, 0, 10, 5))));  // exactly above
  EXPECT_FALSE(
      is_height_field(together(square(0, 0, 10, 0), square(5, 0, 10, 5))));  // edges along each other
}

TEST(HeightField, AStripAcrossTheBorderThatMeetsItInCorners) {
  // Its corners lie on the square's border: no two edges cross in their insides there.
  const Tin strip =
      tin_of({{-5, 4, 9}, {0, 3, 9}, {5, 3, 9}, {5, 5, 9}, {0, 5, 9}}, {{0, 1, 4}, {1, 2, 3}, {1, 3, 4}});
  EXPECT_FALSE(is_height_field(together(square(0, 0, 10, 0), strip)));
}

TEST(HeightField, APartInAHoleIsFine) {
  Tin ring = tin_of({{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0}, {3, 3, 0}, {6, 3, 0}, {6, 6, 0}, {3, 6, 0}},
                    {{0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}});
  EXPECT_TRUE(is_height_field(ring));
  EXPECT_TRUE(is_height_field(together(ring, square(3, 3, 3, 40))));
  EXPECT_TRUE(is_height_field(together(ring, square(4, 4, 1, 40))));
  EXPECT_FALSE(is_height_field(together(ring, square(2, 2, 5, 40))));
}

TEST(HeightField, AFanThatGoesRoundTwice) {
  Tin fan = tin_of({{0, 0, 0}}, {});
  for (int i = 0; i <= 16; ++i) {
    fan.vertices.push_back({std::cos(i * 0.7), std::sin(i * 0.7), i * 0.5});
    if (i > 0) fan.faces.push_back({0, i, i + 1});
  }
  EXPECT_FALSE(is_height_field(fan));
}

TEST(HeightField, MillimetresOfRoundingAreNoOverlap) {
  // Corner of the small square on the slanted edge of a large face, all rounded to millimetres.
  for (int i = 1; i < 200; ++i) {
    const auto mm = [](double v) { return std::round(v * 1000) / 1000; };
    const double t = i / 200.0;
    const Xyz on{mm(100 * t), mm(37.137 * t), 1};
    const Tin large = tin_of({{0, 0, 0}, {100, 37.137, 0}, {0, 80, 0}}, {{0, 1, 2}});
    const Tin below = tin_of({{0, 0, 0}, {60, -50, 0}, on}, {{0, 1, 2}});
    EXPECT_TRUE(is_height_field(together(large, below))) << i;
    const Tin deep = tin_of({{0, 0, 0}, {60, -50, 0}, {on.x, on.y + 0.01, 1}}, {{0, 1, 2}});
    EXPECT_FALSE(is_height_field(together(large, deep))) << i;
  }
}

// Oracle: triangles of integer corners overlap when some point of a fine lattice is strictly inside two.
TEST(HeightField, AgreesWithCountingCoverOfALattice) {
  int fields = 0, others = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    Tin tin;
    const int count = 2 + static_cast<int>(noise(0, 0, seed) * 3);
    for (int f = 0; f < count; ++f) {
      for (int i = 0; i < 3; ++i) {
        tin.vertices.push_back(
            {std::floor(noise(f, i, seed) * 7), std::floor(noise(f, i + 3, seed) * 7), 0.0});
      }
      tin.faces.push_back({3 * f, 3 * f + 1, 3 * f + 2});
    }
    try {
      tin = clean(tin, "The TIN");
    } catch (const std::exception&) {
      continue;
    }
    for (Face& f : tin.faces) {  // shared corners may have turned some down
      if (normal_of(tin, f).z < 0) std::swap(f[1], f[2]);
    }
    bool overlap = false;
    constexpr int kFine = 16;
    for (int i = 0; i < 7 * kFine && !overlap; ++i) {
      for (int j = 0; j < 7 * kFine && !overlap; ++j) {
        const double x = (i + 0.37) / kFine, y = (j + 0.41) / kFine;
        int cover = 0;
        for (const Face& f : tin.faces) {
          bool inside = true;
          for (std::size_t k = 0; k < 3; ++k) {
            const Xyz& a = tin.vertices[static_cast<std::size_t>(f[k])];
            const Xyz& b = tin.vertices[static_cast<std::size_t>(f[(k + 1) % 3])];
            inside = inside && (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x) > 0;
          }
          cover += inside;
        }
        overlap = cover > 1;
      }
    }
    const HeightFieldTest found = height_field_test(tin);
    // The lattice may miss a sliver, so only its finds bind; without any, a find of ours must be a small one.
    EXPECT_FALSE(overlap && found.passed) << seed;
    overlap ? ++others : ++fields;
    if (!overlap && !found.passed) {
      double smallest = 1e9;
      for (const Face& f : tin.faces) smallest = std::min(smallest, normal_of(tin, f).z);
      EXPECT_LT(smallest, 8) << seed << " " << found.reason;
    }
  }
  EXPECT_GT(fields, 200);
  EXPECT_GT(others, 200);
}

}  // namespace
}  // namespace sightbound
