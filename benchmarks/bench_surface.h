// SPDX-License-Identifier: GPL-3.0-or-later
// A DEM with the same error everywhere, for the benchmarks of the volume.
#pragma once

#include <cmath>
#include <memory>
#include <utility>

#include "io/raster_dem.h"
#include "volume/dem_surface.h"

namespace sightbound {

inline std::shared_ptr<const DemSurface> bench_surface(const DemSource& source, double sigma,
                                                       double variation = 0) {
  Progress progress;
  DemInput input{.heights = source.read(source.window(), progress),
                 .error = {},
                 .geotransform = source.geotransform(),
                 .crs_wkt = source.crs_wkt()};
  const auto& g = input.geotransform.coefficients();
  input.error.sampling = SampleField(static_cast<float>(sigma));
  input.error.amplitude = SampleField(static_cast<float>(variation / kZ95));
  input.error.cell_sizes.assign(static_cast<std::size_t>(source.rows()), {std::abs(g[1]), std::abs(g[5])});
  input.error.larger_side_m = std::abs(g[1]);
  input.error.profile.half_spacing_m = std::abs(g[1]) / 2;
  return std::make_shared<DemSurface>(std::move(input));
}

}  // namespace sightbound
