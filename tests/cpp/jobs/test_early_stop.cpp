// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "error_model/error_model.h"
#include "error_model/verdict.h"
#include "jobs/early_stop.h"

namespace sightbound {
namespace {

TEST(EarlyStop, OneLookIsWilsonsInterval) {
  const EarlyStop stop(100, 0.95, 0);
  ASSERT_EQ(stop.looks().size(), 1u);
  EXPECT_NEAR(stop.looks()[0].z, kZ95, 1e-12);
  // Brown, Cai and DasGupta 2001: 10 of 100.
  const ShareInterval known = wilson(0.1, 100, kZ95);
  EXPECT_NEAR(known.low, 0.0552, 1e-4);
  EXPECT_NEAR(known.high, 0.1744, 1e-4);
}

TEST(EarlyStop, LooksShareTheDoubt) {
  for (const int most : {10, 192, 1000, 5000, 65535}) {
    const EarlyStop stop(most, 0.95, 0.03);
    double doubt = 0;
    int before = 0;
    for (const Look& look : stop.looks()) {
      doubt += 2 * (1 - normal_cdf(look.z));
      EXPECT_GT(look.realisations, before);
      EXPECT_TRUE(look.realisations % 16 == 0 || look.realisations == most);
      before = look.realisations;
    }
    EXPECT_NEAR(doubt, 0.05, 1e-9);
    EXPECT_EQ(before, most);
  }
}

TEST(EarlyStop, TheFirstLookCanClaim) {
  for (const double confidence : {0.5, 0.9, 0.95, 0.99}) {
    const EarlyStop stop(5000, confidence, 0.03);
    const Look& first = stop.looks().front();
    EXPECT_TRUE(stop.is_settled(1, first) || first.realisations < 100) << confidence;
    EXPECT_EQ(stop.claim(1, first), kVisible);
    EXPECT_EQ(stop.claim(0, first), kHidden);
    EXPECT_EQ(stop.claim(0.5, first), kUncertain);
  }
}

// At whatever look a cell is left, its interval holds the truth in 95 of 100 cells, and no claim is wrong
// more often than in 5.
TEST(EarlyStop, IntervalsHoldAtWhateverLook) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> draw(0, 1);
  const EarlyStop stop(2000, 0.95, 0.05);
  for (const double truth : {0.005, 0.024, 0.026, 0.1, 0.4, 0.974, 0.976}) {
    constexpr int kCells = 2000;
    int misses = 0, wrong = 0;
    double drawn = 0;
    for (int cell = 0; cell < kCells; ++cell) {
      int seen = 0, before = 0;
      for (const Look& look : stop.looks()) {
        for (; before < look.realisations; ++before) seen += draw(random) < truth ? 1 : 0;
        const double share = static_cast<double>(seen) / look.realisations;
        if (!stop.is_settled(share, look) && look.realisations < 2000) continue;
        const ShareInterval known = wilson(share, look.realisations, look.z);
        misses += truth < known.low || truth > known.high ? 1 : 0;
        const int claim = stop.claim(share, look);
        wrong += (claim == kVisible && truth < 0.975) || (claim == kHidden && truth > 0.025) ? 1 : 0;
        drawn += look.realisations;
        break;
      }
    }
    EXPECT_LE(misses, 0.05 * kCells + 3 * std::sqrt(0.05 * 0.95 * kCells)) << truth;
    EXPECT_LE(wrong, 0.05 * kCells) << truth;
    EXPECT_LT(drawn, 2000.0 * kCells) << truth;
  }
}

}  // namespace
}  // namespace sightbound
