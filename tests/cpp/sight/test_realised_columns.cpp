// SPDX-License-Identifier: GPL-3.0-or-later
// What is drawn has the spread, the tails and the likeness of neighbours that the error model says.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "sight/ray_fan.h"
#include "sight/realised_columns.h"
#include "support/rough_ground.h"

namespace sightbound {
namespace {

constexpr int kSide = 60, kSixteens = 25;

// Flat, of height 0.
class Ground {
 public:
  Ground(double length_cells, float own, Tails tails, int row = 100, int col = 200)
      : ground_(flat(length_cells, tails)),
        own_(own),
        terrain_{ground_.heights,
                 own_,
                 ground_.error,
                 row,
                 col,
                 9,
                 nullptr,
                 length_cells > 0 ? &one_ : nullptr,
                 largest_draw(ground_.error)} {}
  Ground(const Ground&) = delete;
  Ground& operator=(const Ground&) = delete;
  const OpenTerrain& terrain() const { return terrain_; }

 private:
  static testing::RoughGround flat(double length_cells, Tails tails) {
    testing::RoughGround ground = testing::rough_ground(kSide, kSide, 0, false);
    std::ranges::fill(ground.heights.values(), 0.0f);
    ground.error.tails = tails;
    ground.error.noise = CorrelatedNoise(10 * length_cells, {10, 10});
    return ground;
  }

