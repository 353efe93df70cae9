// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_model/self_check.h"

#include <algorithm>
#include <array>
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
constexpr double kUsual = 0.75;     // nearer to 1 makes no difference: self-affine ground has 0.85 to 1.05
constexpr double kUsualTail = 0.2;  // self-affine ground has 0 to 0.1
constexpr double kFewest = 400;     // places of a class that a 95 % quantile is taken of: q within 0.15
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

double variance_of_class(const StepLaw& steps, std::size_t step) {
  const double h = middle_of_class(step);
  return steps.level.variance * (1 - h) + steps.step.variance * h;
}

// Two numbers, of level ground and of steps, between which another changes linearly from class to class: by
// least squares.
class LevelAndStep {
 public:
  void add(std::size_t step, double places, double value) {
    const double h = middle_of_class(step), l = 1 - h;
    places_ += places;
    sum_ += places * value;
    ll_ += places * l * l;
    ls_ += places * l * h;
    ss_ += places * h * h;
    lv_ += places * l * value;
    sv_ += places * h * value;
  }
  // Both classes of ground have been seen.
  bool is_found() const { return determinant() > 1e-6 * places_ * places_; }
  double mean() const { return places_ > 0 ? sum_ / places_ : 0; }
  double level() const { return (lv_ * ss_ - sv_ * ls_) / determinant(); }
  double step() const { return (sv_ * ll_ - lv_ * ls_) / determinant(); }

 private:
  double determinant() const { return ll_ * ss_ - ls_ * ls_; }

  double places_ = 0, sum_ = 0, ll_ = 0, ls_ = 0, ss_ = 0, lv_ = 0, sv_ = 0;
};

// Of a class; the places where a share of them ends.
struct ErrorsOfClass {
  const std::size_t* histogram;

  double places() const {
    double sum = 0;
    for (std::size_t i = 0; i < kBins; ++i) sum += static_cast<double>(histogram[i]);
    return sum;
  }
  double sum_of_squares() const {
    double sum = 0;
    for (std::size_t i = 0; i < kBins; ++i) {
      const double ratio = std::min(kBin * (static_cast<double>(i) + 0.5), kOutlier);
      sum += static_cast<double>(histogram[i]) * ratio * ratio;
    }
    return sum;
  }
  double quantile(double share) const {
    const double wanted = share * places();
    double below = 0;
    for (std::size_t i = 0; i < kBins; ++i) {
      const auto here = static_cast<double>(histogram[i]);
      if (here > 0 && below + here >= wanted)
        return kBin * (static_cast<double>(i) + (wanted - below) / here);
      below += here;
    }
    return 0;
  }
};

// In units of the errors' mean square.
void fit_variances(const LevelAndStep& squares, StepLaw& out) {
  if (!squares.is_found() || squares.mean() <= 0) return;
  const auto within = [&](double variance) {
    return std::clamp(variance / squares.mean(), kLeastVariance, kLargestVariance);
  };
  const double level = within(squares.level()), step = within(squares.step());
  const auto is_usual = [](double variance) { return variance > kUsual && variance < 1 / kUsual; };
  if (is_usual(level) && is_usual(step)) return;
  out.level.variance = level;
  out.step.variance = step;
}

// The q whose n E^q, n normal and E exponential, has this 95 % quantile over that of 68.3 %: by integration
// for q = 0, 1/4 ... 3/2, linear between.
double tail_with(double claimed_over_core) {
  constexpr std::array kRatios{1.959, 2.172, 2.608, 3.188, 3.926, 4.858, 6.029};
  static_assert(0.25 * (kRatios.size() - 1) == StepLaw::kLargestTail);
  std::size_t i = 1;
  while (i + 1 < kRatios.size() && claimed_over_core > kRatios[i]) ++i;
  const double part = (claimed_over_core - kRatios[i - 1]) / (kRatios[i] - kRatios[i - 1]);
  // Below 0 for classes that are lighter than normal by chance, or the mean of many would not be 0.
  return std::clamp(0.25 * (static_cast<double>(i - 1) + part), -StepLaw::kLargestTail,
                    StepLaw::kLargestTail);
}

void fit_tails(const LevelAndStep& tails, StepLaw& out) {
  if (!tails.is_found()) return;
  const auto within = [](double tail) { return std::clamp(tail, 0.0, StepLaw::kLargestTail); };
  const double level = within(tails.level()), step = within(tails.step());
  if (level < kUsualTail && step < kUsualTail) return;
  out.level.tail = level;
  out.step.tail = step;
}

StepLaw fitted_steps(const std::vector<std::size_t>& by_step) {
  LevelAndStep squares, tails;
  for (std::size_t k = 0; k < kSteps; ++k) {
    const ErrorsOfClass errors{&by_step[k * kBins]};
    const double places = errors.places(), core = errors.quantile(kCore);
    if (places > 0) squares.add(k, places, errors.sum_of_squares() / places);
    if (places >= kFewest && core > 0) tails.add(k, places, tail_with(errors.quantile(kClaimed) / core));
  }
  StepLaw out;
  fit_variances(squares, out);
  fit_tails(tails, out);
  return out;
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

double SelfCheck::quantile(double share) const { return ErrorsOfClass{histogram_.data()}.quantile(share); }

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
