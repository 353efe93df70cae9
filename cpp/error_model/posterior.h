// SPDX-License-Identifier: GPL-3.0-or-later
// What measured heights leave open: where the ground may be, given the DEM and its error.
//
// At a sample. A measurement is one witness, the samples around it are another: from these the height is
// known within the between-sample error p. Of a measurement z with error sigma and the mean m of the four
// neighbours
//   q^2 = p^2 + sigma^2 / 4                        error of m as a guess of the height
//   mean = z + (m - z) sigma^2 / (sigma^2 + q^2)   spread^2 = sigma^2 q^2 / (sigma^2 + q^2)
// (two witnesses, normal). Where errors of different samples are correlated (correlated_noise.h), rho between
// neighbours, z - m tells less of them:
//   q^2 + sigma^2 = p^2 + sigma^2 (1 - 2 rho + mean correlation of the four with each other)
//   mean = z + (m - z) (1 - rho) sigma^2 / (q^2 + sigma^2)
// and what is left of them stays correlated. Where cells are means, ridges have been planed off and valleys
// filled: the terrain stands above a mean by a share of what that stands above its neighbours
// (fractal_surface.h: sample).
//
// Half-way between samples. The terrain stands above the middle of two or four samples by a share of what
// that middle stands above the samples farther out (fractal_surface.h: gain).
#pragma once

#include "base/parallel.h"
#include "base/progress.h"
#include "error_model/error_field.h"
#include "terrain/grid.h"

namespace sightbound {

// Metres above the mean of the samples beside; 0 where a sample farther out is missing.
struct MiddleRises {
  Grid<float> row_edge;  // between a sample and the next of its row
  Grid<float> col_edge;  // ... of its column
  Grid<float> centre;    // of the square of which it is the first corner
};

struct Posterior {
  Grid<float> mean;    // metres, NaN = nodata; empty: the heights as they are
  SampleField spread;  // metres, one standard deviation
  SampleField shared;  // the same, of correlated errors: beyond `spread`
  bool has_shared() const { return !shared.is_constant() || shared.constant() != 0; }
  MiddleRises rises;  // empty without a surface learnt from the DEM
};

// Where a neighbour is missing the measurement stands alone. O(cells).
Posterior posterior(const Grid<float>& heights, const ErrorField&, const Workers&, Progress&);

}  // namespace sightbound
