// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_model/error_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sightbound {

double GrowthProfile::operator()(double d, double amplitude) const {
  switch (shape) {
    case GeologicShape::kGaussian: {
      const double x = range_m > 0 ? d / range_m : amplitude * kZ95 * d;  // f(Delta) = Delta^2
      return 1 - std::exp(-0.5 * x * x);                                  // equation 3.4
    }
    case GeologicShape::kStep:
      return d < range_m ? 0 : 1;
    case GeologicShape::kGrowth: {
      // Along a line held at both ends: f^2H + (1-f)^2H - ... falls back to f (1 - f) for H of 1 and more.
      const double t = d / half_spacing_m, h = std::min(exponent, 1.0);
      if (t < 1) return std::pow(t * (2 - t), h);
      // Beside the line, as far as the middle of a square of samples; beyond, samples are sparser.
      const double beside = std::min(t, std::numbers::sqrt2);
      return std::pow(beside, h / 2) * std::pow(t / beside, exponent);
    }
  }
  return 0;
}

}  // namespace sightbound
