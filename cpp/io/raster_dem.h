// SPDX-License-Identifier: GPL-3.0-or-later
// A DEM in a raster file, read by windows through GDAL.
#pragma once

#include <memory>
#include <string>

#include "terrain/dem.h"

namespace sightbound {

enum class VerticalUnit { kAuto, kMetre, kFoot, kUsSurveyFoot };
VerticalUnit vertical_unit_from(const std::string& name);  // "auto", "metre", "foot", "us-foot"

// Opens `path` (anything GDAL reads). kAuto takes the vertical CRS's unit, else the band's unit, else metres
// with a note when the horizontal unit is a foot. Scale, offset, mask bands and every kind of declared nodata
// are honoured. Throws IoError (cannot open, truncated), InvalidInput (band out of range, no georeference,
// degrees without a CRS ...).
std::unique_ptr<DemSource> open_dem(const std::string& path, int band = 1,
                                    VerticalUnit unit = VerticalUnit::kAuto);

double metres_per(VerticalUnit unit);

}  // namespace sightbound
