// SPDX-License-Identifier: GPL-3.0-or-later
// Largest sample in blocks of cells, level by level: lets a search along a line skip whole stretches of
// terrain.
//
// Node (row, col) of level l covers the cells [row 2^l, (row + 1) 2^l) x [col 2^l, (col + 1) 2^l), hence the
// samples on its rim too. Levels below kFinest are not stored. Memory: a twelfth of the samples; cost: one
// pass.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "terrain/grid.h"

namespace sightbound {

class MaxPyramid {
 public:
  static constexpr int kFinest = 2;

  MaxPyramid() = default;
  // Row r of the samples: either a pointer to it, or `buffer` (one row long) filled and returned. Called from
  // any thread.
  using RowSource = std::function<const float*(int r, float* buffer)>;

  // NaN samples count for nothing in `max` and are told by `has_hole`.
  MaxPyramid(int rows, int cols, const RowSource&, const Workers&, Progress&);  // only checks the progress

  int coarsest() const { return kFinest + static_cast<int>(max_.size()) - 1; }
  // Lowest float where a node holds no sample but NaN.
  float max(int level, int row, int col) const {
    return max_[static_cast<std::size_t>(level - kFinest)].at(row, col);
  }
  const Grid<float>& finest() const { return max_.front(); }
  int finest_nodes(bool rows) const { return rows ? finest().rows() : finest().cols(); }
  bool any_hole() const { return !holes_.empty(); }
  bool has_hole(int level, int row, int col) const {
    return any_hole() && holes_[static_cast<std::size_t>(level - kFinest)].at(row, col) != 0;
  }

 private:
  std::vector<Grid<float>> max_;
  std::vector<Grid<std::uint8_t>> holes_;  // empty when there is no NaN at all
};

}  // namespace sightbound
