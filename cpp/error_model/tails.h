// SPDX-License-Identifier: GPL-3.0-or-later
// How an error of standard deviation 1 is distributed: the F and z of every claim at a confidence.
//
//               F                                          z(0.90)  z(0.95)  z(0.99)  F(z) = 0.9995
//   normal                                                  1.645    1.960    2.576    3.291
//   laplace   1 - exp(-sqrt2 k) / 2                         1.628    2.118    3.256    4.885
//   student   nu = 5, divided by its sd sqrt(5 / 3)         1.561    1.991    3.123    5.321
//
// Terrain between its samples has heavier tails than the normal distribution: 99 % of it lies within about
// 3.1 sd (docs/concepts/error_model.md). All are symmetric.
#pragma once

#include <string>

namespace sightbound {

enum class Tails { kNormal, kLaplace, kStudent };
std::string name_of(Tails tails);           // "normal", "laplace", "student"
Tails tails_from(const std::string& name);  // throws InvalidInput

// F(k): the probability that the error is below k. Relative accuracy 1e-13 also far out below 0.
double cdf(double k, Tails tails);
// z(c): within +-z lies a share c. Throws InvalidInput outside (0, 1). Accuracy 1e-13, also for c close to 1.
double two_sided_quantile(double confidence, Tails tails);
// The k with F(k) = p, p in (0, 1).
double one_sided_quantile(double p, Tails tails);
// Beyond this |k*| a probability is 0 or 1: F = 0.9995, 3.29 for normal tails.
double certain_ratio(Tails tails);

}  // namespace sightbound
