// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/wedge_kernel.h"

#include <algorithm>
#include <cmath>

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(SIGHTBOUND_SCALAR)
#define SIGHTBOUND_VECTOR __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define SIGHTBOUND_VECTOR
#endif

namespace sightbound {

namespace {

inline float least(float a, float b) { return a < b ? a : b; }
inline float most(float a, float b) { return a > b ? a : b; }
inline int within(int value, int low, int high) {
  value = value < low ? low : value;
  return value > high ? high : value;
}

}  // namespace

SIGHTBOUND_VECTOR
void raise_above(const WedgeStep& s, const float* __restrict cells, float* __restrict above) {
  const float near_first = s.near.first, near_step = s.near.step, far_first = s.far.first, far_step = s.far.step;
  const float pad = s.pad, drop_first = s.drop_low.first, drop_step = s.drop_low.step, eye = s.eye_above;
  const float rising = s.near_least, falling = s.far_most;
  const int wedges = s.wedges, last = s.rows - 2;
  for (int i = 0; i < wedges; ++i) {
    const float k = static_cast<float>(i), k1 = k + 1;
    const float low = least(near_first + k * near_step, far_first + k * far_step) - pad;
    const float high = most(near_first + k1 * near_step, far_first + k1 * far_step) + pad;
    const int a = within(static_cast<int>(low), 0, last), b = within(static_cast<int>(high), 0, last);
    const int middle = a + 1 < b ? a + 1 : b;
    const float top = most(most(cells[a], cells[b]), cells[middle]);
    const float over = top - (drop_first + k * drop_step) - eye;
    const float slope = over * (over > 0 ? rising : falling);
    above[i] = most(above[i], slope);
  }
}

SIGHTBOUND_VECTOR
void raise_below(const WedgeStep& s, const float* __restrict line, float* __restrict below) {
  const float first = s.far.first, step = s.far.step, pad = s.pad;
  const float drop_first = s.drop_high.first, drop_step = s.drop_high.step, eye = s.eye_below;
  const float rising = s.far_most, falling = s.far_least;
  const int wedges = s.wedges, last = s.rows - 2;
  for (int i = 0; i < wedges; ++i) {
    const float k = static_cast<float>(i), k1 = k + 1;
    const float low = first + k * step - pad, high = first + k1 * step + pad;
    const int a = within(static_cast<int>(low), 0, last), b = within(static_cast<int>(high), 0, last);
    const float at_low = line[a] + (line[a + 1] - line[a]) * (low - static_cast<float>(a));
    const float at_high = line[b] + (line[b + 1] - line[b]) * (high - static_cast<float>(b));
    const float inner = b > a ? least(line[a + 1], line[b]) : kUnbounded;
    const float bottom = least(least(at_low, at_high), inner);
    const float over = bottom - (drop_first + k * drop_step) - eye;
    const float slope = over * (over > 0 ? rising : falling);
    below[i] = most(below[i], slope);
  }
}

SIGHTBOUND_VECTOR
void highest_corners(int count, const float* __restrict near, const float* __restrict far, float* __restrict cells) {
  for (int j = 0; j < count; ++j) cells[j] = most(most(near[j], near[j + 1]), most(far[j], far[j + 1]));
}

SIGHTBOUND_VECTOR
void judge_targets(const TargetStep& s, const float* __restrict above, const float* __restrict below,
                   const float* __restrict top_above, const float* __restrict top_below, std::uint8_t* __restrict state) {
  const float first = s.edges.first, per_cell = 1 / s.edges.step, pad = s.pad;
  const float low_first = s.drop_low.first, low_step = s.drop_low.step;
  const float high_first = s.drop_high.first, high_step = s.drop_high.step;
  const float eye_above = s.eye_above, eye_below = s.eye_below, largest = s.least, smallest = s.most;
  const int last = s.wedges - 1, row0 = s.first_row, rows = s.rows;
  for (int j = 0; j < rows; ++j) {
    const float position = static_cast<float>(row0 + j) - first;
    const int a = within(static_cast<int>((position - pad) * per_cell), 0, last);
    const int b = within(static_cast<int>((position + pad) * per_cell), 0, last);
    // Highest the target can stand out against the lower horizon, lowest against the upper one.
    const float high = top_below[row0 + j] - (low_first + static_cast<float>(a) * low_step) - eye_below;
    const float low = top_above[row0 + j] - (high_first + static_cast<float>(a) * high_step) - eye_above;
    const float steepest = high * (high > 0 ? largest : smallest);
    const float flattest = low * (low > 0 ? smallest : largest);
    const float hides = least(below[a], below[b]), reaches = most(above[a], above[b]);
    constexpr float kRounding = 1e-6f;  // relative; several float roundings of 6e-8
    const bool hidden = hides > steepest + kRounding * (std::fabs(hides) + std::fabs(steepest));
    const bool clear = reaches < flattest - kRounding * (std::fabs(reaches) + std::fabs(flattest));
    state[j] = hidden ? kSurelyHidden : clear ? kClearBetween : kOpen;
  }
}

}  // namespace sightbound
