// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds of the clearance ratio k over a voxel, and how volumes store them: two half floats, rounded outward.
#pragma once

#include <bit>
#include <cstdint>

namespace sightbound {

// k of every point of the closed voxel lies within.
struct RatioInterval {
  float low = 0, high = 0;

  friend bool operator==(const RatioInterval&, const RatioInterval&) = default;
};

// Stored bounds never leave [-K', K'], K' = beyond(K): a bound beyond K means "beyond K", no more. K' is a
// little over K so that rounding cannot move a bound from beyond K to K; it is a half float itself.
inline constexpr double kBeyondFactor = 17.0 / 16;
float beyond(double largest_ratio);

// The half float at or next to `value` towards minus (plus) infinity, as bits. |value| < 65504. Halves below
// 2^-14 in size are not used: they become 0 or +-2^-14.
std::uint16_t half_below(double value);
std::uint16_t half_above(double value);

// Exact.
inline float from_half(std::uint16_t bits) {
  const std::uint32_t size = (static_cast<std::uint32_t>(bits) & 0x7fffu) << 13;
  const std::uint32_t sign = (static_cast<std::uint32_t>(bits) & 0x8000u) << 16;
  const float magnitude =
      std::bit_cast<float>(size) * 0x1p112f;  // half's exponent counts from 15, float's from 127
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(magnitude) | sign);
}

// Both bounds in one number: low in the upper half of the bits, high in the lower.
inline std::int32_t pack(double low, double high) {
  return std::bit_cast<std::int32_t>(static_cast<std::uint32_t>(half_below(low)) << 16 | half_above(high));
}
inline RatioInterval unpack(std::int32_t packed) {
  const auto bits = std::bit_cast<std::uint32_t>(packed);
  return {from_half(static_cast<std::uint16_t>(bits >> 16)),
          from_half(static_cast<std::uint16_t>(bits & 0xffffu))};
}

// Halves in the order of their values: ordered_low(a) < ordered_low(b) when unpack(a).low < unpack(b).low,
// likewise the highs. -0 comes before 0.
inline int ordered_half(std::uint32_t half) {
  const int bits = static_cast<std::int16_t>(half & 0xffffu);
  return bits ^ ((bits >> 15) & 0x7fff);
}
inline int ordered_low(std::int32_t packed) {
  return ordered_half(std::bit_cast<std::uint32_t>(packed) >> 16);
}
inline int ordered_high(std::int32_t packed) { return ordered_half(std::bit_cast<std::uint32_t>(packed)); }
// The number that stands at this place of the order.
inline float from_ordered(int ordered) {
  return from_half(static_cast<std::uint16_t>(ordered_half(static_cast<std::uint32_t>(ordered) & 0xffffu)));
}

}  // namespace sightbound
