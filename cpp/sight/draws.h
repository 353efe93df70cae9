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

// What is the same for 2 x 2 cells: real steps stand together. Places are half cells.
inline DrawKey tile_key(std::uint64_t seed, std::int64_t row, std::int64_t col) {
  constexpr std::uint64_t kTileDraws = 0x74696c65;
  constexpr int kTile = 4;
  constexpr std::int64_t kEven = std::int64_t{1} << 40;  // places before the first: downward, too
  return draw_key(seed ^ kTileDraws, (row + kEven) / kTile, (col + kEven) / kTile);
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

// e^x for x from -80 to 80, within 2e-7 of it (Cephes, expf).
SIGHTBOUND_INLINE float exponential(float x) {
  const float k = x * 1.44269504f;
  const auto n = static_cast<std::int32_t>(k < 0 ? k - 0.5f : k + 0.5f);
  const auto whole = static_cast<float>(n);
  const float r = (x - whole * 0.693359375f) + whole * 2.12194440e-4f;
  float p = 1.9875691500e-4f;
  p = p * r + 1.3981999507e-3f;
  p = p * r + 8.3334519073e-3f;
  p = p * r + 4.1665795894e-2f;
  p = p * r + 1.6666665459e-1f;
  p = p * r + 5.0000001201e-1f;
  const auto two_to_n = std::bit_cast<float>(static_cast<std::uint32_t>(n + 127) << 23);
  return (1 + (r + r * r * p)) * two_to_n;
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

// Heavier tails are normal draws whose scale is drawn too (Andrews and Mallows 1974), of rms 1 but for what
// the largest draw cuts off (0.97 and 0.94 for powers of 1.25 and 1.5): a power of an exponential variable E
// (1/2: Laplace), or for Student's t the root of 3 / chi^2 of five degrees of freedom.
struct DrawnTails {
  float power = 0;
  bool student = false;

  bool are_normal() const { return power == 0 && !student; }
};
inline DrawnTails drawn_tails(Tails tails) {
  return {tails == Tails::kLaplace ? 0.5f : 0.0f, tails == Tails::kStudent};
}

// ln E.
SIGHTBOUND_INLINE float log_exponential_from(std::uint32_t bits) {
  const float x = (static_cast<float>(static_cast<std::int32_t>(bits >> 9)) + 0.5f) * 0x1p-23f;  // in (0, 1)
  return -minus_log(minus_log(x));
}
// E^q over its rms, the root of Gamma(2 q + 1), for q from 0 to 1.5: within 0.2 % (a polynomial fitted to its
// logarithm).
SIGHTBOUND_INLINE float power_scale(float log_e, float q) {
  const float log_rms = q * (-0.53512181f + q * (1.30770887f + q * (-0.54013332f + q * 0.11479228f)));
  return exponential(q * log_e - log_rms);
}
// chi^2 / 5 = (1 - 2 / 45 + n sqrt(2 / 45))^3 (Wilson and Hilferty 1931), where that is not too near to 0.
SIGHTBOUND_INLINE float student_scale_from(std::uint32_t bits) {
  const float root = 0.95555556f + 0.21081851f * normal_from(bits), least = 0.33f;
  const float chi = root > least ? root : least;
  return std::sqrt(0.6f / (chi * chi * chi));
}

SIGHTBOUND_INLINE void fill_normal(const DrawKey& key, std::uint32_t first, Lanes& out) {
  for (int l = 0; l < kLanes; ++l)
    out.v[l] = normal_from(draw_bits(key, first + static_cast<std::uint32_t>(l)));
}

SIGHTBOUND_INLINE void fill_log_exponential(const DrawKey& key, std::uint32_t first, Lanes& out) {
  for (int l = 0; l < kLanes; ++l)
    out.v[l] = log_exponential_from(draw_bits(key, first + static_cast<std::uint32_t>(l)));
}

SIGHTBOUND_INLINE float within_largest(float draw) {
  const float least = draw > -kLargestOfHeavyTails ? draw : -kLargestOfHeavyTails;
  return least < kLargestOfHeavyTails ? least : kLargestOfHeavyTails;
}

// Makes heavy tails of normal draws.
SIGHTBOUND_INLINE void scale_tails(const DrawnTails& tails, const DrawKey& key, std::uint32_t first,
                                   Lanes& x) {
  Lanes scale;
  if (tails.student) {
    for (int l = 0; l < kLanes; ++l)
      scale.v[l] = student_scale_from(draw_bits(key, first + static_cast<std::uint32_t>(l)));
  } else {
    fill_log_exponential(key, first, scale);
    for (int l = 0; l < kLanes; ++l) scale.v[l] = power_scale(scale.v[l], tails.power);
  }
  for (int l = 0; l < kLanes; ++l) x.v[l] = within_largest(x.v[l] * scale.v[l]);
}

}  // namespace sightbound
