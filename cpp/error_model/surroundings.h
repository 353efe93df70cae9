// SPDX-License-Identifier: GPL-3.0-or-later
// Heights of a window with those around it, so that what is computed from neighbours does not depend on the
// window.
#pragma once

#include "base/progress.h"
#include "terrain/dem.h"
#include "terrain/grid.h"

namespace sightbound {

// Looks at the window's own heights (which must outlive it) and keeps the strips around them; no second copy
// of the window.
class Surroundings {
 public:
  static constexpr int kReach = 2;  // rows and columns known on every side

  // Nothing lies around: the window is the whole DEM.
  explicit Surroundings(const Grid<float>& heights);
  // Reads what the DEM has around `window`, of which `heights` are the heights.
  Surroundings(const Grid<float>& heights, const Window& window, const DemSource&, Progress&);

  int rows() const { return heights_.rows(); }
  int cols() const { return heights_.cols(); }
  int padded_cols() const { return cols() + 2 * kReach; }

  // `row` from -kReach to rows() + kReach - 1; writes padded_cols() heights, the window's first column at
  // [kReach]. NaN where the DEM has none or ends.
  void copy_row(int row, float* to) const;

 private:
  const Grid<float>& heights_;
  Grid<float> above_, below_;  // kReach x padded_cols()
  Grid<float> left_, right_;   // rows() x kReach
};

}  // namespace sightbound
