// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_model/self_check.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "error_model/local_variation.h"

namespace sightbound {

namespace {

constexpr double kBin = 0.01, kLargest = 50;  // of errors over sd
constexpr std::size_t kBins = static_cast<std::size_t>(kLargest / kBin) + 1;
// Classes of equal parts of h = g^2 / (1 + g^2), on which variance depends linearly.
constexpr std::size_t kSteps = 16;
constexpr double kOutlier = 5;  // sds: no single error counts for more
constexpr double kLeastVariance = 0.1, kLargestVariance = 3;
constexpr double kUsual = 0.75;  // nearer to 1 makes no difference: self-affine ground has 0.85 to 1.05
constexpr double kCore = 0.683, kFar = 0.99, kClaimed = 0.95;
constexpr double kLeastScale = 0.6, kLargestScale = 1.7;

Grid<float> every_other(const Grid<float>& block) {
  Grid<float> out((block.rows() + 1) / 2, (block.cols() + 1) / 2);
  for (int r = 0; r < out.rows(); ++r) {
    for (int c = 0; c < out.cols(); ++c) out.at(r, c) = block.at(2 * r, 2 * c);
  }
  return out;
}

double middle_of_class(std::size_t step) { return (static_cast<double>(step) + 0.5) / kSteps; }

double variance_of_class(const StepVariance& steps, std::size_t step) {
  const double h = middle_of_class(step);
  return steps.level * (1 - h) + steps.step * h;
}

// By least squares over all errors, in units of their mean square.
StepVariance fitted_steps(const std::vector<std::size_t>& by_step) {
  double n = 0, sum = 0;
  double ll = 0, ls = 0, ss = 0, lv = 0, sv = 0;  // normal equations
  for (std::size_t k = 0; k < kSteps; ++k) {
    const double h = middle_of_class(k), l = 1 - h;
    for (std::size_t i = 0; i < kBins; ++i) {
      const auto count = static_cast<double>(by_step[k * kBins + i]);
      const double ratio = std::min(kBin * (static_cast<double>(i) + 0.5), kOutlier), square = ratio * ratio;
      n += count;
      sum += count * square;
      ll += count * l * l;
      ls += count * l * h;
      ss += count * h * h;
      lv += count * l * square;
      sv += count * h * square;
    }
  }
  const double determinant = ll * ss - ls * ls, mean = n > 0 ? sum / n : 0;
  if (!(determinant > 1e-6 * n * n) || mean <= 0) return {};
  const auto within = [&](double variance) {
    return std::clamp(variance / mean, kLeastVariance, kLargestVariance);
  };
  const StepVariance found{within((lv * ss - sv * ls) / determinant),
                           within((sv * ll - lv * ls) / determinant)};
  const auto is_usual = [](double variance) { return variance > kUsual && variance < 1 / kUsual; };
  return is_usual(found.level) && is_usual(found.step) ? StepVariance{} : found;
}

double far_over_core(Tails tails) {
  return two_sided_quantile(kFar, tails) / two_sided_quantile(kCore, tails);
}

}  // namespace

SelfCheck::SelfCheck(double exponent, double typical_m)
    : exponent_(exponent), typical_m_(typical_m), by_step_(kSteps * kBins), histogram_(kBins) {}

void SelfCheck::add(const Grid<float>& block, Progress& progress) {
  const Grid<float> kept = every_other(block);
  const ResidualScale scale = residual_scale(exponent_, CellContent::kSamples);
  const Grid<float> sd = local_variation(Surroundings(kept), scale, typical_m_, Workers(1), progress);
  for (int r = 0; r < kept.rows(); ++r) {
    for (int c = 0; c < kept.cols(); ++c) {
      const double z = kept.at(r, c);
      if (c + 1 < kept.cols())
        count(block.at(2 * r, 2 * c + 1) - 0.5 * (z + kept.at(r, c + 1)), 0.5 * (z - kept.at(r, c + 1)),
              0.5 * (sd.at(r, c) + sd.at(r, c + 1)));
      if (r + 1 < kept.rows())
        count(block.at(2 * r + 1, 2 * c) - 0.5 * (z + kept.at(r + 1, c)), 0.5 * (z - kept.at(r + 1, c)),
              0.5 * (sd.at(r, c) + sd.at(r + 1, c)));
    }
  }
}

void SelfCheck::count(double error, double half_step, double sd) {
  if (std::isnan(error) || sd <= 0) return;  // sd is 0 on planes
  const double ratio = std::min(std::abs(error) / sd, kLargest), g2 = half_step * half_step / (sd * sd);
  const auto step = std::min(static_cast<std::size_t>(kSteps * g2 / (1 + g2)), kSteps - 1);
  by_step_[step * kBins + static_cast<std::size_t>(ratio / kBin)] += 1;
  ++places_;
}

void SelfCheck::finish() {
  steps_ = fitted_steps(by_step_);
  for (std::size_t k = 0; k < kSteps; ++k) {
    const double scale = 1 / std::sqrt(variance_of_class(steps_, k));
    for (std::size_t i = 0; i < kBins; ++i) {
      const double ratio = std::min(scale * kBin * (static_cast<double>(i) + 0.5), kLargest);
      histogram_[static_cast<std::size_t>(ratio / kBin)] += by_step_[k * kBins + i];
    }
  }
}

double SelfCheck::quantile(double share) const {
  const double wanted = share * static_cast<double>(places_);
  double below = 0;
  for (std::size_t i = 0; i < histogram_.size(); ++i) {
    const auto here = static_cast<double>(histogram_[i]);
    if (here > 0 && below + here >= wanted) return kBin * (static_cast<double>(i) + (wanted - below) / here);
    below += here;
  }
  return 0;
}

Tails SelfCheck::tails() const {
  const double core = quantile(kCore);
  if (core <= 0) return Tails::kNormal;
  const double found = quantile(kFar) / core;
  Tails best = Tails::kNormal;
  for (const Tails tails : {Tails::kStudent, Tails::kLaplace}) {
    if (std::abs(far_over_core(tails) - found) < std::abs(far_over_core(best) - found)) best = tails;
  }
  return best;
}

double SelfCheck::scale() const {
  const double found = quantile(kClaimed) / two_sided_quantile(kClaimed, tails());
  return std::clamp(std::sqrt(found), kLeastScale, kLargestScale);
}

}  // namespace sightbound
