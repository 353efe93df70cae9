// SPDX-License-Identifier: GPL-3.0-or-later
// Student's t with 5 degrees of freedom in elementary terms. With sin(a) = sqrt(5 / (5 + t^2)), 0 < a <=
// pi/2,
//
//   P(T > t) = (8 / 3 pi) Int_0^a sin^4 = (a - sin a cos a (1 + 2/3 sin^2 a)) / pi            t >= 0
//            = (8 / 3 pi) Sum_n C(2n, n) / 4^n  s^(2n + 5) / (2n + 5),   s = sin a
//
// The series serves far out, where the closed form would be the small difference of two large terms.
// Reference: Abramowitz and Stegun (1964), 26.7.3, for the closed form.
#include "error_model/tails.h"

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "error_model/error_model.h"

namespace sightbound {

namespace {

constexpr double kNu = 5;
const double kStudentSd = std::sqrt(kNu / (kNu - 2));

double student_series(double sine) {
  const double s2 = sine * sine;
  double power = s2 * s2 * sine, sum = 0;  // C(2n, n) / 4^n s^(2n + 5)
  for (int n = 0;; ++n) {
    const double term = power / (2 * n + 5);
    if (sum + term == sum) return 8 / (3 * std::numbers::pi) * sum;
    sum += term;
    power *= s2 * (2 * n + 1) / (2 * n + 2);
  }
}

// P(X > k), k >= 0, of Student's t divided by its sd.
double student_tail(double k) {
  constexpr double kSeriesBelow = 0.5;  // sin a; the closed form has lost at most 5 bits there
  const double t = k * kStudentSd, far = std::hypot(std::sqrt(kNu), t);
  const double sine = std::sqrt(kNu) / far, cosine = t / far;
  if (sine < kSeriesBelow) return student_series(sine);
  return (std::atan2(sine, cosine) - sine * cosine * (1 + 2.0 / 3 * sine * sine)) / std::numbers::pi;
}

double student_density(double k) {
  const double t = k * kStudentSd, u = 1 + t * t / kNu;
  return 8 * kStudentSd / (3 * std::numbers::pi * std::sqrt(kNu) * u * u * u);
}

// Newton on P(X > k)^(-1/nu), which is nearly straight: it grows as k itself far out.
double student_upper_quantile(double tail) {
  constexpr int kMostSteps = 50;  // five to eight are needed
  constexpr double kSmallStep = 4e-16;
  double k = 0;
  for (int i = 0; i < kMostSteps; ++i) {
    const double here = student_tail(k);
    const double step = kNu * here / student_density(k) * (std::pow(here / tail, 1 / kNu) - 1);
    k += step;
    if (std::abs(step) <= kSmallStep * k) break;
  }
  return k;
}

}  // namespace

std::string name_of(Tails tails) {
  switch (tails) {
    case Tails::kNormal:
      return "normal";
    case Tails::kLaplace:
      return "laplace";
    case Tails::kStudent:
      return "student";
  }
  throw BrokenGuarantee("unknown Tails");
}

Tails tails_from(const std::string& name) {
  for (const auto tails : {Tails::kNormal, Tails::kLaplace, Tails::kStudent}) {
    if (name == name_of(tails)) return tails;
  }
  throw InvalidInput("tails is '" + name + "'; allowed are 'normal', 'laplace' and 'student'.");
}

double cdf(double k, Tails tails) {
  if (tails == Tails::kNormal) return normal_cdf(k);
  const double tail = tails == Tails::kLaplace ? 0.5 * std::exp(-std::numbers::sqrt2 * std::abs(k))
                                               : student_tail(std::abs(k));
  return k < 0 ? tail : 1 - tail;
}

double two_sided_quantile(double confidence, Tails tails) {
  const double normal = two_sided_quantile(confidence);  // throws outside (0, 1)
  if (tails == Tails::kNormal) return normal;
  if (tails == Tails::kLaplace) return -std::log1p(-confidence) / std::numbers::sqrt2;
  return student_upper_quantile(0.5 * (1 - confidence));
}

double one_sided_quantile(double p, Tails tails) {
  if (p == 0.5) return 0;
  return p > 0.5 ? two_sided_quantile(2 * p - 1, tails) : -two_sided_quantile(1 - 2 * p, tails);
}

double certain_ratio(Tails tails) {
  constexpr double kNormalRatio = 3.29;
  if (tails == Tails::kNormal) return kNormalRatio;
  return one_sided_quantile(normal_cdf(kNormalRatio), tails);
}

}  // namespace sightbound
