// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_model/surroundings.h"

#include <algorithm>
#include <limits>

namespace sightbound {

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// Heights of `window`, which may reach beyond the DEM; NaN there.
Grid<float> read_padded(const Window& window, const DemSource& source, Progress& progress) {
  Grid<float> out(window.rows, window.cols, kNan);
  const Window inside = intersection(window, source.window());
  if (inside.empty()) return out;
  const Grid<float> part = source.read(inside, progress);
  for (int r = 0; r < inside.rows; ++r) {
    std::copy_n(part.row(r), inside.cols, out.row(inside.row - window.row + r) + (inside.col - window.col));
  }
  return out;
}

}  // namespace

Surroundings::Surroundings(const Grid<float>& heights)
    : heights_(heights),
      above_(kReach, padded_cols(), kNan),
      below_(kReach, padded_cols(), kNan),
      left_(rows(), kReach, kNan),
      right_(rows(), kReach, kNan) {}

Surroundings::Surroundings(const Grid<float>& heights, const Window& w, const DemSource& source,
                           Progress& progress)
    : heights_(heights),
      above_(read_padded({w.col - kReach, w.row - kReach, padded_cols(), kReach}, source, progress)),
      below_(read_padded({w.col - kReach, w.row_end(), padded_cols(), kReach}, source, progress)),
      left_(read_padded({w.col - kReach, w.row, kReach, rows()}, source, progress)),
      right_(read_padded({w.col_end(), w.row, kReach, rows()}, source, progress)) {}

void Surroundings::copy_row(int row, float* to) const {
  if (row < 0) {
    std::copy_n(above_.row(row + kReach), padded_cols(), to);
  } else if (row >= rows()) {
    std::copy_n(below_.row(row - rows()), padded_cols(), to);
  } else {
    to = std::copy_n(left_.row(row), kReach, to);
    to = std::copy_n(heights_.row(row), cols(), to);
    std::copy_n(right_.row(row), kReach, to);
  }
}

}  // namespace sightbound
