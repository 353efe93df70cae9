// SPDX-License-Identifier: GPL-3.0-or-later
// What a measurement and its neighbours tell of the height, against the best linear guess of many made-up
// ones.
#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "error_model/posterior.h"
#include "support/rough_ground.h"

namespace sightbound {
namespace {

constexpr double kSigma = 0.8, kAmplitude = 0.6;
constexpr int kPlaces = 5;
constexpr std::array<std::array<int, 2>, kPlaces> kAt = {{{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}}};

// Errors of the sample and its neighbours, correlated by exp(-d / length) (Cholesky).
class Errors {
 public:
  explicit Errors(double length_cells) {
    for (int i = 0; i < kPlaces; ++i) {
      for (int j = 0; j <= i; ++j) {
        const double d = std::hypot(kAt[i][0] - kAt[j][0], kAt[i][1] - kAt[j][1]);
        double sum = length_cells > 0 ? std::exp(-d / length_cells) : (i == j ? 1 : 0);
        for (int k = 0; k < j; ++k) sum -= l_[i][k] * l_[j][k];
        l_[i][j] = i == j ? std::sqrt(sum) : sum / l_[j][j];
      }
    }
  }
  std::array<double, kPlaces> draw(std::mt19937& random) const {
    std::normal_distribution<double> normal;
    std::array<double, kPlaces> n{}, out{};
    for (double& x : n) x = normal(random);
    for (int i = 0; i < kPlaces; ++i) {
      for (int j = 0; j <= i; ++j) out[i] += kSigma * l_[i][j] * n[j];
    }
    return out;
  }

 private:
  double l_[kPlaces][kPlaces] = {};
};

class Posteriors : public ::testing::TestWithParam<double> {};

TEST_P(Posteriors, AreTheBestLinearGuess) {
  const double length_cells = GetParam();
  testing::RoughGround ground = testing::rough_ground(5, 5, static_cast<float>(kSigma), false);
  ground.error.amplitude = SampleField(static_cast<float>(kAmplitude));
  ground.error.profile = {GeologicShape::kGrowth, 0, 0.7, 5};
  ground.error.noise = CorrelatedNoise(10 * length_cells, {10, 10});
  const double p = kAmplitude * ground.error.profile(10, kAmplitude);
  Progress progress;
  const Posterior found = posterior(ground.heights, ground.error, Workers(1), progress);

  // Of ground that lies p off the mean of its neighbours: the error e against z - m.
  std::mt19937 random(3);
  std::normal_distribution<double> off(0, p);
  const Errors errors(length_cells);
  double xx = 0, xe = 0, ee = 0;
  constexpr int kTrials = 400000;
  for (int i = 0; i < kTrials; ++i) {
    const auto e = errors.draw(random);
    const double x = off(random) + e[0] - 0.25 * (e[1] + e[2] + e[3] + e[4]);
    xx += x * x;
    xe += x * e[0];
    ee += e[0] * e[0];
  }
  const double gain = xe / xx, left = std::sqrt((ee - xe * xe / xx) / kTrials);
  const Grid<float>& z = ground.heights;
  const double m = 0.25 * (z.at(1, 2) + z.at(3, 2) + z.at(2, 1) + z.at(2, 3));
  EXPECT_NEAR(found.mean.at(2, 2), z.at(2, 2) + gain * (m - z.at(2, 2)), 0.01 * std::abs(m - z.at(2, 2)));
  EXPECT_NEAR(length_cells > 0 ? found.shared.at(2, 2) : found.spread.at(2, 2), left, 0.005);
  EXPECT_EQ(found.has_shared(), length_cells > 0);
}

INSTANTIATE_TEST_SUITE_P(Lengths, Posteriors, ::testing::Values(0.0, 0.7, 3.0, 50.0));

}  // namespace
}  // namespace sightbound
