// SPDX-License-Identifier: GPL-3.0-or-later
// How far from where the simplifier means them vertices lie once their coordinates are doubles of the CRS.
#pragma once

#include "simplify/simplify.h"

namespace sightbound {

// In columns and rows together, cells; 0 where doubles hold all coordinates of a lattice of 1/1024 cell, as
// they do for cells and corners of whole metres, halves, quarters ... Throws InvalidInput for coordinates
// beyond kLargestCoordinate (tin_cleaning.h), and for cells so small against them that faces might turn over.
double place_rounding(const DemPlace& place, int rows, int cols);

}  // namespace sightbound
