// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "error_model/fractal_surface.h"
#include "error_model/residual_growth.h"
#include "support/terrains.h"

namespace sightbound {
namespace {

using testing::grid_from;
using testing::hills;
using testing::noise;

// Of every `k`-th place, or means over k x k.
Grid<float> coarse(int side, int k, bool means) {
  return grid_from(side, side, [=](int r, int c) {
    if (!means) return hills(k * r, k * c, 0.8, 10);
    double sum = 0;
    for (int i = 0; i < k; ++i) {
      for (int j = 0; j < k; ++j) sum += hills(k * r + i, k * c + j, 0.8, 10);
    }
    return sum / (k * k);
  });
}

TEST(ResidualGrowth, TellsMeansFromSamples) {
  ResidualGrowth samples, means;
  samples.add(coarse(256, 4, false));
  means.add(coarse(256, 4, true));
  EXPECT_GT(means.means_score(), samples.means_score() + 0.4);
  EXPECT_GT(means.exponent(0), samples.exponent(0) + 0.1);
}

TEST(ResidualGrowth, SteepHillsAreOnTheRightSideOfTheScore) {
  const auto ground = [](int r, int c) { return hills(r, c, 1.2, 7); };
  const auto scored = [&](bool means) {
    ResidualGrowth growth;
    growth.add(grid_from(200, 200, [&](int r, int c) {
      if (!means) return ground(3 * r, 3 * c);
      double sum = 0;
      for (int i = 0; i < 9; ++i) sum += ground(3 * r + i / 3, 3 * c + i % 3);
      return sum / 9;
    }));
    return growth.means_score();
  };
  EXPECT_LT(scored(false), 0.65);
  EXPECT_GT(scored(true), 0.65);
}

TEST(ResidualGrowth, WallsAlongTheGridAreNoMeans) {
  const auto block = [](int r, int c) {
    return r % 12 < 8 && c % 12 < 8 ? 3 + 9 * noise(r / 12, c / 12, 3) : 0;
  };
  ResidualGrowth growth;
  growth.add(grid_from(256, 256, [&](int r, int c) { return block(r, c) + 0.02 * hills(r, c, 0.8, 9); }));
  EXPECT_LT(growth.means_score(), 0.65);
}

TEST(ResidualGrowth, HalfOfTheLastChangeGoesOn) {
  ResidualGrowth growth;
  growth.add(coarse(256, 1, false));
  const double change = growth.exponent(0) - growth.exponent(1);
  EXPECT_NEAR(growth.continued(0.8, 0, CellContent::kSamples), 0.8 + std::clamp(change / 2, -0.2, 0.2),
              1e-12);
  // What means show by themselves does not count.
  const double h = 0.8, own = apparent_exponent(h, CellContent::kMeans, 0) -
                              apparent_exponent(h, CellContent::kMeans, 1);
  EXPECT_NEAR(growth.continued(h, 0, CellContent::kMeans), h + std::clamp((change - own) / 2, -0.2, 0.2),
              1e-12);
}

TEST(ResidualGrowth, OneCliffDoesNotSpeakForThePlain) {
  const auto plain = [](int r, int c) { return hills(r, c, 0.9, 8); };
  ResidualGrowth without, with;
  without.add(grid_from(256, 256, plain));
  with.add(grid_from(256, 256, [&](int r, int c) { return plain(r, c) + (c < 70 ? 400 : 0); }));
  EXPECT_NEAR(with.exponent(0), without.exponent(0), 0.15);  // one tile of eight has it
  EXPECT_GT(with.rms(0), 10 * without.rms(0));
}

TEST(ResidualGrowth, ACubicHasTheGainOfOne) {
  ResidualGrowth growth;
  growth.add(grid_from(64, 64, [](int r, int c) { return 0.001 * r * r * r + 0.02 * c * c; }));
  EXPECT_NEAR(growth.ridge_gain(), 0.125, 1e-3);
}

}  // namespace
}  // namespace sightbound
