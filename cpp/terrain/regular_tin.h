// SPDX-License-Identifier: GPL-3.0-or-later
// All of a DEM as a TIN: the same surface that the sweep engine sees (dem.h).
#pragma once

#include <cstdint>
#include <vector>

#include "base/memory_budget.h"
#include "base/progress.h"
#include "terrain/dem.h"
#include "terrain/tin.h"

namespace sightbound {

struct RegularTin {
  Tin tin;
  // The sample of each vertex as row * cols + col, in the core's row order; empty when every sample is a
  // vertex, which then are in that very order.
  std::vector<std::int32_t> samples;
};

// Two faces for each square of samples, split along the NW-SE diagonal; those with a nodata corner are left
// out, and samples of no face too. `metres_per_unit` of the CRS in plan. Always a height field. 72 bytes a
// sample. Throws InvalidInput when no face is left, OverBudget, Cancelled; advances `progress` by 1 a row.
RegularTin regular_tin(const DemSource&, double metres_per_unit, const MemoryBudget&, Progress&);

}  // namespace sightbound
