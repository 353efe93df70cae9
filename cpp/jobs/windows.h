// SPDX-License-Identifier: GPL-3.0-or-later
// Rectangles in the user's coordinates, brought onto the grid of a DEM and back.
#pragma once

#include <optional>

#include "terrain/dem.h"

namespace sightbound {

struct Extent {
  double x_min = 0, y_min = 0, x_max = 0, y_max = 0;  // in the DEM's CRS
};

// The smallest window of whole cells (core's row order) that covers the part of `extent` inside the DEM; an
// edge within a thousandth of a cell of a cell border counts as on it. For rotated rasters the window covers
// all four corners. Throws InvalidInput for an extent that is not finite, empty, or wholly outside the DEM.
Window snap_extent(const Extent& extent, const DemSource&);

// The extent when there is one, else the whole DEM.
Window window_of(const std::optional<Extent>& extent, const DemSource&);

// Geotransform of a window in the user's row order, for what is delivered after flip_rows() when
// source.flipped().
Geotransform delivered_geotransform(const DemSource&, const Window&);

}  // namespace sightbound
