// SPDX-License-Identifier: GPL-3.0-or-later
// The viewshed of one observer on one scene: bracket everything by the sweep, settle exactly what straddles.
//
// Confidence and verdict of a cell are functions of observer and target alone: the same bits for any number
// of threads, any window in memory, any part of it asked for. Cost: near O(cells); a settled cell costs about
// a microsecond.
#pragma once

#include <cstdint>
#include <span>

#include "base/parallel.h"
#include "base/progress.h"
#include "sight/confidence.h"
#include "sight/wedge_fan.h"

namespace sightbound {

struct ViewLimits {
  double min_distance = 0, max_distance = 1e300;  // metres on the ground, inclusive
  double azimuth_from = 0, azimuth_to = 360;      // degrees from true north, clockwise
  double angle_from = -90, angle_to = 90;         // degrees above the observer's horizontal

  bool all_azimuths() const { return azimuth_to - azimuth_from >= 360; }
  bool all_angles() const { return angle_from <= -90 && angle_to >= 90; }
  bool admits_azimuth(double azimuth_deg) const;
};

// What a cell holds before anything is put there. Hidden is for a first observer who is asked about every
// cell: most are hidden, and then cost nothing (Grid::zeros). Not with heights.
enum class CanvasStart { kNobodyAsked, kAllHidden };

// Several observers' answers put together cell by cell: best = seen by any, worst = seen by all that have the
// cell in range.
class Canvas {
 public:
  // `window` is in the scene's grid.
  Canvas(const Window& window, CanvasStart, bool best, bool heights, const Workers&,
         Progress&);  // only checks the progress

  const Window& window() const { return window_; }
  bool has_heights() const { return !certain_height.empty(); }
  bool holds(int row, int col) const {
    return row >= window_.row && row < window_.row_end() && col >= window_.col && col < window_.col_end();
  }
  // The canvas seen from another scene whose grid starts elsewhere.
  void move_to(int col, int row) { window_.col = col, window_.row = row; }
  // Every cell is put at most once per observer: after the first one results are combined.
  void next_observer() { fresh_ = false; }

  void put(int row, int col, float p, std::uint8_t verdict);
  // Nobody can be asked about the cell.
  void leave(int row, int col);
  // The same for a run of hidden cells along a row or down a column.
  void hide(int row, int col, int run, bool along_row);
  void put_heights(int row, int col, float certain, float likely);
  // Counts the observers that claim visible; before it is called only the verdict knows of a single one.
  void start_counting(const Workers&, Progress&);
  // Cells at which no height is sure become NaN; nothing may be put afterwards.
  void seal_heights(const Workers&, Progress&);
  void flip_rows();

  Grid<float> confidence;  // NaN = nobody asked
  Grid<std::uint8_t> verdict;
  Grid<std::uint32_t> count;  // empty unless counting
  Grid<float> certain_height,
      likely_height;  // metres above ground; NaN = nobody asked, infinite = none is sure

 private:
  Window window_;
  CanvasStart start_;
  bool best_, fresh_ = true;
};

// What one observer sees, square metres; in doubt for holes alone: counted in `uncertain_m2` too.
struct ViewTotals {
  double visible_m2 = 0, uncertain_m2 = 0, hidden_m2 = 0, hole_doubt_m2 = 0;
  std::uint64_t settled = 0;  // cells that needed an exact line

  ViewTotals& operator+=(const ViewTotals&);
};

struct View {
  const Scene& scene;
  Eye eye;
  TargetTops tops;
  const Grid<float>& ground;           // what heights above ground refer to, on the scene's grid
  std::span<const double> cell_areas;  // square metres, one per row of the scene's grid
  ViewLimits limits;
};

// `progress` is advanced by 1 per cell of the scene's grid within reach.
ViewTotals viewshed(const View&, Canvas&, const Workers&, Progress&);

}  // namespace sightbound
