// SPDX-License-Identifier: GPL-3.0-or-later
// The judged places of a sight line: where it crosses columns, rows and diagonals of the terrain, and those
// close to its ends. Notation: a step is the part of the line between two columns (rows, when it runs along
// them) it crosses; m = major, w = minor coordinate from the observer's base sample; s, j = whole ones in the
// scene's grid; xi = share of the major span, t = share of the distance, z = terrain.
//
// Private to sight_line.cpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "sight/line_ends.h"
#include "sight/sight_line.h"
#include "sight/stencil.h"

namespace sightbound {

// A line that leaves the raster's rim by less than this follows the rim (the straight line may stand in up to
// there).
inline constexpr double kRim = kFrameTolerance;
// Cells a path may bow within one step to be straight there.
inline constexpr double kStraightStep = 1e-8;

class SightLine::Places {
 public:
  explicit Places(const SightLine& line)
      : line_(line),
        scene_(line.scene_),
        bow_(line.path_.bow_bound()),
        bow_size_(line.path_.largest_bow()),
        stretch_size_(line.path_.largest_stretch()) {
    const double end = line.major0_ + line.span_;
    per_span_ = 1 / line.span_;
    low_ = std::min(line.major0_, end);
    high_ = std::max(line.major0_, end);
    first_ = static_cast<int>(std::floor(low_)) + line.base_major_;
    last_ = std::max(first_, static_cast<int>(std::ceil(high_)) - 1 + line.base_major_);
    curved_ = bow_ * per_span_ * per_span_ / 8 > kStraightStep;
    at_end_ = kAtEnd * scene_.error.larger_side_m / line.distance_;
  }

  // Is a place at this share of the distance strictly between the ends?
  bool is_between(double t) const { return t > at_end_ && t < 1 - at_end_; }
  // Calls visit(stencil, outside, d, xi) for all of them, d = distance to the nearest sample, metres.
  template <class Visitor>
  void every_place(const Visitor& visit) {
    for (const double f : kEndPlaces) {
      end_place(f, visit);
      end_place(-f, visit);
    }
    for (int s = first_; s <= last_; ++s) step(s, visit);
  }
  // sigma a place is judged with, without the part of moving ends.
  double sigma(const Stencil& stencil, double d, double t) const {
    const bool end_zone =
        t * line_.distance_ < scene_.end_zone_m || (1 - t) * line_.distance_ < scene_.end_zone_m;
    if (scene_.uniform) return end_zone ? kLeastSigma : scene_.least_sigma;
    const double amplitude = stencil.of(scene_.error.amplitude);
    const double between = amplitude > 0 ? amplitude * scene_.error.profile(d, amplitude) : 0;
    return std::max((end_zone ? 0 : stencil.of(scene_.error.sampling)) + between, kLeastSigma);
  }

  double moving_ends(double t) const {
    return scene_.ends_move ? (1 - t) * line_.eye_sampling_ + t * line_.target_sampling_ : 0;
  }

  JudgedPlace described(Stencil stencil, bool outside, double d, double xi) const {
    JudgedPlace place;
    outside = outside || !stencil.give_up_slivers(scene_.heights.data());
    place.xi = xi;
    place.share = line_.path_.share(xi);
    place.line = height(place.share);
    place.ground = outside ? std::numeric_limits<double>::quiet_NaN() : stencil.of(scene_.heights.data());
    place.sigma =
        std::isnan(place.ground) ? place.ground : sigma(stencil, d, place.share) + moving_ends(place.share);
    return place;
  }

 protected:
  double xi_of(double m) const { return (m - line_.major0_) * per_span_; }
  double m_of(int s) const { return s - line_.base_major_; }
  // A place this far out has no terrain; up to kRim it follows the rim.
  bool is_outside(double w) const {
    return w < -kRim - line_.base_minor_ || w > line_.minors_ - 1 - line_.base_minor_ + kRim;
  }
  double inside(double w) const {
    return std::clamp(w, -static_cast<double>(line_.base_minor_),
                      static_cast<double>(line_.minors_ - 1 - line_.base_minor_));
  }
  // The cell that holds w, in the scene's grid.
  int cell_of(double w) const { return std::clamp(whole(w) + line_.base_minor_, 0, line_.minors_ - 2); }
  double height(double t) const { return height(t, line_.target_height_); }
  double height(double t, double target) const {
    return line_.eye_height_ + t * (target - line_.eye_height_) - line_.drop_ * t * (1 - t);
  }
  // All crossings in (s, s + 1] between the ends.
  template <class Visitor>
  void step(int s, const Visitor& visit) {
    const double m_a = std::max(low_, m_of(s)), m_b = std::min(high_, m_of(s + 1));
    const double w_a = line_.path_.minor(xi_of(m_a)), w_b = line_.path_.minor(xi_of(m_b));
    if (m_of(s + 1) < high_) column(s + 1, w_b, visit);
    if (m_b <= m_a) return;
    // Rows: w = whole number; diagonals: w - m = whole number.
    for (const bool diagonal : {false, true}) {
      const double g_a = diagonal ? w_a - m_a : w_a, g_b = diagonal ? w_b - m_b : w_b;
      const double g_low = std::min(g_a, g_b), g_high = std::max(g_a, g_b);
      for (double g = whole(g_low) + 1; g < g_high; ++g) {
        double m = m_a + (g - g_a) / (g_b - g_a) * (m_b - m_a);
        if (curved_) {  // one Newton step from the chord of the step
          const double slope = line_.path_.minor_slope(xi_of(m)) / line_.span_ - (diagonal ? 1 : 0);
          const double value = line_.path_.minor(xi_of(m)) - (diagonal ? m : 0);
          const double better = m + (g - value) / slope;
          if (better > m_a && better < m_b) m = better;
        }
        const int j = static_cast<int>(diagonal ? g + m_of(s) : g) + line_.base_minor_;
        crossing(s, j, m - m_of(s), diagonal, xi_of(m), visit);
      }
    }
  }

