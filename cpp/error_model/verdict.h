// SPDX-License-Identifier: GPL-3.0-or-later
// What is claimed of a sight line, as a number: the larger the better seen.
#pragma once

#include <cstdint>

namespace sightbound {

inline constexpr std::uint8_t kHidden = 0, kUncertain = 1, kVisible = 2, kNoVerdict = 255;

}  // namespace sightbound
