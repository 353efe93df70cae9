// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers in messages.
#pragma once

#include <array>
#include <cstdio>
#include <string>

namespace sightbound {

// "0.1", "12345.678", "1e+20": at most so many digits, none that say nothing.
inline std::string number_text(double value, int digits = 10) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  return text.data();
}

}  // namespace sightbound
