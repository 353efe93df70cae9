// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace sightbound {

// Of Sightbound, e.g. "0.1.0": CMakeLists.txt is where it is set.
std::string version();

}  // namespace sightbound
