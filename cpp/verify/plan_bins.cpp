// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/plan_bins.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace sightbound {

namespace {

constexpr double kMostAcross = 30000;  // bins

PlanBox around(const std::vector<PlanFace>& faces) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  PlanBox all{{kFar, kFar}, {-kFar, -kFar}};
  for (const PlanFace& face : faces) {
    all.low = {std::min(all.low.x, face.box.low.x), std::min(all.low.y, face.box.low.y)};
    all.high = {std::max(all.high.x, face.box.high.x), std::max(all.high.y, face.box.high.y)};
  }
  return all;
}

}  // namespace

PlanBins::PlanBins(std::vector<PlanFace> faces, double rim) : faces_(std::move(faces)), rim_(rim) {
  const PlanBox all = around(faces_);
  const double wide = all.high.x - all.low.x, high = all.high.y - all.low.y;
  origin_ = all.low;
  side_ = std::max(std::sqrt(wide * high / static_cast<double>(faces_.size())),
                   std::max(wide, high) / kMostAcross);
  if (!(side_ > 0)) side_ = 1;
  cols_ = 1 + static_cast<int>(wide / side_);
  rows_ = 1 + static_cast<int>(high / side_);

  const auto each_bin = [&](const PlanFace& face, const auto& visit) {
    if (face.twice_area == 0) return;
    for (int j = row(face.box.low.y); j <= row(face.box.high.y); ++j) {
      for (int i = column(face.box.low.x); i <= column(face.box.high.x); ++i)
        visit(static_cast<std::size_t>(j) * static_cast<std::size_t>(cols_) + static_cast<std::size_t>(i));
    }
  };
  begins_.assign(static_cast<std::size_t>(cols_) * static_cast<std::size_t>(rows_) + 1, 0);
  for (const PlanFace& face : faces_) each_bin(face, [&](std::size_t bin) { ++begins_[bin + 1]; });
  std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
  numbers_.resize(begins_.back());
  std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
  for (std::size_t n = 0; n < faces_.size(); ++n)
    each_bin(faces_[n], [&](std::size_t bin) { numbers_[next[bin]++] = static_cast<std::uint32_t>(n); });
}

}  // namespace sightbound
