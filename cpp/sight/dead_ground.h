// SPDX-License-Identifier: GPL-3.0-or-later
// Dead ground: what no line from an eye comes near, proven for all of them, not only for those to samples.
//
// A square of samples is dead when every geodesic from the eye that passes over it, no higher than `rise`
// above its ground, passes lower than `fall` below ground that is nearer to the eye. It is proven by the
// sweep's wedges: each of those that touch a square must hide all of it by its lower horizon. The square the
// eye stands over is never dead. Errors of the ground play no part. Cost: some nanoseconds a cell; memory: a
// byte a sample.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "sight/fan_block.h"

namespace sightbound {

class DeadGround {
 public:
  // All of the grid, before anyone looks.
  explicit DeadGround(const Grid<float>& heights);

  // Takes away what may be seen from one eye more. `rise`, `fall`: metres, 0 or more. The same for any number
  // of threads.
  void look_from(const Scene&, const Eye&, double rise, double fall, const Workers&,
                 Progress&);  // only checks the progress

  // Are all squares around a sample dead, from every eye?
  bool holds(int row, int col) const { return !in_view_[index(row, col)].load(std::memory_order_relaxed); }
  // A square's four samples; those beyond the grid are passed over.
  void take_square(int row, int col);

 private:
  std::size_t index(int row, int col) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(cols_) + static_cast<std::size_t>(col);
  }

  int rows_, cols_;
  std::vector<std::atomic<bool>> in_view_;
};

}  // namespace sightbound
