// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/plan_index.h"

#include <cmath>

namespace sightbound {

PlanIndex::PlanIndex(const Tin& tin) {
  const Box3 box = bounds_of(tin);
  low_ = box.low;
  constexpr double kMostAcross = 4096;
  const double across = std::clamp(std::sqrt(static_cast<double>(tin.faces.size())), 1.0, kMostAcross);
  size_ = std::max({box.high.x - low_.x, box.high.y - low_.y, 1e-9}) / across;
  side_ = static_cast<std::size_t>(across) + 1;
  begin_.assign(side_ * side_ + 1, 0);
  const auto for_bins = [&](const Face& face, const auto& f) {
    const Xyz &a = tin.vertices[static_cast<std::size_t>(face[0])],
              &b = tin.vertices[static_cast<std::size_t>(face[1])],
              &c = tin.vertices[static_cast<std::size_t>(face[2])];
    for (std::size_t y = bin(std::min({a.y, b.y, c.y}) - low_.y);
         y <= bin(std::max({a.y, b.y, c.y}) - low_.y); ++y) {
      for (std::size_t x = bin(std::min({a.x, b.x, c.x}) - low_.x);
           x <= bin(std::max({a.x, b.x, c.x}) - low_.x); ++x)
        f(y * side_ + x);
    }
  };
  for (const Face& face : tin.faces) for_bins(face, [&](std::size_t n) { ++begin_[n + 1]; });
  for (std::size_t n = 1; n < begin_.size(); ++n) begin_[n] += begin_[n - 1];
  faces_.resize(begin_.back());
  std::vector<std::size_t> end(begin_.begin(), begin_.end() - 1);
  for (std::size_t f = 0; f < tin.faces.size(); ++f)
    for_bins(tin.faces[f], [&](std::size_t n) { faces_[end[n]++] = static_cast<std::int32_t>(f); });
}

}  // namespace sightbound
