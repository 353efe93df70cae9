// SPDX-License-Identifier: GPL-3.0-or-later
// Realised terrain between two places of a ray that are half a cell apart or less: near the eye and near the
// target a rise of decimetres decides, and none of the nodes may be there.
//
// Half-way between two known places D apart terrain rises or falls by the between-sample error at D / 2 from
// the nearest, and so on into halves (midpoint displacement). Draws belong to the eighth of a cell that they
// lie in.
#pragma once

#include <cstdint>

#include "sight/realised_columns.h"

namespace sightbound {

// A place of a ray and its ground.
struct RayPlace {
  double major = 0, minor = 0;  // samples from the observer's base sample
  double s = 0;                 // metres from the eye along the ground
  Lanes ground;
};

// The slope of a line of sight: (height - eye) / s - per_2r s, over the curved ground.
struct RaySlopes {
  Lanes eye;          // absolute heights
  double per_2r = 0;  // (1 - refraction) / 2R
};

class FineGround {
 public:
  // With the base sample on the terrain's grid.
  FineGround(const OpenTerrain& terrain, bool transposed, int base_row, int base_col,
             std::uint32_t first_realisation)
      : terrain_(terrain),
        transposed_(transposed),
        base_row_(base_row),
        base_col_(base_col),
        first_(first_realisation) {}

  // Raises the horizon by what lies between two places, their middle, and if `depth` is more than 1 the
  // middles of the halves ...
  void raise(const RayPlace& a, const RayPlace& b, int depth, const RaySlopes&, Lanes& horizon) const;

  // The middle of two places, its ground drawn.
  RayPlace middle(const RayPlace& a, const RayPlace& b) const;
  // By how much it departs from the mean of the two, metres (standard deviation).
  float spread_between(const RayPlace& a, const RayPlace& b) const;

 private:
  const OpenTerrain& terrain_;
  const bool transposed_;
  const int base_row_, base_col_;
  const std::uint32_t first_;
};

// NaN raises the horizon for good: what lies behind the unknown is not seen.
void raise_horizon(const RayPlace& at, const RaySlopes&, Lanes& horizon);

}  // namespace sightbound
