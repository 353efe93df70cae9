// SPDX-License-Identifier: GPL-3.0-or-later
// What terrain does between the samples of a DEM, if it goes on below the cell as it does above: a
// self-affine surface, whose differences grow as distance^H (fractional Brownian surface; for H above 1 its
// increments of second order). Everything here follows from H, by least squares (kriging) over the nearest
// samples.
//
// On lidar terrains left with every fourth and eighth sample the weights so found differ from those that fit
// the truth best by a few hundredths, spreads by a tenth: docs/concepts/error_model.md.
#pragma once

#include "error_model/error_model.h"

namespace sightbound {

// Distances are in cells; spreads (standard deviations) in units of `plain`, the one half-way along a cell
// side: of the terrain there about the mean of the two heights beside it, rms over rows and columns.
struct FractalSurface {
  // A place half-way between samples: guessed as the mean of the samples beside it, plus `gain` times what
  // that mean stands above the mean of the samples one spacing farther out.
  struct Middle {
    double gain = 0, spread = 1;
  };
  Middle row_edge, col_edge;  // known samples and both centres beside it
  Middle centre;              // known samples
  double from_centres = 0;    // share of the mean error of the two centres that an edge takes over

  // Cells that are means: the terrain at a cell's centre is the mean plus `sample.gain` times what it stands
  // above its four neighbours. For samples both are 0.
  Middle sample{0, 0};
  double node = 0;    // spread at the cell's centre about the mean as it is
  double points = 1;  // what middles between points have for 1 above: their spreads count in this unit

  // `plain` from the rms of z - (z before + z after) / 2 of the cells' own values along rows and columns.
  double per_residual = 0.5;
};

// `exponent` H, taken within 0.1 and 1.9; `aspect`: height of a cell over its width. Some milliseconds.
FractalSurface fractal_surface(double exponent, CellContent, double aspect = 1);

// log2 of the ratio of residuals (as above) at twice the spacing and at one spacing, as the cells show it: H
// for samples, more for means. With `octave` 1, the next such ratio ...
double apparent_exponent(double exponent, CellContent, int octave = 0);
// log2 of the rms of twists z - z(right) - z(below) + z(right and below), `1 << octave` cells apart, over
// that of the residuals.
double twist_over_residual(double exponent, CellContent, int octave);
// H from the ratio of residuals; within 0.1 and 1.9.
double exponent_from_apparent(double apparent, CellContent);

}  // namespace sightbound
