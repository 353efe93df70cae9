// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/fine_ground.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightbound {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::int64_t kDrawsOfSample = 8;
constexpr std::uint64_t kOtherDraws = 0x66696e65;  // than those of the nodes

SIGHTBOUND_VECTOR
void draw_middle(const DrawKey& key, std::uint32_t first, const Lanes& a, const Lanes& b, float spread,
                 Lanes& out) {
  for (int l = 0; l < kLanes; ++l) {
    out.v[l] = 0.5f * (a.v[l] + b.v[l]) +
               spread * normal_from(draw_bits(key, first + static_cast<std::uint32_t>(l)));
  }
}

SIGHTBOUND_VECTOR
void raise_to(const Lanes& ground, const Lanes& eye, float per_s, float drop, Lanes& horizon) {
  for (int l = 0; l < kLanes; ++l) {
    const float rise = (ground.v[l] - eye.v[l]) * per_s - drop;
    horizon.v[l] = larger(rise == rise ? rise : kInfinity, horizon.v[l]);
  }
}

}  // namespace

void raise_horizon(const RayPlace& at, const RaySlopes& slopes, Lanes& horizon) {
  raise_to(at.ground, slopes.eye, static_cast<float>(1 / at.s), static_cast<float>(slopes.per_2r * at.s),
           horizon);
}

void FineGround::raise(const RayPlace& a, const RayPlace& b, int depth, const RaySlopes& slopes,
                       Lanes& horizon) const {
  const RayPlace between = middle(a, b);
  raise_horizon(between, slopes, horizon);
  if (depth > 1) {
    raise(a, between, depth - 1, slopes, horizon);
    raise(between, b, depth - 1, slopes, horizon);
  }
}

RayPlace FineGround::middle(const RayPlace& a, const RayPlace& b) const {
  RayPlace middle;
  middle.major = 0.5 * (a.major + b.major);
  middle.minor = 0.5 * (a.minor + b.minor);
  middle.s = 0.5 * (a.s + b.s);
  const double row = transposed_ ? middle.major : middle.minor,
               col = transposed_ ? middle.minor : middle.major;
  const auto eighth = [](double x, std::int64_t base) {
    return static_cast<std::int64_t>(std::floor(static_cast<double>(kDrawsOfSample) * x)) +
           kDrawsOfSample * base;
  };
  const DrawKey key = draw_key(terrain_.seed ^ kOtherDraws, eighth(row, terrain_.row + base_row_),
                               eighth(col, terrain_.col + base_col_));
  draw_middle(key, first_, a.ground, b.ground, spread_between(a, b), middle.ground);
  return middle;
}

float FineGround::spread_between(const RayPlace& a, const RayPlace& b) const {
  const double major = 0.5 * (a.major + b.major), minor = 0.5 * (a.minor + b.minor);
  const double row = transposed_ ? major : minor, col = transposed_ ? minor : major;
  const auto nearest = [](double x, int base, int count) {
    return std::clamp(base + static_cast<int>(std::lround(x)), 0, count - 1);
  };
  const double amplitude = terrain_.error.amplitude.at(nearest(row, base_row_, terrain_.mean.rows()),
                                                       nearest(col, base_col_, terrain_.mean.cols()));
  const double half_m = 0.5 * std::abs(b.s - a.s);
  return amplitude > 0 ? static_cast<float>(amplitude * terrain_.error.profile(half_m, amplitude)) : 0.0f;
}

}  // namespace sightbound
