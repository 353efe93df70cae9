// SPDX-License-Identifier: GPL-3.0-or-later
// The CRS of TINs: projected or none, its lengths turned into metres.
#pragma once

#include <string>

namespace sightbound {

// Metres per unit of a CRS in plan; 1 for none. Throws InvalidInput for degrees ("reproject to a projected
// CRS such as UTM") and for a CRS that cannot be understood.
double metres_per_plan_unit(const std::string& crs_wkt);

// WKT2:2019 of whatever the user or a file calls a CRS (EPSG:32633, WKT, PROJ string); no file or network is
// asked. Empty when it cannot be understood.
std::string crs_from_text(const std::string& text);

// "EPSG:32633" where the CRS is exactly that, else its WKT on one line; empty for none.
std::string short_crs(const std::string& crs_wkt);

}  // namespace sightbound
