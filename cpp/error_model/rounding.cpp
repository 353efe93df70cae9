// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_model/rounding.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightbound {

namespace {

constexpr int kRowStride = 8;
constexpr double kFoot = 0.3048, kUsSurveyFoot = 1200.0 / 3937.0;
// Steps in use, largest first: the first that fits is the answer, its own fractions fit as well.
constexpr double kSteps[] = {1,   0.5,  kUsSurveyFoot,       kFoot,       0.25, 0.2, kFoot / 2,
                             0.1, 0.05, 0.1 * kUsSurveyFoot, 0.1 * kFoot, 0.02, 0.01};
// A multiple of the step, scaled and stored as float: half a unit in the last place each for the scale, the
// product and the file's own decimal; and half a unit to spare.
constexpr double kTolerance = 2 * std::numeric_limits<float>::epsilon();
constexpr double kClearlySmaller = 0.125;  // tolerance over step, above which a fit says nothing
constexpr double kBentShare =
    0.05;  // measured ground rounded to a step bends at almost every change of height
constexpr std::size_t kFewest = 64;  // triples not all equal

}  // namespace

void RoundingDetector::add(const Grid<float>& block) {
  for (int r = 0; r < block.rows(); r += kRowStride) {
    const float* z = block.row(r);
    for (int c = 0; c < block.cols(); ++c) {
      if (!std::isfinite(z[c])) continue;
      heights_.push_back(z[c]);
      largest_height_ = std::max(largest_height_, std::abs(static_cast<double>(z[c])));
      if (c == 0 || !std::isfinite(z[c - 1])) continue;
      const double difference = std::abs(static_cast<double>(z[c]) - z[c - 1]);
      if (difference > 0 && (least_difference_ == 0 || difference < least_difference_))
        least_difference_ = difference;
      if (c == 1 || !std::isfinite(z[c - 2])) continue;
      const double before = static_cast<double>(z[c - 1]) - z[c - 2];
      const double after = static_cast<double>(z[c]) - z[c - 1];
      if (before == 0 && after == 0) continue;
      ++uneven_;
      if (std::abs(after - before) > 4 * kTolerance * std::abs(static_cast<double>(z[c]))) ++bent_;
    }
  }
}

bool RoundingDetector::fits(double step) const {
  if (kTolerance * largest_height_ > kClearlySmaller * step) return false;
  if (std::abs(least_difference_ - step) > 2 * kClearlySmaller * step) return false;
  return std::all_of(heights_.begin(), heights_.end(), [step](float z) {
    return std::abs(z - step * std::nearbyint(z / step)) <= kTolerance * std::abs(static_cast<double>(z));
  });
}

double RoundingDetector::step_m() const {
  if (uneven_ < kFewest || static_cast<double>(bent_) < kBentShare * static_cast<double>(uneven_)) return 0;
  for (const double step : kSteps) {
    if (fits(step)) return step;
  }
  return 0;
}

double RoundingDetector::sd_m() const { return step_m() / std::sqrt(12.0); }

}  // namespace sightbound
