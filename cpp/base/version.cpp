// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/version.h"

namespace sightbound {

std::string version() { return SIGHTBOUND_VERSION; }

}  // namespace sightbound
