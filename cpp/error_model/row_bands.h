// SPDX-License-Identifier: GPL-3.0-or-later
// Walking a window in bands of rows, a few padded rows at hand at a time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "error_model/surroundings.h"

namespace sightbound {

// The last `kept` rows of something, found by row number; each of `cols` floats.
class RowRing {
 public:
  RowRing(int kept, int cols)
      : kept_(kept), cols_(cols), data_(static_cast<std::size_t>(kept) * static_cast<std::size_t>(cols)) {}

  float* row(int r) {
    const int slot = ((r % kept_) + kept_) % kept_;
    return data_.data() + static_cast<std::size_t>(slot) * static_cast<std::size_t>(cols_);
  }

 private:
  int kept_, cols_;
  std::vector<float> data_;
};

// Calls f(first row, row after the last) for bands that together cover the rows; checks for cancellation
// between them.
template <class F>
void for_each_band(int rows, const Workers& workers, Progress& progress, const F& f) {
  constexpr int kBandRows = 64;
  const int bands = (rows + kBandRows - 1) / kBandRows;
  workers.for_each(static_cast<std::size_t>(bands), [&](std::size_t band) {
    progress.check();
    const int first = static_cast<int>(band) * kBandRows;
    f(first, std::min(first + kBandRows, rows));
  });
}

}  // namespace sightbound
