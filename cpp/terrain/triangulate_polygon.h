// SPDX-License-Identifier: GPL-3.0-or-later
// Faces with more than three corners, cut into triangles.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "terrain/tin.h"

namespace sightbound {

// The corners 0 ... 3 of a quad, in order round it, as two triangles: along the shorter diagonal in space
// (the one from corner 0 when equal), unless only the other one lies inside.
std::array<Face, 2> split_quad(const std::array<Xyz, 4>&);

// A polygon in space with its outer ring first and its holes after, no ring closed by a repeated corner:
// triangles of indices into all rings' corners one after the other, turned as the outer ring is. No new
// corners. It is cut as it appears along the axis that its normal is nearest to. Empty optional when that
// appearance crosses itself or has no area.
std::optional<std::vector<Face>> triangulate_polygon(const std::vector<std::vector<Xyz>>& rings);

}  // namespace sightbound
