// SPDX-License-Identifier: GPL-3.0-or-later
// Is a TIN the graph of a function, one height a place?
#pragma once

#include <string>

#include "terrain/tin.h"

namespace sightbound {

// Faces of files with rounded coordinates overlap by as much where a corner of one lies on the edge of
// another. Half the floor of sigma (1 mm) moves no verdict.
inline constexpr double kPlanOverlap = 0.0005;  // metres

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
