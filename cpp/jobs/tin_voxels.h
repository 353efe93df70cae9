// SPDX-License-Identifier: GPL-3.0-or-later
// How large the voxels are in which a TIN is simplified.
#pragma once

#include <cstddef>
#include <string>

#include "base/memory_budget.h"
#include "jobs/tin_tolerance.h"
#include "volume/error_volume.h"
#include "volume/voxel_size.h"

namespace sightbound {

// metres: a part of what just fits into the tolerance at 99 of 100 vertices that have any.
double voxel_for(const TinTolerance&);

// That voxel, or the smallest for which memory and time last: `beside` bytes are taken already.
double affordable_voxel(const Surface&, double wanted_m, VolumeOptions, const MemoryBudget&,
                        std::size_t beside);

// Tells that voxels leave little of the tolerance at some faces; `chosen`: not by the user.
std::string too_coarse(const HeldFaces&, double voxel_m, double wanted_m, bool chosen);

}  // namespace sightbound
