// SPDX-License-Identifier: GPL-3.0-or-later
// The hot loops of the sweep: one column of one block of neighbouring wedges at a time, over plain arrays.
//
// Everything here is a bound: slopes of `above` are never below, slopes of `below` never above the truth (rounding of the
// float arithmetic is covered by kPositionPad here and by the height pad of whoever fills the arrays). The plain loops are the specification; the compiler's vector
// versions of the same loops give the same bits, since no operation is reordered or contracted.
#pragma once

#include <cstdint>

namespace sightbound {

inline constexpr float kUnbounded = 1e30f;     // stands for infinity where a sum must stay finite
inline constexpr float kPositionPad = 1e-3f;   // cells; float positions within a block are right to 1e-5

// A quantity that varies linearly over the wedges of a block: at the lower edge of wedge i it is first + i * step.
struct Linear {
  float first = 0, step = 0;
};

// Horizon slopes are heights over tau, tau = distance in major steps of the block (metres per step differ from wedge to
// wedge, not along one).
struct WedgeStep {
  int wedges = 0;
  Linear near, far;          // minor position of the wedge edges at both columns, from row 0 of the arrays
  float pad = 0;             // cells by which true edges may differ from those
  int rows = 0;              // entries of the arrays
  Linear drop_low, drop_high;        // metres the curved ground lies lower: at least (near column), at most (far column)
  float eye_above = 0, eye_below = 0;  // height of the eye for the upper and the lower bound
  float near_least = 0, far_most = 0, far_least = 0;  // 1 / tau at the columns: largest, smallest, largest
};

// above[i] = max(above[i], slope of the highest cell the wedge touches between the two columns). cells[j] is an upper bound
// of z + K sigma over the cell from row j to j + 1.
void raise_above(const WedgeStep&, const float* cells, float* above);
// below[i] = max(below[i], slope of the lowest place of the far column within the wedge). line[j] is z - K sigma at row j,
// linear between.
void raise_below(const WedgeStep&, const float* line, float* below);
// cells[j] = largest of the four corners.
void highest_corners(int cells_count, const float* near, const float* far, float* cells);

enum TargetState : std::uint8_t { kSurelyHidden = 0, kOpen = 1, kClearBetween = 2 };

struct TargetStep {
  int first_row = 0, rows = 0;   // targets: rows [first_row, first_row + rows) of the arrays
  int wedges = 0;
  Linear edges;                  // minor position of the wedge edges at the targets' column
  float pad = 0;
  Linear drop_low, drop_high;    // over wedges, at that column
  float eye_above = 0, eye_below = 0;
  float least = 0, most = 0;     // 1 / tau: largest, smallest
};

// state[j]: hidden when even the lower horizon hides a target at top_below[j]; clear when the upper horizon (which ends two
// columns before the target) does not reach a target at top_above[j].
void judge_targets(const TargetStep&, const float* above, const float* below, const float* top_above,
                   const float* top_below, std::uint8_t* state);

}  // namespace sightbound
