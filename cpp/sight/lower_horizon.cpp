// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/lower_horizon.h"

#include <algorithm>
#include <cmath>

namespace sightbound {

namespace {
constexpr int kLeastWedges = kVector;  // per block
// Steps from the observer where it begins: nearer, a column's slope says nothing.
constexpr double kFirstBelow = 0.5;
}  // namespace

float pad_of_heights(const Eye& eye) {
  return static_cast<float>(1e-3 + 5e-7 * std::max(std::abs(eye.height), 1e4));
}

LowerHorizon::LowerHorizon(const FanColumns& columns, float eye)
    : columns_(columns),
      eye_(eye),
      wedges_(kLeastWedges),
      below_(static_cast<std::size_t>(wedges_), -kUnbounded) {}

void LowerHorizon::split() {
  wedges_ *= 2;
  below_.resize(static_cast<std::size_t>(wedges_));
  for (std::size_t i = below_.size(); i-- > 0;) below_[i] = below_[i / 2];
}

void LowerHorizon::raise(const ColumnPlace& here, int first, int rows, const float* line) {
  if (here.step < kFirstBelow) return;
  WedgeStep step;
  step.wedges = wedges_;
  step.far = columns_.edges(here, first, wedges_);
  step.pad = columns_.pad(here);
  step.rows = rows;
  step.window = window_for(columns_.width(here, wedges_) + 2 * static_cast<double>(step.pad));
  widened_.resize(static_cast<std::size_t>(rows + step.window + 2 * kVector));
  std::copy_n(line, rows, widened_.begin());
  widen_lowest(rows, step.window, widened_.data());
  step.drop_high = columns_.most_drop(here, wedges_);
  step.eye_below = eye_;
  step.far_most = columns_.smallest_inverse(here);
  step.far_least = columns_.largest_inverse(here);
  raise_below(step, line, widened_.data(), below_.data());
}

// Judged as judge_targets() does.
bool LowerHorizon::hides(std::span<const ColumnPlace> nearest_first, double top) const {
  float drop = kUnbounded;
  for (const ColumnPlace& p : nearest_first) drop = std::min(drop, columns_.least_drop_of_all(p, wedges_));
  const double over = top - drop - eye_;
  const double slope = over * (over > 0 ? columns_.largest_inverse(nearest_first.front())
                                        : columns_.smallest_inverse(nearest_first.back()));
  const double horizon = *std::min_element(below_.begin(), below_.end());
  return horizon > slope + 2e-6 * (std::abs(slope) + std::abs(horizon));
}

}  // namespace sightbound
