// SPDX-License-Identifier: GPL-3.0-or-later
// What measured heights leave open: where the ground may be at the samples, given the DEM and its error.
//
// A measurement is one witness, the samples around it are another: from these the height is known within the
// between-sample error p. Of a measurement z with error sigma and the mean m of the four neighbours
//   q^2 = p^2 + sigma^2 / 4                        error of m as a guess of the height
//   mean = z + (m - z) sigma^2 / (sigma^2 + q^2)   spread^2 = sigma^2 q^2 / (sigma^2 + q^2)
// (two independent witnesses, normal). Errors of different samples are taken as independent.
#pragma once

#include "base/parallel.h"
#include "base/progress.h"
#include "error_model/error_field.h"
#include "terrain/grid.h"

namespace sightbound {

struct Posterior {
  Grid<float> mean;    // metres, NaN = nodata; empty: the heights as they are
  SampleField spread;  // metres, one standard deviation
};

// Where a neighbour is missing the measurement stands alone. O(cells).
Posterior posterior(const Grid<float>& heights, const ErrorField&, const Workers&, Progress&);

}  // namespace sightbound
