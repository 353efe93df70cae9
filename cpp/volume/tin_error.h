// SPDX-License-Identifier: GPL-3.0-or-later
// The error model brought onto the vertices of a TIN.
#pragma once

#include <vector>

#include "error_model/error_field.h"
#include "error_model/error_model.h"
#include "terrain/tin.h"
#include "volume/surface.h"

namespace sightbound {

struct TinError {
  std::vector<float> sampling;  // sigma_s of each vertex, metres
  std::vector<float>
      amplitude;  // Delta / z(0.95) of each vertex, metres; empty = nothing between the samples
  GrowthProfile profile;
  double spacing_m = 0;  // L: the median edge
};

// sigma_s is that of the steepest face around the vertex:
//   vertical metric   sigma_v + sigma_h tan(slope)
//   along the normal  the largest of sigma_v |cos(slope)| + sigma_h |sin(slope)|
// sigma_v is the TIN's own where it has one, else the model's vertical_rmse. Throws InvalidInput when sigma_v
// is missing somewhere, and for what only a raster has: learnt and rastered quantities, terrain types.
TinError resolve_tin_error(const Tin&, const ErrorModel&, Metric);

}  // namespace sightbound
