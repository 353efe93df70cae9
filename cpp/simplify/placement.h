// SPDX-License-Identifier: GPL-3.0-or-later
// Where the vertex goes that an edge is drawn together into.
#pragma once

#include <optional>

#include "simplify/envelope.h"
#include "simplify/quadric.h"

namespace sightbound {

// What the new vertex may do, by the ends of the edge.
enum class Freedom {
  kNone,    // it is vertex a
  kHeight,  // in a's place
  kLine,    // between a and b, on the outline
  kPlane,
};

// A place where all triangles to the star's ring lie in the envelope, or leave the surface as it is, and none
// is turned over or thinner than kThinnest. The quadric's comes first; where that one will not do, a search
// goes for the place where least is missing. The height is in the middle of those it may have: that leaves
// most to the collapses to come. Where the outline advances the surface grows, be it in its plane, and all of
// it is held against the envelope. Nothing when none is found.
std::optional<Point> find_place(const Envelope& envelope, const EdgeStar& star, const QuadricSum& quadric,
                                Freedom freedom, bool outline_advances);

// Where a vertex inside has most room: near its place in plan, the height in the middle of the widest
// interval found. Nothing when it is there already. `star` is its own (gather_around).
std::optional<Point> find_room(const Envelope& envelope, const EdgeStar& star);

inline constexpr double kThinnest = 1.0 / 64;  // cells: least height of a triangle in plan

}  // namespace sightbound
