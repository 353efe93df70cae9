// SPDX-License-Identifier: GPL-3.0-or-later
// Learning a DEM's between-sample error from the DEM itself, without any truth.
//
// Leave out every other sample, see how far the others' surface misses those left out (spacing 2: s2; the
// same places from samples twice as far apart: s4); the error grows as spacing^H, so at the DEM's own spacing it
// is s2 2^-H. H is log2(s4 / s2) and half of what it changed by from the spacings before: real ground grows
// faster towards shorter ones. Where cells are means the residuals of short spacings are too small, in a way that
// follows from H (fractal_surface.h). What this is worth on known terrain: docs/concepts/error_model.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "error_model/error_model.h"
#include "error_model/step_law.h"
#include "terrain/dem.h"

namespace sightbound {

inline constexpr int kEstimateBlocks = 64;
inline constexpr int kEstimateBlockSide = 256;
inline constexpr double kOversampledExponent = 1.7;  // above, cells are smaller than what was measured

struct Estimate {
  double growth_exponent = 1;  // H below the spacing, within 0.1 to 2
  double typical_m = 0;        // rms over the DEM of the sd half a spacing from a sample, with that H
  double rounding_m = 0;  // sd of the rounding of heights to a step (integer metres: 0.29 m); 0 = none found
  double edge_ms = 0,
         diagonal_ms = 0;  // mean squares of the residuals at spacing 2, along cell sides and diagonals, m^2
  // Residual rms along cell sides at spacing 2, 4 and 8, at the same places; 0 = too few.
  double rms_of_spacing[3] = {0, 0, 0};

  CellContent content = CellContent::kSamples;  // as asked, or as it looks
  double content_score = 0;  // 0: like samples, 1: like means of cells; between 0.5 and 0.8 it is not clear
  double ridge_gain = 0;     // by least squares: 0 to 0.25 (fractal_surface.h: 0.15 for smooth ground)

  // From predicting the DEM's own samples out of every other one: error over predicted sd.
  struct Quantiles {
    std::size_t places = 0;
    double median = 0, q683 = 0, q90 = 0, q95 = 0, q99 = 0;  // of its absolute value
  };
  Quantiles self_check;
  Tails tails = Tails::kNormal;  // that the quantiles look most like
  StepLaw steps;                 // the same
  double local_scale = 1;        // that makes 95 % of the DEM's own samples hold, half the way taken
  std::vector<std::string> warnings;

  // typical_m with another exponent.
  double typical_with(double exponent) const;
};

// `content` empty: samples or means, whichever the residuals and twists of short spacings look like.
//
// Looks at blocks spread over the whole DEM, a fixed function of the raster, so that the answer does not
// depend on who asks for which window; more of them only where most heights are missing. Blocks lie on the
// file's likely tiles. Cost: at most kEstimateBlocks blocks of kEstimateBlockSide^2 samples read, about 0.1 s
// to judge them. Only checks `progress`. A flat DEM has H = 1 and typical_m = 0; a DEM too small or too holey
// to measure H says so in `warnings`.
Estimate estimate(const DemSource&, std::optional<CellContent>, Progress&);

// The model with everything that was FromDem filled in (complete, see ErrorModel): vertical_rmse becomes the
// rounding; geologic_variation stays FromDem, the local map, with its exponent and typical value. What the
// user has said stays.
ErrorModel with_estimate(ErrorModel model, const Estimate& estimate);

}  // namespace sightbound
