// SPDX-License-Identifier: GPL-3.0-or-later
// The error volume of a DEM as three rasters.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "error_model/error_model.h"
#include "jobs/windows.h"
#include "terrain/dem.h"

namespace sightbound {

struct ErrorSurfacesOptions {
  double confidence = 0.95;
  std::optional<Extent> extent;   // snapped outward to the DEM's grid; empty = the whole DEM
  int threads = 0;                // 0 = all cores
  std::size_t memory_budget = 0;  // bytes; 0 = three quarters of the machine's memory
};

// In the user's row order. sigma: the largest within half a cell of the sample (sigma_s + sigma_g at the
// cell's corner); lower, upper = height -+ z(confidence) sigma, rounded outward. NaN where the DEM has none.
struct ErrorSurfaces {
  Grid<float> sigma, lower, upper;
  Geotransform geotransform;
  std::string crs_wkt;
  std::string error_model;       // JSON of what was used; arrays are named as such
  std::size_t memory_bytes = 0;  // planned peak
  std::vector<std::string> warnings;
};

// Throws InvalidInput, IoError, OverBudget, Cancelled.
ErrorSurfaces run_error_surfaces(const DemSource&, const ErrorModel&, const ErrorSurfacesOptions&, Progress&);

}  // namespace sightbound
