// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/check_plan.h"

#include <algorithm>
#include <cmath>

namespace sightbound {

CheckPlan::CheckPlan(const DemSource& source, const Georeference& georeference)
    : middle_col_(0.5 * source.cols()), sizes_(ground_cell_sizes(georeference, source.window())) {}

const CellSize& CheckPlan::cell(double row) const {
  const auto last = static_cast<double>(sizes_.size() - 1);
  return sizes_[static_cast<std::size_t>(std::lround(std::clamp(row, 0.0, last)))];
}

Xy CheckPlan::metres(double col, double row) const {
  return {(col - middle_col_) * cell(row).col_m, -row * middle_cell().row_m};
}

}  // namespace sightbound
