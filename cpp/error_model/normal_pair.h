// SPDX-License-Identifier: GPL-3.0-or-later
// Two normal variables that know of each other.
#pragma once

namespace sightbound {

// Probability that X < h while Y >= k: X, Y standard normal with the correlation rho in [-0.95, 1]. h and k may
// be infinite. Within 1e-9 absolutely, and within 1e-5 of itself where |h|, |k| < 8.
double below_while_above(double h, double k, double rho);

}  // namespace sightbound
