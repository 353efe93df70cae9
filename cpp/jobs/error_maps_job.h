// SPDX-License-Identifier: GPL-3.0-or-later
// The two parts of a DEM's error as rasters.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "error_model/error_model.h"
#include "terrain/dem.h"

namespace sightbound {

// In the user's row order, metres, NaN where the DEM has no height.
struct ErrorMaps {
  Grid<float> between;   // sigma_g half a spacing (half the larger cell side) from the sample
  Grid<float> sampling;  // sigma_s at the sample
  Geotransform geotransform;
  std::string crs_wkt;
  std::string error_model;  // JSON of what was used
};

// Throws InvalidInput, IoError, OverBudget, Cancelled.
ErrorMaps run_error_maps(const DemSource&, const ErrorModel&, int threads, Progress&);

// GeoTIFFs; an empty path = not wanted. They appear together or not at all.
void write_error_maps(const ErrorMaps&, const std::string& between, const std::string& sampling,
                      const std::vector<std::string>& creation_options, int threads, Progress&);

}  // namespace sightbound
