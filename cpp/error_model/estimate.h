// SPDX-License-Identifier: GPL-3.0-or-later
// Learning a DEM's between-sample error from the DEM itself, without any truth.
//
// Leave out every other sample, see how far the others' surface misses those left out (spacing 2: s2; the
// same places from samples twice as far apart: s4); the error grows as spacing^H with H = log2(s4 / s2), so
// at the DEM's own spacing it is s2 2^-H. What this is worth on known terrain: docs/concepts/error_model.md.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "error_model/error_model.h"
#include "terrain/dem.h"

namespace sightbound {

inline constexpr int kEstimateBlocks = 64;
inline constexpr int kEstimateBlockSide = 256;
inline constexpr double kOversampledExponent = 1.7;  // above, cells are smaller than what was measured

struct Estimate {
  double growth_exponent = 1;  // H, within 0.1 to 2
  double typical_m =
      0;  // rms over the DEM of the between-sample sd half a spacing from a sample, with that H
  double rounding_m = 0;  // sd of the rounding of heights to a step (integer metres: 0.29 m); 0 = none found
  double edge_ms = 0,
         diagonal_ms = 0;  // mean squares of the residuals at spacing 2, along cell sides and diagonals, m^2
  std::vector<std::string> warnings;

  // typical_m with another exponent.
  double typical_with(double exponent) const;
};

// Looks at blocks spread over the whole DEM, a fixed function of the raster, so that the answer does not
// depend on who asks for which window; more of them only where most heights are missing. Blocks lie on the
// file's likely tiles. Cost: at most kEstimateBlocks blocks of kEstimateBlockSide^2 samples read, about 0.1 s
// to judge them. Only checks `progress`. A flat DEM has H = 1 and typical_m = 0; a DEM too small or too holey
// to measure H says so in `warnings`.
Estimate estimate(const DemSource&, Progress&);

// The model with everything that was FromDem filled in (complete, see ErrorModel): vertical_rmse becomes the
// rounding; geologic_variation stays FromDem, the local map, with its exponent and typical value. What the
// user has said stays.
ErrorModel with_estimate(ErrorModel model, const Estimate& estimate);

}  // namespace sightbound
