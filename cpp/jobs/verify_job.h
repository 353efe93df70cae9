// SPDX-License-Identifier: GPL-3.0-or-later
// A simplified TIN against the user's original, a TIN or a DEM (cpp/verify).
#pragma once

#include <cstddef>
#include <span>

#include "verify/verify.h"

#include "base/progress.h"
#include "terrain/dem.h"
#include "terrain/tin.h"

namespace sightbound {

struct VerifyJobOptions {
  double resolution_m = 0;        // of TINs that are no height fields; 0 = chosen
  int threads = 0;                // 0 = all cores
  std::size_t memory_budget = 0;  // bytes; 0 = three quarters of the machine's memory
};

// Tolerance and vertex_deviation of a DEM are rasters in the user's row order. Throw InvalidInput (two CRSs,
// and as verify() does), IoError, OverBudget, Cancelled.
VerifyReport run_verify(const DemSource& original, const Tin& simplified, const Tolerance&,
                        const VerifyJobOptions&, Progress&);
VerifyReport run_verify(const Tin& original, const Tin& simplified, const Tolerance&, const VerifyJobOptions&,
                        Progress&);

}  // namespace sightbound
