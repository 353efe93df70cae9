// SPDX-License-Identifier: GPL-3.0-or-later
// Mean, spread and histogram of the deviation at the original's vertices. Internal to verify.
#pragma once

#include <vector>

#include "verify/verify.h"

namespace sightbound {

// From report.vertex_deviation; counts `used` vertices without one as uncovered.
void summarise_vertices(VerifyReport& report, const std::vector<bool>& used);

}  // namespace sightbound
