// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "volume/ratio_interval.h"

namespace sightbound {
namespace {

// A half float by its definition: sign, five bits of exponent, ten of mantissa.
double by_hand(std::uint16_t bits) {
  const int exponent = bits >> 10 & 31, mantissa = bits & 1023;
  const double size = exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(1024 + mantissa, exponent - 25);
  return (bits >> 15) != 0 ? -size : size;
}

TEST(RatioInterval, DecodesEveryHalf) {
  for (int bits = 0; bits < 0x10000; ++bits) {
    if ((bits >> 10 & 31) == 31) continue;  // infinities are not used
    const auto half = static_cast<std::uint16_t>(bits);
    ASSERT_EQ(static_cast<double>(from_half(half)), by_hand(half)) << bits;
  }
}

TEST(RatioInterval, RoundsOutwardToTheNextHalf) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> exponent(-20, 4), unit(-1, 1);
  for (int n = 0; n < 200000; ++n) {
    const double value = unit(random) * std::exp2(exponent(random));
    const double below = by_hand(half_below(value)), above = by_hand(half_above(value));
    ASSERT_LE(below, value);
    ASSERT_GE(above, value);
    if (std::abs(value) >= 0x1p-14) {
      ASSERT_LE(above - below, std::abs(value) * 0x1p-10);
    } else {
      ASSERT_LE(above - below, 0x1p-14);
    }
  }
}

TEST(RatioInterval, KeepsWhatIsAHalf) {
  for (const double value : {0.0, 1.0, -1.0, 3.5, -0.25, 0x1p-14, -0x1p-14, 1.0009765625}) {
    EXPECT_EQ(static_cast<double>(from_half(half_below(value))), value);
    EXPECT_EQ(static_cast<double>(from_half(half_above(value))), value);
    const RatioInterval k = unpack(pack(value, value));
    EXPECT_EQ(unpack(pack(static_cast<double>(k.low), static_cast<double>(k.high))), k);
  }
}

TEST(RatioInterval, BeyondIsALittleOverAndAHalf) {
  for (const double ratio : {1.0, 1.96, 3.29, 5.0}) {
    const auto end = static_cast<double>(beyond(ratio));
    EXPECT_GT(end, ratio * 1.05);
    EXPECT_LT(end, ratio * 1.08);
    EXPECT_EQ(static_cast<double>(from_half(half_below(end))), end);
    EXPECT_LT(by_hand(half_above(ratio)), end);
  }
}

}  // namespace
}  // namespace sightbound
