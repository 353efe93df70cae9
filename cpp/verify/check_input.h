// SPDX-License-Identifier: GPL-3.0-or-later
// What verify refuses. Internal to verify.
#pragma once

#include <string>
#include <vector>

#include "verify/verify.h"

namespace sightbound {

// Throw InvalidInput. `name` is that of the argument.
void check_tin(const Tin&, const std::string& name);
// `used`: vertices of faces, whose tolerance must be a number more than 0.
void check_tolerance(const Tolerance&, const std::vector<bool>& used);

}  // namespace sightbound
