// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/vdb.h"

#include <mutex>

namespace sightbound {

void initialize_vdb() {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
}

}  // namespace sightbound
