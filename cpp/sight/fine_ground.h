// SPDX-License-Identifier: GPL-3.0-or-later
// Realised terrain between two places of a ray that are half a cell apart or less: near the eye and near the
// target a rise of decimetres decides, and none of the nodes may be there.
//
// Half-way between two known places D apart terrain rises or falls by the between-sample error at D / 2 from
// the nearest, and so on into halves (midpoint displacement), about a line that bends as the middles of cell
// sides L do: (D / L)^2 of what those rise by. Draws belong to the eighth of a cell that they
// lie in.
#pragma once

#include <cstdint>

#include "sight/realised_columns.h"

namespace sightbound {

// A place of a ray.
struct RayPlace {
  double major = 0, minor = 0;  // samples from the observer's base sample
  double s = 0;                 // metres from the eye along the ground
};

// What turns a height there into the slope of a line of sight: (height - eye) per_s - drop.
struct RaySlope {
  float per_s, drop;
};
inline RaySlope ray_slope(double s, double per_2r) {
  return {static_cast<float>(1 / s), static_cast<float>(per_2r * s)};
}

// Of all realisations, and a little more: roundings included.
HeightRange slope_range(const HeightRange& ground, const HeightRange& eye, const RaySlope&);

// A height on the way between two others, given theirs.
struct FinePlace {
  Departure draw;
  RaySlope slope;
};

// How many there are between two places: none, the middle, or the middle and those of both halves, in this
// order.
enum class Fineness : std::uint8_t { kNone = 0, kHalves = 1, kQuarters = 3 };
using FinePlaces = FinePlace[3];

// From one node to the next, samples.
inline constexpr double kNodeStep = 0.5;
struct NodeStep {
  double major, minor;
};

class FineGround {
 public:
  // With the base sample on the terrain's grid. Without `crossings` nothing departs between nodes.
  FineGround(const OpenTerrain&, bool transposed, int base_row, int base_col, bool crossings = true);

  // `per_2r`: (1 - refraction) / 2R along the ray.
  void between(const RayPlace& a, const RayPlace& b, double per_2r, Fineness, FinePlaces& out) const;

  // Ground taken from two nodes half a cell apart, a share `part` of the way from the first: what it departs
  // by from the line between them.
  Departure across(const RayPlace&, const NodeStep&, double part) const;
  // ... of ground taken from four nodes, at these shares of the way between them.
  Departure inside(const RayPlace&, double along, double across) const;
  float most_across(const RayPlace& place, double part) const { return most_ * spread_across(place, part); }
  float rise_across(const RayPlace&, const NodeStep&, double part) const;
  // What departs between two places depends on how they step.
  const StepLaw& steps() const { return steps_; }

  // No realisation's slope is higher. `fineness` is not kNone.
  float highest(const FinePlaces&, Fineness, const HeightRange& a, const HeightRange& b,
                const HeightRange& eye) const;

 private:
  DrawKey key_of(double row, double col, std::uint64_t kind) const;
  DrawKey scale_of(double row, double col) const;
  FinePlace middle(const RayPlace& a, const RayPlace& b, double per_2r) const;
  // Of ground half-way between two places, over the amplitude there; NaN where it depends on that.
  double per_amplitude(double half_m) const;
  float spread_across(const RayPlace&, double part) const;
  float rise_along(const RayPlace& a, const RayPlace& b) const;
  float rise(double row, double col, double rows, double cols) const;
  // Four samples.
  struct Square {
    int row, col, row1, col1;
  };
  Square around(double row, double col) const;
  double step_factor(double row, double col) const;
  DrawnTails tails(double row, double col) const;
  float spread(double row, double col, double half_m, double per_amplitude) const;
  double row_of(const RayPlace& place) const { return transposed_ ? place.major : place.minor; }
  double col_of(const RayPlace& place) const { return transposed_ ? place.minor : place.major; }

  const OpenTerrain& terrain_;
  const bool transposed_;
  const int base_row_, base_col_;
  const StepLaw steps_;
  const float most_;          // of a draw, in standard deviations
  const double half_across_;  // metres: half of half a cell
  const double across_per_amplitude_;
};

}  // namespace sightbound
