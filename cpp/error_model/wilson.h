// SPDX-License-Identifier: GPL-3.0-or-later
// What counting says of a probability.
#pragma once

#include <cmath>

#include "error_model/error_model.h"

namespace sightbound {

struct Interval {
  double low = 0, high = 1;
};

// For a probability of which `share` was found in n trials: Wilson's (1927) interval at 95 %.
inline Interval wilson(double share, double n) {
  const double z2 = kZ95 * kZ95, middle = share + z2 / (2 * n);
  const double half = kZ95 * std::sqrt((share * (1 - share) + z2 / (4 * n)) / n), all = 1 + z2 / n;
  return {(middle - half) / all, (middle + half) / all};
}

}  // namespace sightbound
