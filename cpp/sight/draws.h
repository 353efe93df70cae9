// SPDX-License-Identifier: GPL-3.0-or-later
// Random numbers that depend on what they are for and on nothing else: seed, place and realisation. So the
// same terrain is drawn whatever window is looked at, in whatever order, on however many threads.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "error_model/tails.h"
#include "sight/vector.h"

namespace sightbound {

// Realisations side by side.
inline constexpr int kLanes = 16;
struct alignas(64) Lanes {
  float v[kLanes];
};

// What all realisations share of a place.
struct DrawKey {
  std::uint32_t a = 0, b = 0;
};

// Steele, Lea and Flood 2014 (SplitMix64).
inline std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

inline DrawKey draw_key(std::uint64_t seed, std::int64_t row, std::int64_t col) {
  const std::uint64_t x =
      mixed(mixed(seed ^ mixed(static_cast<std::uint64_t>(row))) ^ static_cast<std::uint64_t>(col));
  return {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(x >> 32)};
}

// Shared by a tile; half cells.
#ifndef TILE_HALF
#define TILE_HALF 4
#endif
inline DrawKey tile_key(std::uint64_t seed, std::int64_t row, std::int64_t col) {
  constexpr std::uint64_t kTileDraws = 0x74696c65;
  const auto tile = [](std::int64_t half) { return (half + (std::int64_t{1} << 40)) / TILE_HALF; };
  return draw_key(seed ^ kTileDraws, tile(row), tile(col));
}

// 32 bits of one realisation: two rounds of a mixing function with little bias (Wellons 2018).
SIGHTBOUND_INLINE std::uint32_t draw_bits(const DrawKey& key, std::uint32_t realisation) {
  const auto mix = [](std::uint32_t x) {
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
  };
  return mix(mix(key.a ^ (realisation * 0x9e3779b9u)) + key.b);
}

// A coin for each of sixteen realisations: bit l, whether sight crosses unknown ground in realisation first +
// l.
inline std::uint16_t open_holes(std::uint64_t seed, std::uint32_t first) {
  constexpr std::uint64_t kHoleDraws = 0x686f6c65;
  const DrawKey key = draw_key(seed ^ kHoleDraws, 0, 0);
  std::uint32_t bits = 0;
  for (std::uint32_t l = 0; l < kLanes; ++l) bits |= (draw_bits(key, first + l) & 1) << l;
  return static_cast<std::uint16_t>(bits);
}

// -ln x for x in (0, 1], within 2e-7 of it relative to its size or absolutely.
SIGHTBOUND_INLINE float minus_log(float x) {
  // x = m 2^e with m from 1 / sqrt 2 to sqrt 2; ln m by a polynomial (Cephes, logf).
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(x) - 0x3f3504f3u;
  const auto exponent = static_cast<float>(static_cast<std::int32_t>(bits) >> 23);
  const float m = std::bit_cast<float>((bits & 0x007fffffu) + 0x3f3504f3u) - 1;
  float p = 7.0376836292e-2f;
  p = p * m - 1.1514610310e-1f;
  p = p * m + 1.1676998740e-1f;
  p = p * m - 1.2420140846e-1f;
  p = p * m + 1.4249322787e-1f;
  p = p * m - 1.6668057665e-1f;
  p = p * m + 2.0000714765e-1f;
  p = p * m - 2.4999993993e-1f;
  p = p * m + 3.3333331174e-1f;
  const float ln_m = m - 0.5f * m * m + p * m * m * m;
  return -(ln_m + 0.69314718056f * exponent);
}

// Standard normal: the inverse of its distribution function (Giles 2010, single precision).
SIGHTBOUND_INLINE float normal_from(std::uint32_t bits) {
  const float x =
      (static_cast<float>(static_cast<std::int32_t>(bits >> 9)) + 0.5f) * 0x1p-22f - 1;  // in (-1, 1)
  const float w = minus_log((1 - x) * (1 + x));
  const float middle = w - 2.5f;
  float p = 2.81022636e-08f;
  p = p * middle + 3.43273939e-07f;
  p = p * middle - 3.5233877e-06f;
  p = p * middle - 4.39150654e-06f;
  p = p * middle + 0.00021858087f;
  p = p * middle - 0.00125372503f;
  p = p * middle - 0.00417768164f;
  p = p * middle + 0.246640727f;
  p = p * middle + 1.50140941f;
  const float outer = std::sqrt(w) - 3;
  float q = -0.000200214257f;
  q = q * outer + 0.000100950558f;
  q = q * outer + 0.00134934322f;
  q = q * outer - 0.00367342844f;
  q = q * outer + 0.00573950773f;
  q = q * outer - 0.0076224613f;
  q = q * outer + 0.00943887047f;
  q = q * outer + 1.00167406f;
  q = q * outer + 2.83297682f;
  return 1.41421356237f * x * (w < 5 ? p : q);
}

// No normal draw is farther from 0: the 23 bits that normal_from uses end at 5.3. Heavier tails are cut off.
inline constexpr float kLargestDraw = 5.4f, kLargestOfHeavyTails = 8;
inline float largest_draw(Tails tails) {
  return tails == Tails::kNormal ? kLargestDraw : kLargestOfHeavyTails;
}

// Laplace of standard deviation 1: the inverse of its distribution function.
SIGHTBOUND_INLINE float laplace_from(std::uint32_t bits) {
  const float x = (static_cast<float>(static_cast<std::int32_t>(bits >> 9)) + 0.5f) * 0x1p-22f - 1;
  const float size = 0.70710678119f * minus_log(1 - std::abs(x));
  return std::copysign(size < kLargestOfHeavyTails ? size : kLargestOfHeavyTails, x);
}

SIGHTBOUND_INLINE float laplace_scale_from(std::uint32_t bits) {
  const float x = (static_cast<float>(static_cast<std::int32_t>(bits >> 9)) + 0.5f) * 0x1p-23f;
  return std::sqrt(minus_log(x));
}
SIGHTBOUND_INLINE float student_scale_from(std::uint32_t bits) {
  const float n = normal_from(bits);
  const float w = 0.95555556f + 0.21081851f * n;
  const float c = w > 0.33f ? w : 0.33f;
  return std::sqrt(0.6f / (c * c * c));
}

// Student's t of five degrees of freedom over its standard deviation, from a normal draw: a polynomial whose
// quantiles of 68, 90, 95, 99 and 99.7 % are within 1 %; standard deviation 0.997.
SIGHTBOUND_INLINE float student_from(std::uint32_t bits) {
  const float n = normal_from(bits), n2 = n * n;
  const float t = n * (0.8219857f + n2 * (0.03599875f + n2 * 0.00354747f));
  const float least = t > -kLargestOfHeavyTails ? t : -kLargestOfHeavyTails;
  return least < kLargestOfHeavyTails ? least : kLargestOfHeavyTails;
}

}  // namespace sightbound
