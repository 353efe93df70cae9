// SPDX-License-Identifier: GPL-3.0-or-later
// A patrol area cut into cells, each with a place within the area that stands for it.
#pragma once

#include <string>
#include <vector>

#include "terrain/geotransform.h"
#include "terrain/tin.h"

namespace sightbound {

// Inside is what an odd number of rings goes round; z is not looked at. Local metres.
using Rings = std::vector<std::vector<Xyz>>;

Box3 box_of(const Rings&);

// A place and all of the area that it stands for; heights not yet told.
struct PlanCell {
  Xy place;
  Box3 box;
};

// The squares of a fixed lattice whose middles lie in the area (half as large, again and again, until there
// is one), each with what of the area lies in squares beside it: together they cover the area. Throws
// InvalidInput (too large for the spacing, no area); `name` begins the message.
std::vector<PlanCell> plan_cells(const Rings&, double spacing_m, const std::string& name);

}  // namespace sightbound
