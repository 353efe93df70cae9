// SPDX-License-Identifier: GPL-3.0-or-later
// The outer cover of an error volume as rasters, one cell a voxel column: the space in which the true surface
// lies at a confidence, seen from above.
#pragma once

#include "terrain/geotransform.h"
#include "terrain/grid.h"
#include "volume/error_volume.h"

namespace sightbound {

// North up; the cells are those that outer(c) has voxels over. NaN where a column has none.
struct CoverRasters {
  Grid<float> lower, upper;  // floor of the lowest voxel, ceiling of the highest; metres, rounded outward
  Grid<float> thickness;     // of all its voxels, metres; less than upper - lower where there are gaps: under
                             // a bridge, between the ground and a roof
  Geotransform geotransform;
};

// Throws InvalidInput for a confidence outside (0, 1) or beyond the band.
CoverRasters rasters_of(const ErrorVolume&, double confidence);

}  // namespace sightbound
