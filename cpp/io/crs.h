// SPDX-License-Identifier: GPL-3.0-or-later
// The only place that knows PROJ.
#pragma once

#include <optional>
#include <string>

#include "earth/georeference.h"
#include "terrain/dem.h"

namespace sightbound {

// The DEM's place on the Earth from its CRS (horizontal part of a compound one; the CRS's own ellipsoid,
// longitudes and latitudes on its own datum). Axis order is always x = east, y = north; no grid is fetched
// from the network. May be used by several threads at once. Without a CRS a plane in metres, for a local CRS
// a plane with its geotransform scaled to metres; throws InvalidInput when the coordinates look like degrees
// without a CRS, when the CRS cannot be understood, or has no map coordinates.
Georeference georeference_of(const DemSource&);

// Throws InvalidInput when a raster without a CRS lies and is sized like one in degrees.
void refuse_degrees_without_crs(const Geotransform&, int rows, int cols);

// Length units of a CRS.
struct CrsUnits {
  std::optional<double> horizontal_m;  // metres per unit; empty for degrees
  std::optional<double>
      vertical_m;  // metres per unit of the vertical (or third) axis; empty when there is none
  std::string horizontal_name, vertical_name;
};
// Throws InvalidInput when the CRS cannot be understood.
CrsUnits crs_units(const std::string& crs_wkt);

// The horizontal part of a CRS as WKT2:2019; empty for an empty one.
std::string horizontal_crs(const std::string& crs_wkt);

// Do both say the same places, whatever the wording? False when one cannot be understood.
bool same_crs(const std::string& a, const std::string& b);

}  // namespace sightbound
