// SPDX-License-Identifier: GPL-3.0-or-later
// Check points from vector files.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "io/raster_dem.h"
#include "terrain/dem.h"
#include "terrain/tin.h"

namespace sightbound {

struct CheckPointFile {
  std::string path;             // any vector source, any CRS
  std::string layer;            // empty = the only one
  std::string elevation_field;  // empty = Z of the points
  VerticalUnit vertical_unit =
      VerticalUnit::kAuto;  // of the elevations; kAuto = as the CRS says, else metres
};
struct CheckPoints {
  std::vector<Xyz> places;         // x, y in the DEM's CRS, z in metres
  std::vector<std::string> notes;  // what was converted or left out
};

// Throws IoError (cannot open), InvalidInput: an empty layer, several layers and none named, a missing field
// or one without numbers, points without Z, geometries that are no points.
CheckPoints read_check_points(const CheckPointFile&, const DemSource& dem, Progress&);

}  // namespace sightbound
