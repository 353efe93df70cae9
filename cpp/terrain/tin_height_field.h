// SPDX-License-Identifier: GPL-3.0-or-later
// Is a TIN the graph of a function, one height a place?
#pragma once

#include <string>

#include "terrain/tin.h"

namespace sightbound {

// In a file of millimetres the corner of a face on the edge of another misses it by as much as 1.4 mm: half a
// millimetre in x and y, of the corner and of the edge. Two heights on so narrow a strip are no overhang.
inline constexpr double kPlanOverlap = 0.0015;  // metres

struct HeightFieldTest {
  bool passed = false;
  std::string reason;  // why not
};

// True when every face looks up (its plan area is positive beyond rounding) and no two overlap in plan by
// more than kPlanOverlap. The Tin must be clean. O(faces + b log b + b s) for b border edges of which s lie
// above one another.
HeightFieldTest height_field_test(const Tin&);
inline bool is_height_field(const Tin& tin) { return height_field_test(tin).passed; }

}  // namespace sightbound
