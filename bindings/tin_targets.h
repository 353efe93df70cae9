// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "jobs/tin_target.h"

namespace sightbound::python {

// 0 faces and 0 bytes: no target.
template <class Job>
void set_target(Job& job, std::int64_t faces, double bytes, const std::string& ending) {
  job.target = {faces, bytes, ending};
}

}  // namespace sightbound::python
