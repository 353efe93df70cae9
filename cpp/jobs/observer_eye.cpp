// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/observer_eye.h"

#include <cmath>

#include "base/error.h"

namespace sightbound {

ObserverEye eye_above(const LoadedTerrain& terrain, const Observer& observer, const std::string& name,
                      const GridPlace& place, const ObserverFrames& frames, HeightReference reference) {
  const Window& window = terrain.window();
  const double col = place.whole_col() - window.col, row = place.whole_row() - window.row;
  const double terrain_height = interpolate(terrain.scene().heights, col, row);
  ObserverEye placed;
  placed.ground = interpolate(terrain.ground(), col, row);
  if (std::isnan(placed.ground) || std::isnan(terrain_height)) {
    throw InvalidInput(name +
                       " stands where the DEM has no height (nodata). Move it, or fill the hole first.");
  }
  const bool absolute = reference == HeightReference::kAbsolute;
  const SampleField& sampling = terrain.scene().error.sampling;
  placed.eye = {&frames.widest(),
                place.base_col - window.col,
                place.base_row - window.row,
                absolute ? observer.height : placed.ground + observer.height,
                sampling.is_constant() ? static_cast<double>(sampling.constant())
                                       : interpolate(sampling.values(), col, row),
                &frames};
  placed.below = terrain_height - placed.eye.height;
  return placed;
}

}  // namespace sightbound
