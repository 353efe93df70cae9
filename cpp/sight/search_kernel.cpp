// SPDX-License-Identifier: GPL-3.0-or-later
// Notation: a, b = where a part begins and ends; u = share of the way between them; j = the row of samples
// below the line, v = rows above it.
#include "sight/search_kernel.h"

#include "sight/vector.h"

namespace sightbound {

namespace {

constexpr float kFloatRounding = 1e-5f;  // relative; some twenty float roundings of 6e-8

SIGHTBOUND_INLINE float magnitude(float x) { return larger(x, -x); }
SIGHTBOUND_INLINE float within(float x, float low, float high) { return larger(smaller(x, high), low); }

// minor[i] = the line's minor coordinate at xi[i].
SIGHTBOUND_INLINE void minors_at(const ScannedLine& line, const float* __restrict xi,
                                 float* __restrict minor) {
  float bow[kScan] = {};
  for (int t = line.terms - 1; t >= 0; --t) {
    const float c = line.bow[static_cast<std::size_t>(t)];
    for (int i = 0; i < kScan; ++i) bow[i] = bow[i] * xi[i] + c;
  }
  const float minor0 = line.minor0, span = line.minor_span;
  for (int i = 0; i < kScan; ++i) minor[i] = minor0 + xi[i] * span + xi[i] * (1 - xi[i]) * bow[i];
}

// xi where the parts begin and end, and the minor coordinates there.
struct Ends {
  float begin[kScan], end[kScan], minor_a[kScan], minor_b[kScan];
};

SIGHTBOUND_INLINE void ends_of_parts(const ScannedLine& line, float xi, float step, Ends& ends) {
  for (int i = 0; i < kScan; ++i) {
    ends.begin[i] = xi + static_cast<float>(i) * step;
    ends.end[i] = ends.begin[i] + step;
  }
  minors_at(line, ends.begin, ends.minor_a);
  minors_at(line, ends.end, ends.minor_b);
}

}  // namespace

SIGHTBOUND_VECTOR
void scan_nodes(const ScannedLine& line, const NodeScan& s, std::int32_t* __restrict matters) {
  Ends ends;
  ends_of_parts(line, s.xi, s.xi_step, ends);
  const float* __restrict highest = s.highest;
  const float* __restrict widest = s.widest != nullptr ? s.widest : s.highest;
  const float widest_counts = s.widest != nullptr ? 1.0f : 0.0f;
  const float last_minor = static_cast<float>(line.minors - 1),
              last_cell = static_cast<float>(line.minors - 2);
  const int major_stride = s.major_stride, minor_stride = s.minor_stride;
  const float rise = line.rise, drop = line.drop, eye = line.eye, rim = line.rim;
  const float minor_pad = s.minor_pad, share_pad = line.share_pad, height_pad = line.height_pad,
              ratio = s.ratio;
  const float uniform = line.uniform, moving = line.ends, least_sigma = line.least_sigma,
              end_zone_sigma = line.end_zone_sigma, end_zone = line.end_zone_share;
  for (int i = 0; i < kScan; ++i) {
    const float low = smaller(ends.minor_a[i], ends.minor_b[i]),
                high = larger(ends.minor_a[i], ends.minor_b[i]);
    const float from = within(low - minor_pad, 0, last_cell), to = within(high + minor_pad, 0, last_cell);
    const int a = static_cast<int>(from) >> 2, b = static_cast<int>(to) >> 2, middle = a + 1 < b ? a + 1 : b;
    const int along = i * major_stride;
    const int at_a = along + a * minor_stride, at_middle = along + middle * minor_stride,
              at_b = along + b * minor_stride;
    const float z = larger(larger(highest[at_a], highest[at_middle]), highest[at_b]);
    const float wide = larger(larger(widest[at_a], widest[at_middle]), widest[at_b]);
    const float sigma_most = (widest_counts != 0 ? wide : uniform) + moving;

    const float first = smaller(ends.begin[i], ends.end[i]) - share_pad,
                last = larger(ends.begin[i], ends.end[i]) + share_pad, width = last - first;
    const float height_first = first * rise - drop * first * (1 - first),
                height_last = last * rise - drop * last * (1 - last);
    const float lowest = smaller(height_first, height_last) - drop * width * width / 4;
    const float in_end_zone = smaller(first, 1 - last);
    const float sigma_least = in_end_zone < end_zone ? end_zone_sigma : least_sigma;
    const float needed = ratio * (ratio > 0 ? sigma_most : sigma_least) + height_pad;
    const float clearance = lowest - (z - eye);
    // Beyond the rim nothing is known; the part before the observer has no say.
    const float inside = smaller(low + rim, last_minor - high + rim);
    const float safe = smaller(clearance - needed, smaller(inside, first));
    matters[i] = safe >= 0 ? 0 : 1;
  }
}

namespace {

// Between two columns the line crosses, of the cells j and j + 1, at most the row between them and both
// diagonals. Terrain and line are linear from crossing to crossing, so the least clearance of all is at one
// of them, or less by what the terrain varies over the pad.
template <bool kUniform>
SIGHTBOUND_INLINE void bound_sixteen(const ScannedLine& line, const StepScan& s, float* __restrict ratio) {
  Ends ends;
  ends_of_parts(line, s.xi, s.xi_step, ends);
  const float* __restrict heights = s.heights;
  const float* __restrict widest = s.widest;
  const int last_row = line.minors - 1, last_step = s.steps - 1, major_stride = s.major_stride,
            minor_stride = s.minor_stride;
  const int widest_along = s.widest_major_stride, widest_across = s.widest_minor_stride;
  const float last_minor = static_cast<float>(last_row), last_cell = static_cast<float>(last_row - 1);
  const float rise = line.rise, drop = line.drop, eye = line.eye, rim = line.rim, pad = s.minor_pad,
              share_pad = line.share_pad;
  const float sag = drop * s.xi_step * s.xi_step / 4;
  const float lost = line.height_pad + sag + share_pad * (magnitude(rise) + drop);
  const float uniform = line.uniform, moving = line.ends, least_sigma = line.least_sigma,
              end_zone_sigma = line.end_zone_sigma, end_zone = line.end_zone_share;
  const int first_node = s.first >> 2, first_step = s.first;
  for (int i = 0; i < kScan; ++i) {
    const float low = smaller(ends.minor_a[i], ends.minor_b[i]),
                high = larger(ends.minor_a[i], ends.minor_b[i]);
    const int j = static_cast<int>(within(low - pad, 0, last_cell));
    const int j2 = j + 2 < last_row ? j + 2 : last_row, next = j2 - 1;
    const int step = i < last_step ? i : last_step, near = step * major_stride, far = near + major_stride;
    const float a0 = heights[near + j * minor_stride], a1 = heights[near + (j + 1) * minor_stride],
                a2 = heights[near + j2 * minor_stride];
    const float b0 = heights[far + j * minor_stride], b1 = heights[far + (j + 1) * minor_stride],
                b2 = heights[far + j2 * minor_stride];
    float most = uniform + moving;
    if constexpr (!kUniform) {
      const int node = (((first_step + step) >> 2) - first_node) * widest_along;
      const float wide =
          larger(widest[node + (j >> 2) * widest_across], widest[node + (next >> 2) * widest_across]);
      most = wide + moving;
    }

    const float row = static_cast<float>(j);
    const float v_a = within(ends.minor_a[i] - row, 0, 2), v_b = within(ends.minor_b[i] - row, 0, 2),
                dv = v_b - v_a;
    const float t_a = ends.begin[i], t_b = ends.end[i];
    const float l_a = t_a * rise - drop * t_a * (1 - t_a), l_b = t_b * rise - drop * t_b * (1 - t_b),
                dl = l_b - l_a;
    const float z_a = a0 + (a1 - a0) * smaller(v_a, 1) + (a2 - a1) * larger(v_a - 1, 0);
    const float z_b = b0 + (b1 - b0) * smaller(v_b, 1) + (b2 - b1) * larger(v_b - 1, 0);
    const float columns = smaller(l_a - z_a, l_b - z_b);
    // The row: v = 1. The diagonals: v = u and v = 1 + u. Those the line does not cross within the step lie
    // at no u in (0, 1).
    const float u_row = (1 - v_a) / dv, u_low = v_a / (1 - dv), u_high = (v_a - 1) / (1 - dv);
    const float at_row = l_a + dl * u_row - (a1 + (b1 - a1) * u_row);
    const float at_low = l_a + dl * u_low - (a0 + (b1 - a0) * u_low);
    const float at_high = l_a + dl * u_high - (a1 + (b2 - a1) * u_high);
    const float of_row = u_row * (1 - u_row) > 0 ? at_row : columns;
    const float of_low = u_low * (1 - u_low) > 0 ? at_low : columns;
    const float of_high = u_high * (1 - u_high) > 0 ? at_high : columns;
    const float least = smaller(smaller(columns, of_row), smaller(of_low, of_high));
    const float steepest = larger(larger(magnitude(a1 - a0), magnitude(a2 - a1)),
                                  larger(magnitude(b1 - b0), magnitude(b2 - b1)));
    const float clearance = least + eye - pad * steepest - lost;

    const float in_end_zone = smaller(smaller(t_a, t_b), 1 - larger(t_a, t_b)) - share_pad;
    const float sigma_least = in_end_zone < end_zone ? end_zone_sigma : least_sigma;
    const float bound = clearance / (clearance > 0 ? most : sigma_least);
    // Nothing is said of what lies beyond the rim, the three rows, the grid; nor of holes.
    const float inside = smaller(low + rim, last_minor - high + rim);
    const float room = j2 < j + 2 ? 1 : row + 2 - high - pad;
    const float known = a0 + a1 + a2 + b0 + b1 + b2;
    const float whole = known == known ? 1.0f : -1.0f;
    const float there = i <= last_step ? 1.0f : -1.0f;
    const float said = smaller(smaller(inside, room), smaller(whole, there));
    const float trimmed = bound - kFloatRounding * magnitude(bound);
    ratio[i] = said > 0 ? trimmed : -kNoRatio;
  }
}

SIGHTBOUND_VECTOR
void bound_uniform(const ScannedLine& line, const StepScan& s, float* __restrict ratio) {
  bound_sixteen<true>(line, s, ratio);
}

SIGHTBOUND_VECTOR
void bound_varied(const ScannedLine& line, const StepScan& s, float* __restrict ratio) {
  bound_sixteen<false>(line, s, ratio);
}

}  // namespace

void bound_steps(const ScannedLine& line, const StepScan& s, float* ratio) {
  s.widest == nullptr ? bound_uniform(line, s, ratio) : bound_varied(line, s, ratio);
}

SIGHTBOUND_VECTOR
void scan_places(const ScannedLine& line, const PlaceScan& s, std::int32_t* __restrict matters) {
  float minor[kScan];
  minors_at(line, s.shares.data(), minor);
  const float* __restrict heights = s.heights;
  const float* __restrict shares = s.shares.data();
  const int major_stride = s.major_stride, minor_stride = s.minor_stride;
  const float last_major = static_cast<float>(s.majors - 2), last_minor = static_cast<float>(line.minors - 2);
  const float major0 = s.major0, span = s.major_span, pad = s.pad, rise = line.rise, drop = line.drop,
              eye = line.eye;
  const float needed = s.clearance + line.height_pad + line.share_pad * (magnitude(rise) + drop);
  for (int i = 0; i < kScan; ++i) {
    const float t = shares[i], major = major0 + t * span;
    const int m = static_cast<int>(within(major, 0, last_major)),
              j = static_cast<int>(within(minor[i], 0, last_minor));
    const float f_m = major - static_cast<float>(m), f_w = minor[i] - static_cast<float>(j);
    const int at = m * major_stride + j * minor_stride;
    const float corner = heights[at], along = heights[at + major_stride], across = heights[at + minor_stride],
                opposite = heights[at + major_stride + minor_stride];
    const float below = corner + (along - corner) * f_m + (opposite - along) * f_w,
                above = corner + (across - corner) * f_w + (opposite - across) * f_m;
    const float z = f_m < f_w ? above : below;
    const float steepest = larger(larger(magnitude(along - corner), magnitude(opposite - along)),
                                  larger(magnitude(across - corner), magnitude(opposite - across)));
    const float clearance = t * rise - drop * t * (1 - t) - (z - eye) - 2 * pad * steepest;
    // Where the cell itself is in doubt, so is its terrain; holes are judged one by one.
    const float from_rim = smaller(smaller(f_m, 1 - f_m), smaller(f_w, 1 - f_w)) - pad;
    const float known = corner + along + across + opposite, whole = known == known ? 0.0f : -1.0f;
    matters[i] = smaller(smaller(clearance - needed, from_rim), whole) >= 0 ? 0 : 1;
  }
}

}  // namespace sightbound
