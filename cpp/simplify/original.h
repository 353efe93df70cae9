// SPDX-License-Identifier: GPL-3.0-or-later
// The original surface with the tolerance at each place, and the corners of its overlay with new triangles.
//
// Columns and rows are coordinates; the original is linear on triangles NW, NE, SE and NW, SE, SW of each
// square of samples, and so is the tolerance.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "simplify/edge_star.h"
#include "terrain/grid.h"

namespace sightbound {

class Original {
 public:
  struct Local {
    double height, tolerance;
  };

  // Of a window of the DEM, for places in it: `tolerance` of each sample, or empty for the constant. The
  // grids are the window's and must outlive this. `place_rounding`: place_rounding.h.
  Original(const Grid<float>& heights, const Grid<float>& tolerance, double constant, const Window& window,
           double place_rounding);

  bool varying() const { return !tolerance_.empty(); }
  double constant() const { return constant_; }
  // Of a row, from first_col() on.
  const float* heights(int row) const { return heights_.row(row - window_.row); }
  const float* tolerances(int row) const { return tolerance_.row(row - window_.row); }
  int first_col() const { return window_.col; }
  // What rounding may add to a deviation, in metres: in all, and by places as written in a CRS alone.
  double rounding() const { return rounding_; }
  double written() const { return written_; }
  // Taken off the tolerance: once for the test, once for whoever checks it. Where a tolerance is less,
  // nothing but what is coplanar goes.
  double margin() const { return 2 * rounding_; }

  // On the edge from one sample to another.
  template <bool kVarying>
  Local between(int r0, int c0, int r1, int c1, double part) const {
    const double h0 = height_at(r0, c0), h1 = height_at(r1, c1);
    Local found{h0 + part * (h1 - h0), constant_};
    if constexpr (kVarying) {
      const double e0 = tolerance_at(r0, c0), e1 = tolerance_at(r1, c1);
      found.tolerance = e0 + part * (e1 - e0);
    }
    return found;
  }
  // At the sample nearest to a place, but not 0.
  double tolerance_near(const Point& p) const {
    constexpr double kLeast = 1e-9;
    const double here =
        varying() ? tolerance_at(static_cast<int>(p.y + 0.5), static_cast<int>(p.x + 0.5)) : constant_;
    return here > kLeast ? here : kLeast;
  }
  // Anywhere in the footprint: samples that do not matter may be nodata.
  template <bool kVarying>
  Local under(const Point& p) const;
  double tolerance_under(const Point& p) const { return varying() ? under<true>(p).tolerance : constant_; }

  // f(local, t) where the line from a to b crosses columns, rows and diagonals, t between 0 at a and 1 at b.
  // Along the outline a crossing at a sample may be rounded towards nodata and be NaN: such samples are on
  // the line, and for_samples() has them.
  template <bool kVarying, class F>
  void for_crossings(const Point& a, const Point& b, const F& f) const;

  // f(row, begin, end) for the samples in the closed triangle, row by row, columns [begin, end); those at its
  // corners may be left out.
  template <class F>
  static void for_samples(const Point& a, const Point& b, const Point& c, const F& f);

 private:
  // Samples this far outside a triangle are counted as in it: none on its edges is lost to rounding.
  static constexpr double kSampleReach = 0x1p-30;  // cells
  // Of what is 0 or more, or less than one step below: columns and rows.
  static int whole_from(double x) {
    const int whole = static_cast<int>(x);
    return whole + (whole < x ? 1 : 0);
  }
  static int whole_above(double x) { return static_cast<int>(x) + 1; }

  double height_at(int row, int col) const { return heights_.at(row - window_.row, col - window_.col); }
  double tolerance_at(int row, int col) const { return tolerance_.at(row - window_.row, col - window_.col); }