  template <class Visitor>
  void column(int s, double w, const Visitor& visit) {
    const int j = cell_of(w);
    const double f = inside(w) - (j - line_.base_minor_);
    visit(Stencil::edge(sample(s, j), sample(s, j + 1), f), is_outside(w),
          spacing(s, j, 0, std::min(f, 1 - f)), xi_of(m_of(s)));
  }

  // Where the line meets the edge from sample (s, j) to (s + 1, j), or to (s + 1, j + 1), a share f along it.
  template <class Visitor>
  void crossing(int s, int j, double f, bool diagonal, double xi, const Visitor& visit) {
    const int next = j + (diagonal ? 1 : 0);
    const bool before = j >= 0, beyond = next <= line_.minors_ - 1;  // which ends of the edge have a sample
    // A line that follows the rim from without meets the diagonals there at their one sample.
    const bool outside = !(before || f >= 1 - kRim) || !(beyond || f <= kRim);
    Stencil stencil;
    if (!outside)
      stencil = Stencil::edge(before ? sample(s, j) : sample(s + 1, next),
                              beyond ? sample(s + 1, next) : sample(s, j), f);
    const double nearest = std::min(f, 1 - f);
    visit(stencil, outside, outside ? 0 : spacing(s, std::max(j, 0), nearest, diagonal ? nearest : 0), xi);
  }

  // f > 0: larger cell sides from the observer; f < 0: from the target.
  template <class Visitor>
  void end_place(double f, const Visitor& visit) {
    const double from_end = std::abs(f) * scene_.error.larger_side_m;
    if (from_end >= line_.distance_) return;
    const double t = f > 0 ? from_end / line_.distance_ : 1 - from_end / line_.distance_;
    double xi = t;
    if (stretch_size_ > 0) {
      for (int i = 0; i < 3; ++i)
        xi -= line_.path_.share(xi) - t;  // the share differs from xi by little, and smoothly
    }
    const double m = line_.major0_ + xi * line_.span_, w = line_.path_.minor(xi);
    const int i = std::clamp(whole(m) + line_.base_major_, 0, line_.majors_ - 2), j = cell_of(w);
    const double fm = std::clamp(m - m_of(i), 0.0, 1.0), fw = inside(w) - (j - line_.base_minor_);
    const std::ptrdiff_t corner = fm >= fw ? sample(i + 1, j) : sample(i, j + 1);
    const Stencil stencil = Stencil::triangle({sample(i, j), corner, sample(i + 1, j + 1)},
                                              {1 - std::max(fm, fw), std::abs(fm - fw), std::min(fm, fw)});
    visit(stencil, is_outside(w), spacing(i, j, std::min(fm, 1 - fm), std::min(fw, 1 - fw)), xi);
  }

  std::ptrdiff_t sample(int major, int minor) const {
    return major * line_.major_stride_ + minor * line_.minor_stride_;
  }

  // Ground distance to the nearest sample, metres, of a place `f_major`, `f_minor` cells from it.
  double spacing(int major, int minor, double f_major, double f_minor) const {
    if (scene_.uniform) return 0;
    const CellSize& cell =
        scene_.error.cell_sizes[static_cast<std::size_t>(line_.transposed_ ? major : minor)];
    const double a = f_major * (line_.transposed_ ? cell.row_m : cell.col_m);
    const double b = f_minor * (line_.transposed_ ? cell.col_m : cell.row_m);
    return std::sqrt(a * a + b * b);
  }
  const SightLine& line_;
  const Scene& scene_;
  double bow_, bow_size_, stretch_size_;  // cells, cells, shares of the distance
  bool curved_;
  double low_, high_, per_span_;
  double at_end_;     // share of the distance
  int first_, last_;  // steps of the line, in the scene's grid
};

}  // namespace sightbound
