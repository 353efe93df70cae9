// SPDX-License-Identifier: GPL-3.0-or-later
// One block of the sweep's fan: where its columns and wedges lie, how far off, and how far the ground bends
// away from under them. Internal to the sweep.
//
// Notation: step = major steps from the observer; edges a, b = the two geodesics that bound a block; between
// them wedge edges are interpolated linearly, the geodesic in the middle tells by how much that can be wrong.
// tau = distance over metres per step at the observer, the measure in which a wedge's slopes are compared.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "sight/scene.h"
#include "sight/sight_line.h"
#include "sight/wedge_kernel.h"

namespace sightbound {

// Enough tasks for many threads, enough wedges for vectors.
inline constexpr int kBlocksPerUnit = 16;  // of slope

struct FanBlock {
  bool transposed;
  int sign;
  int index;     // slopes [index, index + 1] / kBlocksPerUnit
  double reach;  // major steps to the rim of the grid
};

// Major steps from the eye to the rim of the grid on one of its four sides.
double reach_of_side(const Scene&, const Eye&, bool transposed, int sign);

// A quantity along the block's three geodesics at one column.
struct Fan3 {
  double a = 0, middle = 0, b = 0;
  double bend() const;
  double low() const { return std::min({a, middle, b}) - bend(); }
  double high() const { return std::max({a, middle, b}) + bend(); }
};

struct ColumnPlace {
  int major = 0;  // from the base sample
  double step = 0;
  Fan3 minor, distance, tau, square;  // square = distance^2
};

// Minor coordinates from the base sample, half-open.
struct RowRange {
  int low, high;
  int count() const { return high - low; }
  bool empty() const { return low >= high; }
};

class FanColumns {
 public:
  FanColumns(const Scene&, const Eye&, const FanBlock&);

  bool transposed() const { return block_.transposed; }
  int sign() const { return block_.sign; }
  int base_major() const { return base_major_; }
  int base_minor() const { return base_minor_; }
  int majors() const { return majors_; }
  int minors() const { return minors_; }
  double observer_major() const { return major0_; }
  // The first column beyond the observer.
  int first_major() const;

  ColumnPlace place(int major) const;
  bool on_grid(int major) const { return major + base_major_ >= 0 && major + base_major_ < majors_; }
  bool is_off_grid(const ColumnPlace&) const;  // has the block left it sideways?
  // Between the block's edges, on this side's half of the diagonals (the diagonals belong to the columns'
  // sides).
  RowRange targets_at(const ColumnPlace&) const;

  // Of so many wedges' edges, from row `first`.
  Linear edges(const ColumnPlace& p, int first, int wedges) const {
    return {static_cast<float>(p.minor.a - first), static_cast<float>(width(p, wedges))};
  }
  // Of one wedge, cells.
  double width(const ColumnPlace& p, int wedges) const { return (p.minor.b - p.minor.a) / wedges; }
  // By which edges may be wrong, cells.
  float pad(const ColumnPlace& p) const {
    return static_cast<float>(p.minor.bend() + frame_pad_) + kPositionPad;
  }
  // What the curved ground lies lower, metres: at least, at most; over the wedges, and of all of them.
  Linear least_drop(const ColumnPlace& p, int wedges) const { return drop(p, wedges, curvature_low_, -1); }
  Linear most_drop(const ColumnPlace& p, int wedges) const { return drop(p, wedges, curvature_high_, 1); }
  float least_drop_of_all(const ColumnPlace& p, int wedges) const {
    const Linear fall = least_drop(p, wedges);
    return std::min(fall.first, fall.first + static_cast<float>(wedges) * fall.step);
  }
  // 1 / tau.
  float largest_inverse(const ColumnPlace& p) const {
    return static_cast<float>((1 + inverse_pad(p)) / p.tau.low());
  }
  float smallest_inverse(const ColumnPlace& p) const {
    return static_cast<float>((1 - inverse_pad(p)) / p.tau.high());
  }

 private:
  void bound_curvature(const Scene&, const Eye&);
  Linear drop(const ColumnPlace&, int wedges, double curvature, int side) const;
  // A frame may be wrong by `frame_pad_` cells.
  double inverse_pad(const ColumnPlace& p) const { return 1e-6 + frame_pad_ / std::max(p.step, 0.5); }

  FanBlock block_;
  std::array<GeodesicRay, 3> rays_;
  int base_major_, base_minor_, majors_, minors_;
  double major0_, minor0_;
  double frame_pad_;  // cells
  double curvature_low_ = 0, curvature_high_ = 0;
};

}  // namespace sightbound
