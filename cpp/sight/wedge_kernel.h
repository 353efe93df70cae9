// SPDX-License-Identifier: GPL-3.0-or-later
// The hot loops of the sweep: one column of one block of neighbouring wedges at a time, over plain arrays.
//
// Everything here is a bound: slopes of `above` are never below, slopes of `below` never above the truth
// (rounding of the float arithmetic is covered by kPositionPad here and by the height pad of whoever fills
// the arrays). The plain loops are the specification; the compiler's vector versions of the same loops give
// the same bits, since no operation is reordered or contracted.
#pragma once

#include <cstdint>

namespace sightbound {

// Counts are rounded up to whole vectors: arrays must be that long, and what lies behind their end is
// computed for nothing.
inline constexpr int kVector = 16;
constexpr int whole_vectors(int count) { return (count + kVector - 1) / kVector * kVector; }

inline constexpr float kUnbounded = 1e30f;    // stands for infinity where a sum must stay finite
inline constexpr float kPositionPad = 1e-3f;  // cells; float positions within a block are right to 1e-5

// A quantity that varies linearly over the wedges of a block: at the lower edge of wedge i it is first + i *
// step.
struct Linear {
  float first = 0, step = 0;
};

// Horizon slopes are heights over tau, tau = distance in major steps of the block (metres per step differ
// from wedge to wedge, not along one).
struct WedgeStep {
  int wedges = 0;
  Linear near, far;  // minor position of the wedge edges at both columns, from row 0 of the arrays
  float pad = 0;     // cells by which true edges may differ from those
  int rows = 0;      // entries of the arrays
  int window = 1;    // neighbours that an entry of the widened array stands for
  Linear drop_low,
      drop_high;  // metres the curved ground lies lower: at least (near column), at most (far column)
  float eye_above = 0, eye_below = 0;                 // height of the eye for the upper and the lower bound
  float near_least = 0, far_most = 0, far_least = 0;  // 1 / tau at the columns: largest, smallest, largest
};

// What a column of terrain says to both horizons: z +- K sigma. NaN (no terrain) never lowers the upper one
// below `unknown` and never raises the lower one.
struct ColumnBounds {
  int count = 0;
  float full = 0,
        near_end = 0;  // uniform error: K sigma for the upper and for the lower bound, pads included
  float ratio = 0;     // else K; times sigma from the arrays below
  float unknown = kUnbounded;
  float pad = 0;                    // metres
  const float* sampling = nullptr;  // sigma_s; null = uniform
  const float* between = nullptr;   // largest between-sample part
  bool end_zone = false;            // the lower bound counts the between-sample part alone
};
void bound_column(const ColumnBounds&, const float* z, float* above, float* below);

// A wedge is looked up in three windows of neighbouring entries: its first, its last and the one between.
// That covers a span (cells, pads included) when
constexpr int window_for(double span) { return (static_cast<int>(span) + 4) / 3; }

// above[i] = max(above[i], slope of the highest cell the wedge touches between the two columns). cells[j] is
// an upper bound of z + K sigma over the cells from row j to j + window.
void raise_above(const WedgeStep&, const float* cells, float* above);
// below[i] = max(below[i], slope of the lowest place of the far column within the wedge). line[j] is z - K
// sigma at row j, linear between; lowest[j] the smallest of line[j ... j + window - 1].
void raise_below(const WedgeStep&, const float* line, const float* lowest, float* below);
// values[j] = largest (smallest) of values[j ... j + window - 1], as far as there are `count`.
void widen_highest(int count, int window, float* values);
void widen_lowest(int count, int window, float* values);
// cells[j] = largest of the four corners (j, j + 1 of both columns): the arrays are one longer than whole
// vectors.
void highest_corners(int count, const float* near, const float* far, float* cells);

enum TargetState : std::int32_t { kSurelyHidden = 0, kOpen = 1 };

struct TargetStep {
  int first_row = 0, rows = 0;  // targets: rows [first_row, first_row + rows) of the arrays
  int wedges = 0;
  Linear edges;  // minor position of the wedge edges at the targets' column
  float pad = 0;
  Linear drop_low, drop_high;  // over wedges, at that column
  float eye_above = 0, eye_below = 0;
  float least = 0, most = 0;  // 1 / tau: largest, smallest
};

// The wedges a target in row j may lie in, first and last.
struct WedgePair {
  int a, b;
};
WedgePair wedges_of(const TargetStep&, int j);
// The least slope at which a target at `top_above` in row j stands out, wedge `a` given.
float flattest_slope(const TargetStep&, int a, float top_above);

// state[j]: hidden when even the lower horizon hides a target that reaches up to top_below[j].
void judge_targets(const TargetStep&, const float* below, const float* top_below, std::int32_t* state);

}  // namespace sightbound
