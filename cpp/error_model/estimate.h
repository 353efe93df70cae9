// SPDX-License-Identifier: GPL-3.0-or-later
// Learning a DEM's between-sample error from the DEM itself, without any truth.
//
// Leave out every other sample, see how far the others' surface misses those left out (spacing 2: s2; every second of
// those again: s4); the error grows as spacing^H with H = log2(s4 / s2), so at the DEM's own spacing it is s2 2^-H.
// Measured on sixteen lidar terrains: true over predicted 0.66-1.07, median 0.84.
#pragma once

#include <string>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "error_model/error_field.h"
#include "error_model/error_model.h"
#include "terrain/dem.h"

namespace sightbound {

struct Estimate {
  double growth_exponent = 1;  // H
  double typical_m = 0;        // rms over the DEM of the between-sample sd half a spacing from a sample
  double rounding_m = 0;       // sd of the rounding of heights to a step (integer metres: 0.29 m); 0 = none found
  std::vector<std::string> warnings;
};

// Looks at blocks spread over the whole DEM, a fixed function of the raster, so that the answer does not depend on who
// asks for which window. Cost: at most kEstimateBlocks blocks of kEstimateBlockSide^2 samples read.
Estimate estimate(const DemSource&, Progress&);

// The model with everything that was FromDem filled in by the estimate (local map kept as FromDem with growth).
ErrorModel with_estimate(ErrorModel model, const Estimate& estimate);

// sd half a spacing from a sample at each sample of `heights`, from the 5 x 5 samples around it:
// rms over 3 x 3 of the decimation residual, times 2^-H. Samples whose surroundings are nodata get `typical_m`.
// `halo` rows and columns of `heights` around the wanted window must be given where the DEM has them (kLocalHalo).
inline constexpr int kLocalHalo = 2;
Grid<float> local_variation(const Grid<float>& heights, double growth_exponent, double typical_m, const Workers&, Progress&);

// Sampling error at each sample (Koppe): sigma_v + sigma_h tan(slope of the steepest face around).
Grid<float> sampling_error(const Grid<float>& heights, const SampleField& sigma_v, double sigma_h,
                           std::span<const CellSize> cell_sizes, const Workers&, Progress&);

}  // namespace sightbound
