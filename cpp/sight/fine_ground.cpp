// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/fine_ground.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightbound {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::int64_t kDrawsOfSample = 8;
constexpr std::uint64_t kOtherDraws = 0x66696e65, kCrossingDraws = 0x63726f73;  // than those of the nodes

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

DrawKey FineGround::key_of(const RayPlace& place, std::uint64_t kind) const {
  const double row = transposed_ ? place.major : place.minor, col = transposed_ ? place.minor : place.major;
  const auto eighth = [](double x, std::int64_t base) {
    return static_cast<std::int64_t>(std::floor(static_cast<double>(kDrawsOfSample) * x)) +
           kDrawsOfSample * base;
  };
  return draw_key(terrain_.seed ^ kind, eighth(row, terrain_.row + base_row_),
                  eighth(col, terrain_.col + base_col_));
}

void FineGround::depart(RayPlace& place, double part, double spacing_m) const {
  const double row = transposed_ ? place.major : place.minor, col = transposed_ ? place.minor : place.major;
  const auto spread_there =
      static_cast<float>(spread(row, col, 0.5 * spacing_m) * std::sqrt(4 * part * (1 - part)));
  const Lanes line = place.ground;
  draw_middle(key_of(place, kCrossingDraws), first_, line, line, spread_there, place.ground);
}

void FineGround::raise(const RayPlace& a, const RayPlace& b, int depth, const RaySlopes& slopes,
                       Lanes& horizon) const {
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
  draw_middle(key, first_, a.ground, b.ground, spread(row, col, 0.5 * std::abs(b.s - a.s)), middle.ground);
  raise_horizon(middle, slopes, horizon);
  if (depth > 1) {
    raise(a, middle, depth - 1, slopes, horizon);
    raise(middle, b, depth - 1, slopes, horizon);
  }
}

float FineGround::spread(double row, double col, double half_m) const {
  const auto nearest = [](double x, int base, int count) {
    return std::clamp(base + static_cast<int>(std::lround(x)), 0, count - 1);
  };
  const double amplitude = terrain_.error.amplitude.at(nearest(row, base_row_, terrain_.mean.rows()),
                                                       nearest(col, base_col_, terrain_.mean.cols()));
  if (amplitude <= 0) return 0;
  const ErrorField& error = terrain_.error;
  if (!error.surface || !terrain_.rises)
    return static_cast<float>(amplitude * error.profile(half_m, amplitude));
  // Self-affine: the side of a cell in small, with both ends and the ground beside it known.
  const double unit = amplitude * error.plain_per_amplitude() * error.surface->points;
  const double side = 0.5 * (error.surface->row_edge.spread + error.surface->col_edge.spread);
  return static_cast<float>(unit * side *
                            std::pow(half_m / error.profile.half_spacing_m, error.profile.exponent));
}

}  // namespace sightbound
