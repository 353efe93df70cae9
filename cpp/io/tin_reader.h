// SPDX-License-Identifier: GPL-3.0-or-later
// TINs from files.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "io/tin_source.h"
#include "terrain/tin.h"

namespace sightbound {

// PLY, OBJ, 2DM and LandXML, told by their first bytes (OBJ by its ending), and every vector source that GDAL
// opens: 3D polygons, TIN Z and polyhedral surfaces become faces; 3D points, and lines as breaklines, are
// triangulated. The result is clean (tin_cleaning.h); what was converted or repaired is in its notes. Memory:
// the file and some twice the TIN. Throws IoError (cannot open, truncated), InvalidInput (damaged, degrees,
// several surfaces and none named ...), OverBudget, Cancelled.
Tin read_tin(const std::string& path, const TinReadOptions&, Progress&);

// Names of a LandXML file's surfaces or a vector source's layers; empty for formats with one mesh a file.
std::vector<std::string> tin_layers(const std::string& path, Progress&);

}  // namespace sightbound
