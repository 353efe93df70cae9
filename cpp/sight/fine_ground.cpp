// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/fine_ground.h"

#include <algorithm>
#include <cmath>

namespace sightbound {

namespace {

constexpr std::int64_t kDrawsOfSample = 8;
constexpr std::uint64_t kFineDraws = 0x66696e65, kCrossingDraws = 0x63726f73,
                        kInsideDraws = 0x696e7369;  // other draws than those of the nodes

// Of each number that goes into a slope: more than the roundings of a realisation differ from those of a
// bound, some units of the 24th bit.
constexpr float kRounding = 1e-6f;

RayPlace half_way(const RayPlace& a, const RayPlace& b) {
  return {0.5 * (a.major + b.major), 0.5 * (a.minor + b.minor), 0.5 * (a.s + b.s)};
}

}  // namespace

HeightRange slope_range(const HeightRange& ground, const HeightRange& eye, const RaySlope& slope) {
  const float size =
      larger(std::abs(ground.low), std::abs(ground.high)) + larger(std::abs(eye.low), std::abs(eye.high));
  const float room = kRounding * (size * slope.per_s + std::abs(slope.drop));
  return {(ground.low - eye.high) * slope.per_s - slope.drop - room,
          (ground.high - eye.low) * slope.per_s - slope.drop + room};
}

FineGround::FineGround(const OpenTerrain& terrain, bool transposed, int base_row, int base_col,
                       bool crossings)
    : terrain_(terrain),
      transposed_(transposed),
      base_row_(base_row),
      base_col_(base_col),
      steps_(is_learnt(terrain) ? terrain.error.steps : StepLaw{}),
      most_(terrain.largest_draw * static_cast<float>(steps_.largest_factor())),
      half_across_(terrain.error.larger_side_m / 4),
      across_per_amplitude_(crossings ? per_amplitude(half_across_) : 0) {}

DrawKey FineGround::key_of(double row, double col, std::uint64_t kind) const {
  const auto eighth = [](double x, std::int64_t base) {
    return static_cast<std::int64_t>(std::floor(static_cast<double>(kDrawsOfSample) * x)) +
           kDrawsOfSample * base;
  };
  return draw_key(terrain_.seed ^ kind, eighth(row, terrain_.row + base_row_),
                  eighth(col, terrain_.col + base_col_));
}

DrawKey FineGround::scale_of(double row, double col) const {
  const auto half = [](double x, std::int64_t base) {
    return static_cast<std::int64_t>(std::floor(2 * x)) + 2 * base;
  };
  return tile_key(terrain_.seed, half(row, terrain_.row + base_row_), half(col, terrain_.col + base_col_));
}

// From a to b terrain bends as the middles of cell sides show it: half-way, a share (distance / side)^2 of
// what those rise by.
float FineGround::rise(double row, double col, double rows, double cols) const {
  if (!is_learnt(terrain_) || across_per_amplitude_ == 0) return 0;
  const Square at = around(row, col);
  const auto nearer = [](double x, int first, int second) {
    return x - std::floor(x) < 0.5 ? first : second;
  };
  const MiddleRises& rises = *terrain_.rises;
  return static_cast<float>(cols * cols * rises.row_edge.at(nearer(row, at.row, at.row1), at.col) +
                            rows * rows * rises.col_edge.at(at.row, nearer(col, at.col, at.col1)));
}

float FineGround::rise_across(const RayPlace& place, const NodeStep& step, double part) const {
  const double rows = transposed_ ? step.major : step.minor, cols = transposed_ ? step.minor : step.major;
  return static_cast<float>(4 * part * (1 - part)) * rise(row_of(place), col_of(place), rows, cols);
}

Departure FineGround::across(const RayPlace& place, const NodeStep& step, double part) const {
  return {key_of(row_of(place), col_of(place), kCrossingDraws), scale_of(row_of(place), col_of(place)),
          spread_across(place, part), tails(row_of(place), col_of(place)), rise_across(place, step, part)};
}

Departure FineGround::inside(const RayPlace& place, double along, double across) const {
  const double middle = spread(row_of(place), col_of(place), half_across_, across_per_amplitude_) *
                        step_factor(row_of(place), col_of(place));
  const double parts = 4 * along * (1 - along) + 4 * across * (1 - across);
  return {key_of(row_of(place), col_of(place), kInsideDraws), scale_of(row_of(place), col_of(place)),
          static_cast<float>(middle * std::sqrt(parts)), tails(row_of(place), col_of(place)),
          rise_across(place, {kNodeStep, 0}, along) + rise_across(place, {0, kNodeStep}, across)};
}

FineGround::Square FineGround::around(double row, double col) const {
  const int rows = terrain_.mean.rows(), cols = terrain_.mean.cols();
  const auto within = [](double x, int base, int count) {
    return std::clamp(base + static_cast<int>(std::floor(x)), 0, count - 1);
  };
  const int r = within(row, base_row_, rows), c = within(col, base_col_, cols);
  return {r, c, std::min(r + 1, rows - 1), std::min(c + 1, cols - 1)};
}

// As the samples around step.
double FineGround::step_factor(double row, double col) const {
  if (steps_.has_one_variance()) return 1;
  const Square at = around(row, col);
  return factor_between(terrain_, at.row, at.col, at.row1, at.col1);
}

DrawnTails FineGround::tails(double row, double col) const {
  const Square at = around(row, col);
  return tails_between(terrain_, at.row, at.col, at.row1, at.col1);
}

float FineGround::spread_across(const RayPlace& place, double part) const {
  const float middle = spread(row_of(place), col_of(place), half_across_, across_per_amplitude_);
  return static_cast<float>(middle * std::sqrt(4 * part * (1 - part)));
}

float FineGround::rise_along(const RayPlace& a, const RayPlace& b) const {
  const RayPlace place = half_way(a, b);
  return rise(row_of(place), col_of(place), row_of(b) - row_of(a), col_of(b) - col_of(a));
}

FinePlace FineGround::middle(const RayPlace& a, const RayPlace& b, double per_2r) const {
  const RayPlace place = half_way(a, b);
  const double row = row_of(place), col = col_of(place), half_m = 0.5 * std::abs(b.s - a.s);
  return {{key_of(row, col, kFineDraws), scale_of(row, col), spread(row, col, half_m, per_amplitude(half_m)),
           tails(row, col), rise_along(a, b)},
          ray_slope(place.s, per_2r)};
}

void FineGround::between(const RayPlace& a, const RayPlace& b, double per_2r, Fineness fineness,
                         FinePlaces& out) const {
  if (fineness == Fineness::kNone) return;
  out[0] = middle(a, b, per_2r);
  if (fineness == Fineness::kHalves) return;
  const RayPlace half = half_way(a, b);
  out[1] = middle(a, half, per_2r);
  out[2] = middle(half, b, per_2r);
}

float FineGround::highest(const FinePlaces& places, Fineness fineness, const HeightRange& a,
                          const HeightRange& b, const HeightRange& eye) const {
  const auto between = [&](const FinePlace& place, const HeightRange& from, const HeightRange& to) {
    const float most = most_ * place.draw.spread;
    const float rise = place.draw.rise;
    return HeightRange{0.5f * (from.low + to.low) + rise - most, 0.5f * (from.high + to.high) + rise + most};
  };
  const auto rise = [&](const FinePlace& place, const HeightRange& ground) {
    return slope_range(ground, eye, place.slope).high;
  };
  const HeightRange half = between(places[0], a, b);
  if (fineness == Fineness::kHalves) return rise(places[0], half);
  return std::max({rise(places[0], half), rise(places[1], between(places[1], a, half)),
                   rise(places[2], between(places[2], half, b))});
}

double FineGround::per_amplitude(double half_m) const {
  const ErrorField& error = terrain_.error;
  const GrowthProfile& profile = error.profile;
  if (!is_learnt(terrain_)) {
    const bool by_amplitude = profile.shape == GeologicShape::kGaussian && profile.range_m == 0;
    return by_amplitude ? NAN : profile(half_m, 0);
  }
  // Self-affine: the side of a cell in small, with both ends and the ground beside it known.
  const double side = 0.5 * (error.surface->row_edge.spread + error.surface->col_edge.spread);
  return error.plain_per_amplitude() * error.surface->points * side *
         std::pow(half_m / profile.half_spacing_m, profile.exponent);
}

float FineGround::spread(double row, double col, double half_m, double per_amplitude) const {
  const auto nearest = [](double x, int base, int count) {
    return std::clamp(base + static_cast<int>(std::floor(x + 0.5)), 0, count - 1);
  };
  const double amplitude = terrain_.error.amplitude.at(nearest(row, base_row_, terrain_.mean.rows()),
                                                       nearest(col, base_col_, terrain_.mean.cols()));
  if (amplitude <= 0) return 0;
  return static_cast<float>(
      amplitude * (std::isnan(per_amplitude) ? terrain_.error.profile(half_m, amplitude) : per_amplitude));
}

}  // namespace sightbound