  const Grid<float>& heights_;
  const Grid<float>& tolerance_;
  double constant_, rounding_, written_;
  Window window_;
};

template <bool kVarying>
Original::Local Original::under(const Point& p) const {
  const int c = static_cast<int>(p.x), r = static_cast<int>(p.y);
  const double u = p.x - c, v = p.y - r;
  if (u == 0 && v == 0) return between<kVarying>(r, c, r, c, 0);
  if (u == 0) return between<kVarying>(r, c, r + 1, c, v);
  if (v == 0) return between<kVarying>(r, c, r, c + 1, u);
  if (u == v) return between<kVarying>(r, c, r + 1, c + 1, u);
  const double least = std::min(u, v), most = std::max(u, v);
  const Local nw = between<kVarying>(r, c, r, c, 0), se = between<kVarying>(r + 1, c + 1, r + 1, c + 1, 0);
  const Local side =
      u > v ? between<kVarying>(r, c + 1, r, c + 1, 0) : between<kVarying>(r + 1, c, r + 1, c, 0);
  const auto mix = [&](double at_nw, double at_side, double at_se) {
    return (1 - most) * at_nw + (most - least) * at_side + least * at_se;
  };
  return {mix(nw.height, side.height, se.height), mix(nw.tolerance, side.tolerance, se.tolerance)};
}

template <bool kVarying, class F>
void Original::for_crossings(const Point& a, const Point& b, const F& f) const {
  const double dx = b.x - a.x, dy = b.y - a.y;
  // Rounding must not lead out of the window.
  const int first_row = window_.row, last_row = window_.row_end() - 2;
  const int first_col = window_.col, last_col = window_.col_end() - 2;
  if (dx != 0) {
    const double step = 1 / dx;
    const double end = std::max(a.x, b.x);
    for (int c = whole_above(std::min(a.x, b.x)); c < end; ++c) {
      const double t = (c - a.x) * step, y = a.y + t * dy;
      const int r = std::clamp(static_cast<int>(y), first_row, last_row);
      f(between<kVarying>(r, c, r + 1, c, y - r), t);
    }
  }
  if (dy != 0) {
    const double step = 1 / dy;
    const double end = std::max(a.y, b.y);
    for (int r = whole_above(std::min(a.y, b.y)); r < end; ++r) {
      const double t = (r - a.y) * step, x = a.x + t * dx;
      const int c = std::clamp(static_cast<int>(x), first_col, last_col);
      f(between<kVarying>(r, c, r, c + 1, x - c), t);
    }
  }
  const double before = a.y - a.x, after = b.y - b.x;  // of diagonals: row less column
  if (before != after) {
    const double step = 1 / (after - before);
    const double end = std::max(before, after);
    for (int down = static_cast<int>(std::floor(std::min(before, after))) + 1; down < end; ++down) {
      const double t = (down - before) * step, x = a.x + t * dx;
      const int c = std::clamp(static_cast<int>(x), std::max(first_col, first_row - down),
                               std::min(last_col, last_row - down));
      f(between<kVarying>(c + down, c, c + down + 1, c + 1, x - c), t);
    }
  }
}

template <class F>
void Original::for_samples(const Point& a, const Point& b, const Point& c, const F& f) {
  const Point *top = &a, *middle = &b, *bottom = &c;
  if (middle->y < top->y) std::swap(middle, top);
  if (bottom->y < middle->y) std::swap(bottom, middle);
  if (middle->y < top->y) std::swap(middle, top);
  const int first = top->y < middle->y ? whole_above(top->y) : whole_from(top->y);
  const int last = middle->y < bottom->y ? whole_from(bottom->y) - 1 : static_cast<int>(bottom->y);
  if (first > last) return;
  const auto slope = [](const Point& s, const Point& t) {
    return t.y > s.y ? (t.x - s.x) / (t.y - s.y) : 0.0;
  };
  const double along = slope(*top, *bottom), upper = slope(*top, *middle), lower = slope(*middle, *bottom);
  for (int y = first; y <= last; ++y) {
    const double one = top->x + (y - top->y) * along;
    const double other = y < middle->y ? top->x + (y - top->y) * upper : middle->x + (y - middle->y) * lower;
    const int begin = whole_from(std::min(one, other) - kSampleReach);
    const int end = static_cast<int>(std::max(one, other) + kSampleReach) + 1;
    if (begin < end && !f(y, begin, end)) return;
  }
}

}  // namespace sightbound
