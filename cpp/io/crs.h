// SPDX-License-Identifier: GPL-3.0-or-later
// The only place that knows PROJ.
#pragma once

#include <string>

#include "earth/georeference.h"
#include "terrain/dem.h"

namespace sightbound {

// The DEM's place on the Earth from its CRS (horizontal part of a compound one; the CRS's own ellipsoid, longitudes and
// latitudes on its own datum). Without a CRS a plane in metres; throws InvalidInput when the coordinates look like degrees,
// when the CRS cannot be understood, or is neither projected nor geographic.
Georeference georeference_of(const DemSource&);

}  // namespace sightbound
