// SPDX-License-Identifier: GPL-3.0-or-later
// Places of a DEM in plan metres, for comparing it with the truth.
#pragma once

#include <vector>

#include "earth/georeference.h"
#include "terrain/dem.h"

namespace sightbound {

// x runs along the rows, y against the columns; lengths are true along both, so that distances of places in a
// geographic CRS hold for some degrees around the middle.
class CheckPlan {
 public:
  CheckPlan(const DemSource&, const Georeference&);

  const CellSize& cell(double row) const;
  const CellSize& middle_cell() const { return cell(0.5 * static_cast<double>(sizes_.size())); }
  Xy metres(double col, double row) const;
  // Columns and rows of a shift in metres, at a row.
  Xy cells(const Xy& shift, double row) const {
    return {shift.x / cell(row).col_m, -shift.y / cell(row).row_m};
  }

 private:
  double middle_col_;
  std::vector<CellSize> sizes_;
};

// Numbers the parts of an 8 x 8 division of a window: neighbourhoods whose errors may depend on each other.
inline int check_block(double col, double row, const Window& whole) {
  constexpr int kSide = 8;
  const auto part = [](double at, int from, int size) {
    const int i = static_cast<int>(kSide * (at - from) / size);
    return i < 0 ? 0 : i >= kSide ? kSide - 1 : i;
  };
  return kSide * part(row, whole.row, whole.rows) + part(col, whole.col, whole.cols);
}

}  // namespace sightbound
