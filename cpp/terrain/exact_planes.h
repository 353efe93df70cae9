// SPDX-License-Identifier: GPL-3.0-or-later
// Decided without rounding, for the doubles as they are.
#pragma once

#include "terrain/tin.h"

namespace sightbound {

bool in_one_plane(const Xyz& a, const Xyz& b, const Xyz& c, const Xyz& d);
bool on_one_line(const Xyz& a, const Xyz& b, const Xyz& c);
// In x and y: 1 counterclockwise, -1 clockwise, 0 on one line.
int turn_in_plan(const Xyz& a, const Xyz& b, const Xyz& c);

}  // namespace sightbound
