// SPDX-License-Identifier: GPL-3.0-or-later
// From the critical clearance ratio to probability and verdict.
#pragma once

#include <cmath>
#include <cstdint>

#include "error_model/error_model.h"
#include "error_model/verdict.h"
#include "sight/scene.h"

namespace sightbound {

inline constexpr std::uint32_t kNoCount = 4294967295u;

// p = F(k*); settled k* never leave [-K, K], and there p is 0 or 1.
inline float probability(const Scene& scene, double k) {
  if (k >= scene.largest_ratio) return 1;
  if (k <= -scene.largest_ratio) return 0;
  return static_cast<float>(cdf(k, scene.error.tails));
}

// A claim at confidence c is visible when p >= (1 + c) / 2, that is k* >= z(c).
inline std::uint8_t verdict(const Scene& scene, double k) {
  if (k >= scene.quantile) return kVisible;
  return k <= -scene.quantile ? kHidden : kUncertain;
}

}  // namespace sightbound
