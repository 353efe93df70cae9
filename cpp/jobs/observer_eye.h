// SPDX-License-Identifier: GPL-3.0-or-later
// An observer's eye above loaded terrain.
#pragma once

#include <string>

#include "jobs/loaded_terrain.h"
#include "jobs/observer_place.h"
#include "sight/sight_line.h"

namespace sightbound {

struct ObserverEye {
  Eye eye;            // from the window's grid
  double ground = 0;  // metres, what heights above ground count from
  double below = 0;   // metres by which the eye is under the terrain; 0 or less: it is not
};

// Throws InvalidInput where the terrain or the ground has no height. Keeps pointers to `frames`.
ObserverEye eye_above(const LoadedTerrain&, const Observer&, const std::string& name, const GridPlace&,
                      const ObserverFrames& frames, HeightReference);

}  // namespace sightbound
