// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/ratio_interval.h"

namespace sightbound {

namespace {

constexpr int kDroppedBits = 52 - 10;  // of the mantissa
constexpr std::uint64_t kExponentShift = std::uint64_t{1023 - 15} << 10;
constexpr std::uint16_t kSmallest = 0x0400;  // 2^-14
constexpr std::uint16_t kSign = 0x8000;

std::uint16_t towards_zero(double size) {
  if (size < 0x1p-14) return 0;
  return static_cast<std::uint16_t>((std::bit_cast<std::uint64_t>(size) >> kDroppedBits) - kExponentShift);
}

std::uint16_t away_from_zero(double size) {
  if (size == 0) return 0;
  if (size < 0x1p-14) return kSmallest;
  const bool exact = (std::bit_cast<std::uint64_t>(size) & ((std::uint64_t{1} << kDroppedBits) - 1)) == 0;
  return static_cast<std::uint16_t>(towards_zero(size) +
                                    (exact ? 0 : 1));  // a carry into the exponent is right
}

}  // namespace

std::uint16_t half_below(double value) {
  return value >= 0 ? towards_zero(value) : static_cast<std::uint16_t>(away_from_zero(-value) | kSign);
}

std::uint16_t half_above(double value) {
  if (value >= 0) return away_from_zero(value);
  const std::uint16_t size = towards_zero(-value);
  return size == 0 ? size : static_cast<std::uint16_t>(size | kSign);
}

float beyond(double largest_ratio) { return from_half(half_above(largest_ratio * kBeyondFactor)); }

}  // namespace sightbound
