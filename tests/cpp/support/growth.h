// SPDX-License-Identifier: GPL-3.0-or-later
// The growth of the between-sample error by its definition (docs/concepts/error_model.md): no code of the product.
#pragma once

#include <algorithm>
#include <cmath>

namespace sightbound::testing {

// t: distance to the nearest sample over half a spacing.
inline double growth(double t, double exponent) {
  const double h = exponent < 1 ? exponent : 1, root2 = std::sqrt(2.0);
  if (t < 1) return std::pow(2 * t - t * t, h);
  if (t < root2) return std::pow(t, h / 2);
  return std::pow(2.0, h / 4) * std::pow(t / root2, exponent);
}

}  // namespace sightbound::testing
