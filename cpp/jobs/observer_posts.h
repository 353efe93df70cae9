// SPDX-License-Identifier: GPL-3.0-or-later
// Observers on a DEM: what each is asked about and what must be in memory for it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "earth/observer_frames.h"
#include "jobs/observer_place.h"
#include "jobs/windows.h"
#include "sight/viewshed.h"

namespace sightbound {

// One observer on his way through a job. Windows are in the whole raster.
struct Post {
  const Observer& observer;
  std::string name;
  GridPlace place;
  Window reach;    // what he could be asked about
  Window targets;  // what he is asked about
  Window lines;    // what must be in memory for it
  ObserverFrames frames;
};

// Keeps `observers` by reference. Throws InvalidInput for what is wrong with one, naming it.
std::vector<Post> place_observers(const DemSource&, const Georeference&,
                                  const std::vector<Observer>& observers, const std::optional<Extent>&,
                                  Progress&);

// A cell on the limit is within it: distances are good to 1e-6 cells.
ViewLimits limits_of(const Observer&, double larger_side_m);

// A surface needs two samples each way.
Window with_room(Window, const DemSource&);

}  // namespace sightbound
