// SPDX-License-Identifier: GPL-3.0-or-later
// Break lines as people have them, polylines, to edges of a TIN.
#pragma once

#include <vector>

#include "base/progress.h"
#include "simplify/tin_lines.h"
#include "terrain/tin.h"

namespace sightbound {

// A vertex this near to a line lies on it, metres.
inline constexpr double kNearLine = 1e-3;

// The edges along polylines, in metres from the Tin's origin; `in_plan` looks at x and y alone. Each piece
// runs from vertex to vertex along edges, over others that lie on it. Throws InvalidInput: how many pieces
// have no such edges, and where the first is. Time: O(log n) and the vertices near a piece.
std::vector<TinEdge> edges_along(const Tin&, const std::vector<std::vector<Xyz>>& lines, bool in_plan,
                                 Progress&);

}  // namespace sightbound
