// SPDX-License-Identifier: GPL-3.0-or-later
// The normal distribution, and accuracies brought to one standard deviation with it.
//
// Quantile: Wichura (1988), Algorithm AS 241, routine PPND16, Applied Statistics 37, 477-484. Its tail branch
// is entered with the tail's own probability, so that confidences near 1 lose nothing to cancellation.
#include <cmath>
#include <string>

#include "base/error.h"
#include "error_model/error_model.h"

namespace sightbound {

namespace {

double polynomial(const double (&a)[8], double x) {
  double sum = a[7];
  for (int i = 6; i >= 0; --i) sum = sum * x + a[i];
  return sum;
}

// The k with P(N > k) = tail, tail in (0, 0.5].
double upper_quantile(double tail) {
  static constexpr double kA[] = {
      3.3871328727963666080e0,  1.3314166789178437745e+2, 1.9715909503065514427e+3, 1.3731693765509461125e+4,
      4.5921953931549871457e+4, 6.7265770927008700853e+4, 3.3430575583588128105e+4, 2.5090809287301226727e+3};
  static constexpr double kB[] = {1.0,
                                  4.2313330701600911252e+1,
                                  6.8718700749205790830e+2,
                                  5.3941960214247511077e+3,
                                  2.1213794301586595867e+4,
                                  3.9307895800092710610e+4,
                                  2.8729085735721942674e+4,
                                  5.2264952788528545610e+3};
  static constexpr double kC[] = {1.42343711074968357734e0,  4.63033784615654529590e0,
                                  5.76949722146069140550e0,  3.64784832476320460504e0,
                                  1.27045825245236838258e0,  2.41780725177450611770e-1,
                                  2.27238449892691845833e-2, 7.74545014278341407640e-4};
  static constexpr double kD[] = {1.0,
                                  2.05319162663775882187e0,
                                  1.67638483018380384940e0,
                                  6.89767334985100004550e-1,
                                  1.48103976427480074590e-1,
                                  1.51986665636164571966e-2,
                                  5.47593808499534494600e-4,
                                  1.05075007164441684324e-9};
  static constexpr double kE[] = {6.65790464350110377720e0,  5.46378491116411436990e0,
                                  1.78482653991729133580e0,  2.96560571828504891230e-1,
                                  2.65321895265761230930e-2, 1.24266094738807843860e-3,
                                  2.71155556874348757815e-5, 2.01033439929228813265e-7};
  static constexpr double kF[] = {1.0,
                                  5.99832206555887937690e-1,
                                  1.36929880922735805310e-1,
                                  1.48753612908506148525e-2,
                                  7.86869131145613259100e-4,
                                  1.84631831751005468180e-5,
                                  1.42151175831644588870e-7,
                                  2.04426310338993978564e-15};
  const double q = 0.5 - tail;
  if (q <= 0.425) {
    const double r = 0.180625 - q * q;
    return q * polynomial(kA, r) / polynomial(kB, r);
  }
  const double r = std::sqrt(-std::log(tail));
  return r <= 5 ? polynomial(kC, r - 1.6) / polynomial(kD, r - 1.6)
                : polynomial(kE, r - 5) / polynomial(kF, r - 5);
}

}  // namespace

double two_sided_quantile(double confidence) {
  if (!(confidence > 0 && confidence < 1)) {
    throw InvalidInput("confidence is " + std::to_string(confidence) +
                       "; allowed are values between 0 and 1 (usual: 0.95).");
  }
  return upper_quantile(0.5 * (1 - confidence));
}

double normal_cdf(double k) { return 0.5 * std::erfc(-k / std::sqrt(2.0)); }

double vertical_sigma(double value_m, VerticalMeasure measure) {
  switch (measure) {
    case VerticalMeasure::kRmse:
      return value_m;
    case VerticalMeasure::kLe90:
      return value_m / two_sided_quantile(0.90);
    case VerticalMeasure::kLe95:
      return value_m / kZ95;
  }
  throw BrokenGuarantee("unknown VerticalMeasure");
}

double horizontal_sigma(double value_m, HorizontalMeasure measure) {
  // Rayleigh: a share c lies within sigma sqrt(-2 ln(1 - c)).
  switch (measure) {
    case HorizontalMeasure::kRmse:
      return value_m;
    case HorizontalMeasure::kCe90:
      return value_m / std::sqrt(-2 * std::log(0.10));
    case HorizontalMeasure::kCe95:
      return value_m / std::sqrt(-2 * std::log(0.05));
  }
  throw BrokenGuarantee("unknown HorizontalMeasure");
}

}  // namespace sightbound
