// SPDX-License-Identifier: GPL-3.0-or-later
// Rasters and polygons of error, brought onto a window of the DEM's grid.
#pragma once

#include <map>
#include <string>

#include "base/progress.h"
#include "error_model/error_model.h"
#include "terrain/dem.h"

namespace sightbound {

// Values of a raster at the DEM's samples (bilinear; any CRS, any cell size); NaN where it has none.
// Throws IoError, and InvalidInput for negative values or a raster that does not overlap the window.
Grid<float> aligned_raster(const RasterFile&, const DemSource&, const Window&, Progress&);

// Delta at the DEM's samples from polygons; NaN outside all of them. An unknown class is an InvalidInput that
// lists those unknown and those known; an empty layer, a missing field or a NULL value is one too.
Grid<float> terrain_type_variation(const TerrainTypes&, const DemSource&, const Window&, Progress&);

// class -> metres from a JSON object or a two-column CSV file.
std::map<std::string, double> read_terrain_table(const std::string& path);

}  // namespace sightbound