  const testing::RoughGround ground_;
  const SampleField own_, one_{1.0f};
  const OpenTerrain terrain_;
};

// Heights at all samples in kSixteens * 16 realisations, sample by sample.
std::vector<std::vector<double>> drawn(const OpenTerrain& terrain) {
  const RealisedColumns columns(terrain, false);
  std::vector<std::vector<double>> all;
  for (int r = 0; r < kSide; ++r) {
    for (int c = 0; c < kSide; ++c) {
      std::vector<double> heights;
      for (int i = 0; i < kSixteens; ++i) {
        const Lanes lanes = columns.heights(2 * c, 2 * r, static_cast<std::uint32_t>(i * kLanes));
        heights.insert(heights.end(), lanes.v, lanes.v + kLanes);
      }
      all.push_back(std::move(heights));
    }
  }
  return all;
}

double mean_product(const std::vector<std::vector<double>>& z, int rows, int cols, const auto& of) {
  double sum = 0;
  std::size_t n = 0;
  for (int r = 0; r + rows < kSide; ++r) {
    for (int c = 0; c + cols < kSide; ++c) {
      const auto &a = z[static_cast<std::size_t>(r * kSide + c)],
                 &b = z[static_cast<std::size_t>((r + rows) * kSide + c + cols)];
      for (std::size_t i = 0; i < a.size(); ++i) sum += of(a[i]) * of(b[i]);
      n += a.size();
    }
  }
  return sum / static_cast<double>(n);
}

TEST(RealisedColumns, ErrorsCorrelateAsFarAsTold) {
  for (const double length : {3.0, 8.0}) {
    const auto z = drawn(Ground(length, 0, Tails::kNormal).terrain());
    const auto itself = [](double x) { return x; };
    const double variance = mean_product(z, 0, 0, itself);
    EXPECT_NEAR(variance, 1, 0.05) << length;
    for (const int d : {1, 2, 4, 8, 16}) {
      for (const auto& [rows, cols] : {std::pair{d, 0}, std::pair{0, d}, std::pair{d, d}}) {
        const double told = std::exp(-std::hypot(rows, cols) / length);
        EXPECT_NEAR(mean_product(z, rows, cols, itself) / variance, told, rows && cols ? 0.09 : 0.06)
            << length << " cells, " << rows << " " << cols;
      }
    }
  }
}

TEST(RealisedColumns, TheSameErrorIsDrawnWhateverTheWindow) {
  const Ground one(5, 0.3f, Tails::kLaplace), other(5, 0.3f, Tails::kLaplace, 107, 196);
  const RealisedColumns a(one.terrain(), false), b(other.terrain(), true);  // rows are lines there
  for (const int n : {0, 12, 33}) {
    const Lanes here = a.heights(2 * 20, 2 * (n + 7), 32), there = b.heights(2 * n, 2 * 24, 32);
    EXPECT_TRUE(std::equal(here.v, here.v + kLanes, there.v));
  }
}

TEST(RealisedColumns, TailsAreAsHeavyAsTold) {
  for (const Tails tails : {Tails::kNormal, Tails::kLaplace, Tails::kStudent}) {
    std::vector<double> sizes;
    for (const auto& heights : drawn(Ground(0, 1, tails).terrain())) {
      for (const double z : heights) sizes.push_back(std::abs(z));
    }
    std::ranges::sort(sizes);
    for (const double share : {0.5, 0.9, 0.95, 0.99}) {
      const double told = two_sided_quantile(share, tails);
      EXPECT_NEAR(sizes[static_cast<std::size_t>(share * static_cast<double>(sizes.size()))], told,
                  0.03 * told)
          << name_of(tails) << " " << share;
    }
  }
}

// Of Laplace draws all of whose scale is shared, sizes correlate by 1 / 5: E |z|^2 is 1, E |a b| = 2 / pi.
TEST(RealisedColumns, LargeErrorsStandTogetherInPairsOfCells) {
  const auto z = drawn(Ground(0, 1, Tails::kLaplace).terrain());
  const auto size = [](double x) { return std::abs(x); };
  const double apart = mean_product(z, 0, 12, size), beside = mean_product(z, 0, 1, size);
  EXPECT_NEAR(apart, 0.5, 0.01);                                   // E|z|^2 = 1 / 2
  EXPECT_NEAR(beside, 0.5 * (apart + 2 / std::acos(-1.0)), 0.01);  // every other pair lies in one tile
  EXPECT_NEAR(mean_product(z, 0, 1, [](double x) { return x; }), 0, 0.01);
}

// The 68.3 and the 95 % quantiles of n E^q over its rms, by integration.
TEST(RealisedColumns, BetweenLevelHeightsTheTailsAreThoseOfLevelGround) {
  const StepLaw steps{{1, 1.25}, {1, 0.25}};
  const Departure own{draw_key(1, 2, 3), draw_key(4, 5, 6), 2, {0.7f}};
  const auto quantiles = [&](float rise) {
    std::vector<double> sizes;
    for (std::uint32_t first = 0; first < 1600000; first += kLanes) {
      Lanes a{}, b, out;
      std::ranges::fill(b.v, rise);
      draw_on_way(own, steps, first, a, b, 0.25f, out);
      for (const float z : out.v) sizes.push_back(std::abs(double(z) - 0.25 * rise) / 2);
    }
    std::ranges::sort(sizes);
    const auto at = [&](double share) {
      return sizes[static_cast<std::size_t>(share * double(sizes.size()))];
    };
    return std::pair{at(0.683), at(0.95)};
  };
  const auto [level, level_far] = quantiles(0);
  EXPECT_NEAR(level, 0.416, 0.01);
  EXPECT_NEAR(level_far, 2.02, 0.03);
  const auto [step, step_far] = quantiles(1e4f);  // floats of that size are 5e-4 apart
  EXPECT_NEAR(step, 0.932, 0.01);
  EXPECT_NEAR(step_far, 2.028, 0.03);
}

TEST(RowBetween, IsWhereTheRayCrossesIt) {
  const RayPlace a{3, 1.2, 30}, b{3.5, 1.6, 36};
  const auto row = row_between(a, b);
  ASSERT_TRUE(row);
  EXPECT_EQ(row->node, 3);  // minor 1.5
  EXPECT_NEAR(row->part, 0.75, 1e-12);
  EXPECT_NEAR(row->place.major, 3.375, 1e-12);
  EXPECT_NEAR(row->place.s, 34.5, 1e-12);
  EXPECT_FALSE(row_between({3, 1.0, 30}, {3.5, 1.5, 36}));  // from node to node
  EXPECT_FALSE(row_between({3, 1.1, 30}, {3.5, 1.1, 36}));
  EXPECT_EQ(row_between(b, a)->node, 3);
}

}  // namespace
}  // namespace sightbound
