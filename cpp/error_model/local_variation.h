// SPDX-License-Identifier: GPL-3.0-or-later
// The between-sample error of each place, learnt from the samples around it.
#pragma once

#include "base/parallel.h"
#include "base/progress.h"
#include "error_model/error_model.h"
#include "error_model/surroundings.h"
#include "terrain/grid.h"

namespace sightbound {

// How residuals over two spacings become the error half a spacing from a sample.
struct ResidualScale {
  double to_half_spacing = 0.5;  // 2^-H for samples of a self-affine surface (fractal_surface.h)
  double diagonal = 0.5;         // mean square of a residual along a cell side over one along the diagonal
};
ResidualScale residual_scale(double growth_exponent, CellContent, double local_scale = 1);

// Standard deviation half a spacing from a sample, metres, at each sample of the window. How far a sample
// lies from the middle of its neighbours tells the error at twice the spacing; the rms over 3 x 3 samples,
// scaled, is the answer:
//
//   v = to_half_spacing sqrt(mean over 3 x 3 of (e_row^2 + e_col^2 + diagonal e_diagonal^2) / 3)
//   e = z - (z before + z after) / 2, along the row, the column and the NW-SE diagonal
//
// Residuals that nodata or the end of the DEM leaves out do not count; with none left, and on nodata itself,
// v is `typical_m`. Finite and >= 0 everywhere. Depends on the 5 x 5 samples around alone, not on window or
// threads. Cost: 10000 x 10000 in about 0.3 s on two cores; memory beyond the result: a few rows a thread.
// Only checks `progress`.
Grid<float> local_variation(const Surroundings& heights, const ResidualScale&, double typical_m,
                            const Workers&, Progress&);

}  // namespace sightbound
