// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/wedge_kernel.h"

#include <cmath>

#include "error_model/error_model.h"
#include "sight/vector.h"

namespace sightbound {

namespace {

constexpr float kRounding = 1e-6f;  // relative; several float roundings of 6e-8

inline int within(int value, int low, int high) {
  value = value < low ? low : value;
  return value > high ? high : value;
}

}  // namespace

SIGHTBOUND_VECTOR
void bound_column(const ColumnBounds& c, const float* __restrict z, float* __restrict above,
                  float* __restrict below) {
  const int count = whole_vectors(c.count);
  const float unknown = c.unknown, full = c.full, near_end = c.near_end, ratio = c.ratio, pad = c.pad;
  if (c.sampling == nullptr) {
    for (int j = 0; j < count; ++j) {
      above[j] = z[j] == z[j] ? z[j] + full : unknown;
      below[j] = z[j] == z[j] ? z[j] - near_end : -kUnbounded;
    }
    return;
  }
  const float* __restrict sampling = c.sampling;
  const float* __restrict between = c.between;
  const float counted = c.end_zone ? 0.0f : 1.0f, floor = static_cast<float>(kLeastSigma);
  for (int j = 0; j < count; ++j) {
    const float wide = ratio * larger(sampling[j] + between[j], floor) + pad;
    const float narrow = ratio * larger(counted * sampling[j] + between[j], floor) + pad;
    above[j] = z[j] == z[j] ? z[j] + wide : unknown;
    below[j] = z[j] == z[j] ? z[j] - narrow : -kUnbounded;
  }
}

SIGHTBOUND_VECTOR
void raise_above(const WedgeStep& s, const float* __restrict cells, float* __restrict above) {
  const float near_first = s.near.first, near_step = s.near.step, far_first = s.far.first,
              far_step = s.far.step;
  const float pad = s.pad, drop_first = s.drop_low.first, drop_step = s.drop_low.step, eye = s.eye_above;
  const float rising = s.near_least, falling = s.far_most;
  const int wedges = whole_vectors(s.wedges), last = s.rows - 2, window = s.window;
  for (int i = 0; i < wedges; ++i) {
    const float k = static_cast<float>(i), k1 = k + 1;
    const float low = smaller(near_first + k * near_step, far_first + k * far_step) - pad;
    const float high = larger(near_first + k1 * near_step, far_first + k1 * far_step) + pad;
    const int a = within(static_cast<int>(low), 0, last), b = within(static_cast<int>(high), 0, last);
    const int end = b - window + 1 > a ? b - window + 1 : a, middle = a + window < end ? a + window : end;
    const float top = larger(larger(cells[a], cells[end]), cells[middle]);
    const float over = top - (drop_first + k * drop_step) - eye;
    const float slope = over * (over > 0 ? rising : falling);
    above[i] = larger(above[i], slope);
  }
}

SIGHTBOUND_VECTOR
void raise_below(const WedgeStep& s, const float* __restrict line, const float* __restrict lowest,
                 float* __restrict below) {
  const float first = s.far.first, step = s.far.step, pad = s.pad;
  const float drop_first = s.drop_high.first, drop_step = s.drop_high.step, eye = s.eye_below;
  const float rising = s.far_most, falling = s.far_least;
  const int wedges = whole_vectors(s.wedges), last = s.rows - 2, window = s.window;
  for (int i = 0; i < wedges; ++i) {
    const float k = static_cast<float>(i), k1 = k + 1;
    const float low = first + k * step - pad, high = first + k1 * step + pad;
    const int a = within(static_cast<int>(low), 0, last), b = within(static_cast<int>(high), 0, last);
    const float at_low = line[a] + (line[a + 1] - line[a]) * (low - static_cast<float>(a));
    const float at_high = line[b] + (line[b + 1] - line[b]) * (high - static_cast<float>(b));
    const int begin = a + 1, end = b - window + 1 > begin ? b - window + 1 : begin,
              middle = begin + window < end ? begin + window : end;
    const float within_wedge = smaller(smaller(lowest[begin], lowest[end]), lowest[middle]);
    const float inner = b > a ? within_wedge : kUnbounded;
    const float bottom = smaller(smaller(at_low, at_high), inner);
    const float over = bottom - (drop_first + k * drop_step) - eye;
    const float slope = over * (over > 0 ? rising : falling);
    below[i] = larger(below[i], slope);
  }
}

SIGHTBOUND_VECTOR
void highest_corners(int count, const float* __restrict near, const float* __restrict far,
                     float* __restrict cells) {
  const int whole = whole_vectors(count);
  for (int j = 0; j < whole; ++j) cells[j] = larger(larger(near[j], near[j + 1]), larger(far[j], far[j + 1]));
}

SIGHTBOUND_VECTOR
void widen_highest(int count, int window, float* values) {
  const int whole = whole_vectors(count);
  for (int j = count; j < whole + window; ++j) values[j] = values[count - 1];
  for (int pass = 1; pass < window; ++pass) {
    for (int j = 0; j < whole; ++j) values[j] = larger(values[j], values[j + 1]);
  }
}

SIGHTBOUND_VECTOR
void widen_lowest(int count, int window, float* values) {
  const int whole = whole_vectors(count);
  for (int j = count; j < whole + window; ++j) values[j] = values[count - 1];
  for (int pass = 1; pass < window; ++pass) {
    for (int j = 0; j < whole; ++j) values[j] = smaller(values[j], values[j + 1]);
  }
}

WedgePair wedges_of(const TargetStep& s, int j) {
  const float position = static_cast<float>(s.first_row + j) - s.edges.first, per_cell = 1 / s.edges.step;
  return {within(static_cast<int>((position - s.pad) * per_cell), 0, s.wedges - 1),
          within(static_cast<int>((position + s.pad) * per_cell), 0, s.wedges - 1)};
}

float flattest_slope(const TargetStep& s, int a, float top_above) {
  const float over = top_above - (s.drop_high.first + static_cast<float>(a) * s.drop_high.step) - s.eye_above;
  const float slope = over * (over > 0 ? s.most : s.least);
  return slope - kRounding * std::fabs(slope);
}

SIGHTBOUND_VECTOR
void judge_targets(const TargetStep& s, const float* __restrict below, const float* __restrict top_below,
                   std::int32_t* __restrict state) {
  const float first = s.edges.first, per_cell = 1 / s.edges.step, pad = s.pad;
  const float drop_first = s.drop_low.first, drop_step = s.drop_low.step, eye = s.eye_below;
  const float largest = s.least, smallest = s.most;
  const int last = s.wedges - 1, row0 = s.first_row, rows = whole_vectors(s.rows);
  for (int j = 0; j < rows; ++j) {
    const float position = static_cast<float>(row0 + j) - first;
    const int a = within(static_cast<int>((position - pad) * per_cell), 0, last);
    const int b = within(static_cast<int>((position + pad) * per_cell), 0, last);
    // The highest the target can stand out against the lower horizon.
    const float over = top_below[row0 + j] - (drop_first + static_cast<float>(a) * drop_step) - eye;
    const float steepest = over * (over > 0 ? largest : smallest);
    const float hides = smaller(below[a], below[b]);
    const float hidden_above = steepest + kRounding * (std::fabs(hides) + std::fabs(steepest));
    state[j] = hides > hidden_above ? kSurelyHidden : kOpen;
  }
}

}  // namespace sightbound
