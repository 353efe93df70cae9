// SPDX-License-Identifier: GPL-3.0-or-later
// What the simplifier reads of a DEM: windows, several times each, so that a large DEM is never held whole.
#pragma once

#include <cstdint>

#include "base/progress.h"
#include "terrain/grid.h"

namespace sightbound {

struct DemWindow {
  Grid<float> heights;      // metres, NaN = nodata, in the core's row order (dem.h)
  Grid<float> tolerance;    // of each sample, metres; empty = the same everywhere
  Grid<std::uint8_t> keep;  // samples that stay vertices at their own height where not 0; empty = none
};

class DemWindows {
 public:
  virtual ~DemWindows() = default;

  virtual int rows() const = 0;
  virtual int cols() const = 0;
  // A sample has the same values in every window, every time. Called by the thread that made `progress`.
  virtual DemWindow read(const Window&, Progress& progress) = 0;
};

}  // namespace sightbound
