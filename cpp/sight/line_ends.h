// SPDX-License-Identifier: GPL-3.0-or-later
// How both engines judge a line near its ends (design: docs/guarantees.md, section 1). Lengths in larger cell
// sides, L.
#pragma once

#include <array>

namespace sightbound {

// Places nearer to an end are judged with the between-sample error alone.
inline constexpr double kEndZoneCells = 1.5;
// Judged beside the crossings, from either end: doubt does not vanish between crossings.
inline constexpr std::array kEndPlaces{1.0 / 16, 1.0 / 8, 1.0 / 4, 1.0 / 2, 3.0 / 4};
// A place nearer to an end is the end itself: what is left of the clearance there is rounding.
inline constexpr double kAtEnd = 1e-4;

}  // namespace sightbound
