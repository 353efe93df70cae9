// SPDX-License-Identifier: GPL-3.0-or-later
// Windows of the original, checked; and the DEM cut into bands of rows that are as large as is held at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "base/progress.h"
#include "simplify/dem_windows.h"
#include "simplify/original.h"

namespace sightbound {

class Originals {
 public:
  // Reads about so many samples at once, but a row of tiles at least. `place_rounding`: place_rounding.h.
  Originals(DemWindows& dem, double tolerance_m, double place_rounding, std::int64_t samples_at_once)
      : dem_(dem),
        tolerance_m_(tolerance_m),
        place_rounding_(place_rounding),
        samples_at_once_(samples_at_once) {}

  // All tolerances count so many times from now on.
  void set_factor(double factor);

  int rows() const { return dem_.rows(); }
  int cols() const { return dem_.cols(); }

  struct Part {
    Part(DemWindow read, double tolerance_m, const Window& where, double place_rounding);

    const Window window;
    const DemWindow dem;
    const Original original;
  };
  // Samples of whole rows, [first_row, last_row] and perhaps more; lasts until the next call. A DEM that is
  // read in one piece is read once. Throws InvalidInput for heights beyond kLargestCoordinate, tolerances
  // that are none, and one that is less than what places lose when they are written.
  const Part& rows_of(int first_row, int last_row, Progress&);
  // Rows of tiles, each `tile` cells high, that are worth reading at once.
  int tiles_at_once(int tile) const;

  // The largest of all parts, metres (Original::margin).
  double margin() const { return margin_; }

  // Of the part that is held, at most.
  std::size_t bytes(int tile) const;

 private:
  DemWindows& dem_;
  double tolerance_m_, place_rounding_, factor_ = 1, margin_ = 0;
  std::int64_t samples_at_once_;
  std::optional<Part> part_;
};

}  // namespace sightbound
