// SPDX-License-Identifier: GPL-3.0-or-later
// How far a simplified TIN may go: as tolerances in metres, and as the error whose volume they are.
#pragma once

#include <vector>

#include "jobs/simplify_tin_job.h"
#include "volume/tin_error.h"

namespace sightbound {

struct TinTolerance {
  std::vector<float> metres;  // at each vertex, linear on each face; rounded down
  TinError error;             // at `confidence` its volume is where the surface may be
  double confidence = 0;
  Tails tails = Tails::kNormal;
  double least = 0, largest = 0;  // metres, with what is between the samples
};

// Throws InvalidInput (a tolerance that is negative, no number or too large; what an error model lacks).
TinTolerance tolerance_of(const Tin&, const SimplifyTinJob&, Metric);

}  // namespace sightbound
