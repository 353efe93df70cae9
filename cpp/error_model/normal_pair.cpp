// SPDX-License-Identifier: GPL-3.0-or-later
// Plackett (1954): dP(X < h, Y < k) / drho is the density at (h, k). At rho = 1 the probability is that of
// the lesser of the two, so
//
//     P(X < h, Y >= k) = max(0, Phi(h) - Phi(k)) + I
//     I = integral over [rho, 1] of the density
//       = 1 / (2 pi) * integral over phi in [0, acos rho] of exp(-q(phi)),  rho = cos phi
//     q = ((h - k)^2 + 4 h k sin^2(phi / 2)) / (2 sin^2 phi)
//
// Nothing cancels: I is small where the answer is. The integrand rises within phi ~ |h - k| and is smooth
// beyond, so pieces that double in length are integrated by Gauss-Legendre.
#include "error_model/normal_pair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "error_model/error_model.h"

namespace sightbound {

namespace {

struct Node {
  double x, weight;
};
// Of ten points on [-1, 1]; the other half mirrors these.
constexpr std::array<Node, 5> kNodes{{{0.14887433898163122, 0.29552422471475287},
                                      {0.43339539412924719, 0.26926671930999636},
                                      {0.67940956829902441, 0.21908636251598204},
                                      {0.86506336668898451, 0.14945134915058059},
                                      {0.97390652851717172, 0.06667134430868814}}};

double density_integral(double h, double k, double from, double to) {
  const auto integrand = [&](double phi) {
    const double half = std::sin(0.5 * phi), whole = std::sin(phi);
    return std::exp(-((h - k) * (h - k) + 4 * h * k * half * half) / (2 * whole * whole));
  };
  const double middle = 0.5 * (from + to), reach = 0.5 * (to - from);
  double sum = 0;
  for (const Node& node : kNodes)
    sum += node.weight * (integrand(middle - reach * node.x) + integrand(middle + reach * node.x));
  return sum * reach;
}

}  // namespace

double below_while_above(double h, double k, double rho) {
  if (std::isinf(h)) return h < 0 ? 0 : normal_cdf(-k);
  if (std::isinf(k)) return k > 0 ? 0 : normal_cdf(h);
  const double end = std::acos(std::clamp(rho, -1.0, 1.0));
  constexpr double kFirst = 0.125;  // of |h - k|: exp(-32) there
  double from = 0, to = std::max(kFirst * std::abs(h - k), 1e-3 * end), sum = 0;
  while (from < end) {
    to = std::min(to, end);
    sum += density_integral(h, k, from, to);
    from = to;
    to *= 2;
  }
  return std::max(0.0, normal_cdf(h) - normal_cdf(k)) + sum / (2 * std::numbers::pi);
}

}  // namespace sightbound
