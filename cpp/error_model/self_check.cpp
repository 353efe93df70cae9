// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_model/self_check.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "error_model/local_variation.h"

namespace sightbound {

namespace {

constexpr double kBin = 0.01, kLargest = 50;  // of errors over sd
constexpr double kCore = 0.683, kFar = 0.99, kClaimed = 0.95;
constexpr double kLeastScale = 0.6, kLargestScale = 1.7;

Grid<float> every_other(const Grid<float>& block) {
  Grid<float> out((block.rows() + 1) / 2, (block.cols() + 1) / 2);
  for (int r = 0; r < out.rows(); ++r) {
    for (int c = 0; c < out.cols(); ++c) out.at(r, c) = block.at(2 * r, 2 * c);
  }
  return out;
}

double far_over_core(Tails tails) {
  return two_sided_quantile(kFar, tails) / two_sided_quantile(kCore, tails);
}

}  // namespace

void SelfCheck::add(const Grid<float>& block, Progress& progress) {
  const Grid<float> kept = every_other(block);
  const ResidualScale scale = residual_scale(exponent_, CellContent::kSamples);
  const Grid<float> sd = local_variation(Surroundings(kept), scale, typical_m_, Workers(1), progress);
  for (int r = 0; r < kept.rows(); ++r) {
    for (int c = 0; c < kept.cols(); ++c) {
      const double z = kept.at(r, c);
      if (c + 1 < kept.cols())
        count(block.at(2 * r, 2 * c + 1) - 0.5 * (z + kept.at(r, c + 1)),
              0.5 * (sd.at(r, c) + sd.at(r, c + 1)));
      if (r + 1 < kept.rows())
        count(block.at(2 * r + 1, 2 * c) - 0.5 * (z + kept.at(r + 1, c)),
              0.5 * (sd.at(r, c) + sd.at(r + 1, c)));
    }
  }
}

void SelfCheck::count(double error, double sd) {
  if (std::isnan(error) || sd <= 0) return;  // sd is 0 on planes
  const double ratio = std::min(std::abs(error) / sd, kLargest);
  if (histogram_.empty()) histogram_.resize(static_cast<std::size_t>(kLargest / kBin) + 1);
  ++histogram_[static_cast<std::size_t>(ratio / kBin)];
  ++places_;
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
