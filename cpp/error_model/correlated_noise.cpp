// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_model/correlated_noise.h"

#include <cmath>

namespace sightbound {

namespace {

// Nodes of the coarsest lattice are 2.4 lengths apart.
constexpr double kCoarsest = 2.4, kFiner = 3;
constexpr double kShares[] = {0.357, 0.436, 0.12, 0.063, 0.013};
constexpr double kLeastSpacing = 1;  // samples: finer lattices are as good as independent

}  // namespace

CorrelatedNoise::CorrelatedNoise(double length, const CellSize& cell) {
  if (length <= 0) return;
  row_m_per_length_ = cell.row_m / length;
  col_m_per_length_ = cell.col_m / length;
  double spacing = kCoarsest, left = 1;
  for (const double share : kShares) {
    const double rows = spacing / row_m_per_length_, cols = spacing / col_m_per_length_;
    if (rows < kLeastSpacing && cols < kLeastSpacing) break;
    lattices.push_back({rows, cols, std::sqrt(share)});
    left -= share;
    spacing /= kFiner;
  }
  own = std::sqrt(left);
}

double CorrelatedNoise::correlation(double rows, double cols) const {
  if (is_independent()) return rows == 0 && cols == 0 ? 1 : 0;
  return std::exp(-std::hypot(rows * row_m_per_length_, cols * col_m_per_length_));
}

}  // namespace sightbound
