// SPDX-License-Identifier: GPL-3.0-or-later
// An upper bound of the probability that a line is blocked, without drawing: Rice's (1944) idea that a line
// which is blocked anywhere is blocked at its start or goes from clear to blocked somewhere,
//
//     P(blocked) <= P(blocked at the start) + sum over steps of P(clear before, blocked after)
//
// the expected number of such goings, for places instead of a continuum; steps may branch (Hunter 1976).
// Exact normal probabilities of the very terrains that are drawn (docs/algorithms/lines.md has the proof), so
// it says something of lines that are blocked once in a million, where counting says nothing. Cost: some
// microseconds a cell of the line where it is close to the ground.
#pragma once

#include "sight/probable_line.h"

namespace sightbound {

// At most 1. NaN where draws are not normal: of sums of others no such probabilities are known.
double blocked_bound(const LineInDoubt&);

}  // namespace sightbound
