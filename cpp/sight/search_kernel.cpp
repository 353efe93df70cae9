// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/search_kernel.h"

#include "sight/vector.h"

namespace sightbound {

SIGHTBOUND_VECTOR
void scan_nodes(const NodeScan& s, std::int32_t* __restrict matters) {
  float minor_a[kScan], minor_b[kScan];
  for (int i = 0; i < kScan; ++i) {
    const float a = s.xi + static_cast<float>(i) * s.xi_step, b = a + s.xi_step;
    float bow_a = 0, bow_b = 0;
    for (int t = s.terms - 1; t >= 0; --t) {
      bow_a = bow_a * a + s.bow[static_cast<std::size_t>(t)];
      bow_b = bow_b * b + s.bow[static_cast<std::size_t>(t)];
    }
    minor_a[i] = s.minor0 + a * s.minor_span + a * (1 - a) * bow_a;
    minor_b[i] = s.minor0 + b * s.minor_span + b * (1 - b) * bow_b;
  }
  const float* __restrict highest = s.highest;
  const float* __restrict widest = s.widest != nullptr ? s.widest : s.highest;
  const float widest_counts = s.widest != nullptr ? 1.0f : 0.0f;
  const float last_minor = static_cast<float>(s.minors - 1), last_cell = static_cast<float>(s.minors - 2);
  const int major_stride = s.major_stride, minor_stride = s.minor_stride;
  const float xi = s.xi, xi_step = s.xi_step, rise = s.rise, drop = s.drop, eye = s.eye, rim = s.rim;
  const float minor_pad = s.minor_pad, share_pad = s.share_pad, height_pad = s.height_pad, ratio = s.ratio;
  const float uniform = s.uniform, ends = s.ends, least_sigma = s.least_sigma,
              end_zone_sigma = s.end_zone_sigma;
  const float end_zone = s.end_zone_share;
  for (int i = 0; i < kScan; ++i) {
    const float low = smaller(minor_a[i], minor_b[i]), high = larger(minor_a[i], minor_b[i]);
    const float from = larger(smaller(low - minor_pad, last_cell), 0),
                to = larger(smaller(high + minor_pad, last_cell), 0);
    const int a = static_cast<int>(from) >> 2, b = static_cast<int>(to) >> 2, middle = a + 1 < b ? a + 1 : b;
    const int along = i * major_stride;
    const int at_a = along + a * minor_stride, at_middle = along + middle * minor_stride,
              at_b = along + b * minor_stride;
    const float z = larger(larger(highest[at_a], highest[at_middle]), highest[at_b]);
    const float wide = larger(larger(widest[at_a], widest[at_middle]), widest[at_b]);
    const float sigma_most = (widest_counts != 0 ? wide : uniform) + ends;

    const float begin = xi + static_cast<float>(i) * xi_step, end = begin + xi_step;
    const float first = smaller(begin, end) - share_pad, last = larger(begin, end) + share_pad,
                width = last - first;
    const float height_first = first * rise - drop * first * (1 - first),
                height_last = last * rise - drop * last * (1 - last);
    const float line = smaller(height_first, height_last) - drop * width * width / 4;
    const float in_end_zone = smaller(first, 1 - last);
    const float sigma_least = in_end_zone < end_zone ? end_zone_sigma : least_sigma;
    const float needed = ratio * (ratio > 0 ? sigma_most : sigma_least) + height_pad;
    const float clearance = line - (z - eye);
    // Beyond the rim nothing is known; the part before the observer has no say.
    const float inside = smaller(low + rim, last_minor - high + rim);
    const float safe = smaller(clearance - needed, smaller(inside, first));
    matters[i] = safe >= 0 ? 0 : 1;
  }
}

}  // namespace sightbound
