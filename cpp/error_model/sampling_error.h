// SPDX-License-Identifier: GPL-3.0-or-later
// Sampling error at the samples (Koppe; paper section 3.1).
#pragma once

#include <span>

#include "base/parallel.h"
#include "base/progress.h"
#include "error_model/error_field.h"
#include "error_model/surroundings.h"

namespace sightbound {

// sigma_s = sigma_v + sigma_h tan(slope), metres; slope of the steepest whole triangle around the sample (0
// where there is none), with the ground cell size of the sample's own row. Constant when sigma_v is and
// sigma_h = 0; otherwise computed in sigma_v's own grid, where it has one. Depends on the 3 x 3 samples
// around alone. Only checks `progress`.
SampleField sampling_error(SampleField sigma_v, double sigma_h, const Surroundings& heights,
                           std::span<const CellSize> cell_sizes, const Workers&, Progress&);

}  // namespace sightbound
