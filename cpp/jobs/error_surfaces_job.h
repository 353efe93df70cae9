// SPDX-License-Identifier: GPL-3.0-or-later
// The error volume of a DEM as three rasters.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "jobs/viewshed_job.h"

namespace sightbound {

struct ErrorSurfacesOptions {
  double confidence = 0.95;
  std::optional<Extent> extent;
  int threads = 0;
  std::size_t memory_budget = 0;
};

// In the user's row order. sigma: the largest within half a cell of the sample (sigma_s + sigma_g at the cell's corner);
// lower, upper = height -+ z(confidence) sigma. NaN where the DEM has none.
struct ErrorSurfaces {
  Grid<float> sigma, lower, upper;
  Geotransform geotransform;
  std::string crs_wkt;
  std::string error_model;  // JSON of what was used
  std::vector<std::string> warnings;
};
ErrorSurfaces run_error_surfaces(const DemSource&, const ErrorModel&, const ErrorSurfacesOptions&, Progress&);

}  // namespace sightbound
