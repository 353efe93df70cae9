// SPDX-License-Identifier: GPL-3.0-or-later
//   z        height of the moving vertex p
//   d        original height less what the new surface would have with p at the height of a known vertex
//   w        weight of p at the place: the new height changes by w for each metre of z
//   d - E <= w (z - known) <= d + E
#include "simplify/envelope.h"

#include <cmath>
#include <limits>

namespace sightbound {

namespace {
constexpr double kImpossible = std::numeric_limits<double>::infinity();
}  // namespace

Envelope::Envelope(const Original& original) : original_(original), margin_(original.margin()) {}

HeightInterval Envelope::heights_for(const EdgeStar& star, const Point& p, double most) const {
  const int end = star.sides();
  return original_.varying() ? find<true>(star, p, 0, end, most) : find<false>(star, p, 0, end, most);
}

HeightInterval Envelope::heights_at_a(const EdgeStar& star, double most) const {
  const Point& a = star.place_a;
  return original_.varying() ? find<true>(star, a, star.b_begin, star.b_end, most)
                             : find<false>(star, a, star.b_begin, star.b_end, most);
}

template <bool kVarying>
HeightInterval Envelope::find(const EdgeStar& star, const Point& p, int begin, int end, double most) const {
  const Original::Local here = original_.under<kVarying>(p);
  // Where an outline has advanced there may be nothing to compare with: no vertex goes there.
  if (std::isnan(here.height)) return {kImpossible, -kImpossible};
  HeightInterval z{here.height - here.tolerance + margin_, here.height + here.tolerance - margin_};
  for (int i = begin; i < end && z.missing() <= most; ++i) {
    const auto n = static_cast<std::size_t>(i);
    narrow_inside<kVarying>(star.at[n], star.at[n + 1], p, most, z);
  }
  // A closed ring's last place is its first.
  const int last = star.closed && end - begin == star.size ? end - 1 : end;
  for (int i = begin; i <= last && z.missing() <= most; ++i) {
    narrow_along<kVarying>(star.at[static_cast<std::size_t>(i)], p, z);
  }
  return z;
}

// The edge from v, which stays, to p. A NaN narrows nothing.
template <bool kVarying>
void Envelope::narrow_along(const Point& v, const Point& p, HeightInterval& z) const {
  double low = z.low - v.z, high = z.high - v.z;
  original_.for_crossings<kVarying>(v, p, [&](const Original::Local& here, double t) {
    const double d = here.height - v.z, allowed = here.tolerance - margin_;
    if (d - allowed > t * low) low = (d - allowed) / t;
    if (d + allowed < t * high) high = (d + allowed) / t;
  });
  z = {low + v.z, high + v.z};
}

// Samples in the triangle a, b, p, its edge a b excepted. At a sample s: e = area (a, b, s) and f = area (p,
// a, s), doubled; e / area is the weight of p, f / area that of b. All three are exact.
template <bool kVarying>
void Envelope::narrow_inside(const Point& a, const Point& b, const Point& p, double most,
                             HeightInterval& z) const {
  const double area = area2(a, b, p), per_area = 1 / area, rise = (b.z - a.z) * per_area;
  const double ex = a.y - b.y, ey = b.x - a.x, fx = p.y - a.y, fy = a.x - p.x;
  double low = (z.low - a.z) * per_area, high = (z.high - a.z) * per_area;  // per unit of e
  const int first_col = original_.first_col();
  bool all_seen = true;
  Original::for_samples(a, b, p, [&](int row, int begin, int end) {
    const float* height = original_.heights(row);
    const float* tolerance = kVarying ? original_.tolerances(row) : nullptr;
    const double e_row = ey * (row - a.y), f_row = fy * (row - a.y);
    for (int x = begin; x < end; ++x) {
      const double e = e_row + ex * (x - a.x), f = f_row + fx * (x - a.x);
      if (e <= 0) continue;
      const int n = x - first_col;
      const double d = height[n] - a.z - rise * f;
      const double allowed = (kVarying ? tolerance[n] : original_.constant()) - margin_;
      if (d - allowed > e * low) low = (d - allowed) / e;
      if (d + allowed < e * high) high = (d + allowed) / e;
    }
    all_seen = low - high <= most * per_area;
    return all_seen;
  });
  z = {a.z + low * area, a.z + high * area};
  // What was not looked at must not pass by a rounding.
  if (!all_seen && z.missing() <= most) z = {kImpossible, -kImpossible};
}

namespace {

template <bool kVarying>
Deviation largest(const Original& original, const std::array<Point, 3>& corner) {
  Deviation found;
  const auto add = [&](const Original::Local& here, double height) {
    double off = std::abs(height - here.height);
    if (here.tolerance == 0 && off <= original.rounding()) {  // the surface is the original's
      found.metres = std::max(found.metres, original.written());
      return;
    }
    // The envelope was shrunk by the rounding: within it, nothing exceeds the tolerance.
    const bool judged = here.tolerance >= original.margin(), within = off <= here.tolerance;
    off += original.rounding();
    if (judged && within) off = std::min(off, here.tolerance);
    found.metres = std::max(found.metres, off);
    if (judged || !within) found.ratio = std::max(found.ratio, off / here.tolerance);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const Point &a = corner[i], &b = corner[(i + 1) % 3];
    add(original.under<kVarying>(a), a.z);
    original.for_crossings<kVarying>(
        a, b, [&](const Original::Local& here, double t) { add(here, a.z + t * (b.z - a.z)); });
  }
  const Point &a = corner[0], &b = corner[1], &c = corner[2];
  const double area = area2(a, b, c);
  Original::for_samples(a, b, c, [&](int row, int begin, int end) {
    for (int x = begin; x < end; ++x) {
      const Point s{static_cast<double>(x), static_cast<double>(row), 0};
      const double at_b = area2(a, s, c) / area, at_c = area2(a, b, s) / area;
      add(original.between<kVarying>(row, x, row, x, 0), a.z + at_b * (b.z - a.z) + at_c * (c.z - a.z));
    }
    return true;
  });
  return found;
}

}  // namespace

Deviation deviation_of(const Original& original, const Point& a, const Point& b, const Point& c) {
  return original.varying() ? largest<true>(original, {a, b, c}) : largest<false>(original, {a, b, c});
}

}  // namespace sightbound
