// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "error_model/error_model.h"
#include "sight/draws.h"

namespace sightbound {
namespace {

TEST(Draws, TheLogarithmIsOne) {
  for (float x = 1e-30f; x <= 1; x *= 1.01f)
    EXPECT_NEAR(minus_log(x), -std::log(x), 2e-7 * (1 - std::log(x)));
  EXPECT_EQ(minus_log(1), 0);
}

TEST(Draws, TheExponentialIsOne) {
  for (float x = -80; x <= 80; x += 0.013f) EXPECT_NEAR(exponential(x) / std::exp(double(x)), 1, 3e-7) << x;
}

// n E^q: its mean square is 1, and of n^2 and E^2q the fourth moment is 3 Gamma(4q + 1) / Gamma(2q + 1)^2.
TEST(Draws, ScalesArePowersOfAnExponentialVariable) {
  constexpr int kDraws = 2000000;
  for (const double q : {0.0, 0.25, 0.5, 0.8, 1.1, 1.5}) {
    double squares = 0, logs = 0;
    for (std::uint32_t n = 0; n < kDraws; ++n) {
      const double s =
          power_scale(log_exponential_from(draw_bits(draw_key(4, 2, 1), n)), static_cast<float>(q));
      squares += s * s;
      logs += std::log(s);
    }
    const double spread = std::sqrt(std::tgamma(4 * q + 1) / std::pow(std::tgamma(2 * q + 1), 2) - 1);
    EXPECT_NEAR(squares / kDraws, 1, 5e-3 + 4 * spread / std::sqrt(kDraws)) << q;
    const double gamma = 0.57721566490153286;  // E ln E = -gamma
    EXPECT_NEAR(logs / kDraws, -q * gamma - 0.5 * std::lgamma(2 * q + 1), 5e-3) << q;
  }
}

// The largest distance from the normal distribution: 1.63 / sqrt(n) is passed once in a hundred times
// (Kolmogorov).
double off_normal(std::vector<double> draws) {
  std::sort(draws.begin(), draws.end());
  double off = 0;
  const auto n = static_cast<double>(draws.size());
  for (std::size_t i = 0; i < draws.size(); ++i) {
    const double p = normal_cdf(draws[i]), rank = static_cast<double>(i);
    off = std::max({off, p - rank / n, (rank + 1) / n - p});
  }
  return off;
}

TEST(Draws, AreNormalAlongPlacesAndAlongRealisations) {
  constexpr int kDraws = 100000;
  std::vector<double> places, realisations, differences;
  for (int n = 0; n < kDraws; ++n) {
    places.push_back(normal_from(draw_bits(draw_key(7, n / 300, n % 300), 5)));
    realisations.push_back(normal_from(draw_bits(draw_key(7, -3, 12), static_cast<std::uint32_t>(n))));
  }
  // Neighbours do not know of each other: their differences have twice the variance.
  for (std::size_t n = 0; n + 1 < places.size(); n += 2)
    differences.push_back((places[n + 1] - places[n]) / std::sqrt(2.0));
  const double most = 1.63 / std::sqrt(kDraws);
  EXPECT_LT(off_normal(places), most);
  EXPECT_LT(off_normal(realisations), most);
  EXPECT_LT(off_normal(differences), std::sqrt(2.0) * most);
}

TEST(Draws, ReachIntoTheTails) {
  EXPECT_NEAR(normal_from(0), -5.2, 0.1);
  EXPECT_NEAR(normal_from(0xFFFFFFFF), 5.2, 0.1);
  for (const double p : {0.001, 0.01, 0.3, 0.5, 0.9, 0.999}) {
    const auto bits = static_cast<std::uint32_t>(p * 4294967296.0);
    EXPECT_NEAR(normal_cdf(normal_from(bits)), p, 1e-6);
  }
}

}  // namespace
}  // namespace sightbound
