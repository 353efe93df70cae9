// SPDX-License-Identifier: GPL-3.0-or-later
// Heights that observers and targets stand on when they are not the DEM's own (the bare earth under a surface
// model).
#pragma once

#include <cstddef>

#include "base/progress.h"
#include "terrain/dem.h"

namespace sightbound {

// The ground's heights at the DEM's samples of a window, NaN where it has none: read as they are when both
// lie on one grid, else interpolated on the ground's own terrain, a band of rows at a time. Throws
// InvalidInput when the coordinate systems differ or the ground does not reach the window.
Grid<float> ground_at(const DemSource& ground, const DemSource& dem, const Window&, Progress&);

// Bytes of a band at most, beyond the result.
inline constexpr std::size_t kGroundBandBytes = std::size_t{32} << 20;

// Interpolated on the terrain at (col, row) of the grid; NaN when a sample that counts is nodata.
double interpolate(const Grid<float>& samples, double col, double row);

}  // namespace sightbound
