// SPDX-License-Identifier: GPL-3.0-or-later
// Which unit heights are stored in. Internal to cpp/io.
#pragma once

#include <string>
#include <vector>

#include "io/crs.h"
#include "io/raster_dem.h"

namespace sightbound {

struct VerticalScale {
  double metres_per_unit = 1;
  std::vector<std::string> notes;  // what was converted, assumed or contradictory
};

// The unit asked for; for kAuto the vertical CRS's, else the band's, else metres. A band that says
// centimetres or the like wins over its CRS: no vertical CRS uses them, they say how values are packed.
VerticalScale choose_vertical_unit(VerticalUnit asked, const CrsUnits&, const std::string& band_unit);

}  // namespace sightbound
