// SPDX-License-Identifier: GPL-3.0-or-later
// From triangles as files have them to a Tin that keeps its promises.
#pragma once

#include <string>

#include "terrain/tin.h"

namespace sightbound {

// A face whose height over its longest edge is less than this part of that edge has no area: its corners lie
// on a line but for the rounding of coordinates (2^-52 at 1e3 edges from the origin, with room to spare).
inline constexpr double kFlatness = 1e-12;

inline constexpr double kLargestCoordinate = 1e9;  // metres or feet: the Earth is 4e7 m round

// Throws InvalidInput (beginning with `what`, such as "The TIN") when nothing is left or nothing can be made
// of it: empty, an index out of range, a corner that is not finite, lists of wrong length. Repaired, each
// with its count in notes: vertices at exactly one place become one (the first, with its attributes), faces
// without area and repeated ones are dropped, vertices of no face too, faces are turned alike. Non-manifold
// edges and parts that cannot be turned alike stay and are noted. O(n log n).
Tin clean(Tin, const std::string& what);

}  // namespace sightbound
