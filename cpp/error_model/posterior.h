// SPDX-License-Identifier: GPL-3.0-or-later
// What measured heights leave open: where the ground may be, given the DEM and its error.
//
// At a sample. A measurement is one witness, the samples around it are another: from these the height is
// known within the between-sample error p. Of a measurement z with error sigma and the mean m of the four
// neighbours
//   q^2 = p^2 + sigma^2 / 4                        error of m as a guess of the height
//   mean = z + (m - z) sigma^2 / (sigma^2 + q^2)   spread^2 = sigma^2 q^2 / (sigma^2 + q^2)
// (two independent witnesses, normal). Errors of different samples are taken as independent. Where cells are
// means, ridges have been planed off and valleys filled: the terrain stands above a mean by a share of what
// that stands above its neighbours (fractal_surface.h: sample).
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
  MiddleRises rises;   // empty without a surface learnt from the DEM
};

// Where a neighbour is missing the measurement stands alone. O(cells).
Posterior posterior(const Grid<float>& heights, const ErrorField&, const Workers&, Progress&);

}  // namespace sightbound
