// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_model/error_field.h"

#include <cmath>

namespace sightbound {

double GrowthProfile::operator()(double d, double amplitude) const {
  switch (shape) {
    case GeologicShape::kGaussian: {
      const double x = range_m > 0 ? d / range_m : amplitude * kZ95 * d;  // f(Delta) = Delta^2
      return 1 - std::exp(-0.5 * x * x);                                  // equation 3.4
    }
    case GeologicShape::kStep:
      return d < range_m ? 0 : 1;
    case GeologicShape::kGrowth:
      return std::pow(d / half_spacing_m, exponent);
  }
  return 0;
}

}  // namespace sightbound
