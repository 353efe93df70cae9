// SPDX-License-Identifier: GPL-3.0-or-later
// Method. The line is cut at the columns (rows, when it runs along them) it crosses; a step is the part
// between two of them. Blocks of 2^l steps are bounded by the largest height and sigma of the one to three
// pyramid nodes they touch and skipped when they cannot matter; what is left is judged step by step.
// Notation: m = major, w = minor coordinate from the observer's base sample; s, j = whole ones in the scene's
// grid; xi = share of the major span, t = share of the distance, z = terrain.
//
// Private to sight_line.cpp.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sight/line_objectives.h"
#include "sight/search_kernel.h"
#include "sight/sight_line.h"
#include "sight/stencil.h"

namespace sightbound {

// A line that leaves the raster's rim by less than this follows the rim (the straight line may stand in up to
// there).
inline constexpr double kRim = kFrameTolerance;
// Cells a path may bow within one step to be straight there.
inline constexpr double kStraightStep = 1e-8;
// Cells a path may bow for its chord to bound it well enough.
inline constexpr double kStraightEnough = 0.25;
// A place nearer to an end than this many larger cell sides is the end itself: what is left of the clearance
// there is rounding.
inline constexpr double kAtEnd = 1e-4;
inline constexpr int kScanLevel = MaxPyramid::kFinest + 4;  // its nodes hold kScan of the finest
inline constexpr int kStepLevel = 4;                        // ... and kScan steps
inline constexpr int kFewSteps = 3 * kScan;                 // so few are bounded without looking at nodes
inline constexpr double kScanPad = 1e-3;                    // cells
inline constexpr int kNoStep = std::numeric_limits<int>::min();
inline constexpr std::array kEndPlaces{1.0 / 16, 1.0 / 8, 1.0 / 4, 1.0 / 2,
                                       3.0 / 4};  // larger cell sides from an end

template <class Objective>
class SightLine::Search {
 public:
  Search(const SightLine& line, Objective objective)
      : line_(line),
        scene_(line.scene_),
        objective_(objective),
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

  const Objective& objective() const { return objective_; }
  double critical_xi() const { return critical_xi_; }
  bool hole() const { return hole_; }

  void all(double hint) {
    const MajorRange whole{first_, last_ + 1};
    within({&whole, 1}, hint);
  }

  // First where lines are most often decided: right before the target, and where a neighbour's was.
  void within(std::span<const MajorRange> ranges, double hint) {
    const int target = line_.span_ > 0 ? last_ : first_, before = line_.span_ > 0 ? last_ - 1 : first_ + 1;
    judge_first(target);
    if (!objective_.done() && before >= first_ && before <= last_) judge_first(before);
    if (objective_.done()) return;
    if (hint > 0 && hint < 1) {
      const int near = whole(line_.major0_ + hint * line_.span_) + line_.base_major_;
      judge_first(std::clamp(near, first_, last_));
    }
    if (objective_.done()) return;
    describe_line();
    for (const MajorRange& range : ranges) {
      if (objective_.done()) return;
      from_ = std::max(range.from, first_);
      to_ = std::min(range.to - 1, last_);
      if (to_ - from_ < kFewSteps) {
        steps(from_, to_);
        continue;
      }
      int level = std::min(kScanLevel, scene_.highest.coarsest());
      while (level < scene_.highest.coarsest() && (to_ >> level) - (from_ >> level) > 1) ++level;
      for (int node = from_ >> level; node <= to_ >> level && !objective_.done(); ++node) {
        if ((level == kScanLevel && can_scan()) || !excluded(level, node)) descend(level, node);
      }
    }
    if (!objective_.done()) end_places();
  }

  template <class Visitor>
  void every_place(const Visitor& visit) {
    for (const double f : kEndPlaces) {
      end_place(f, visit);
      end_place(-f, visit);
    }
    for (int s = first_; s <= last_; ++s) step(s, visit);
  }

 private:
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

  // ---- bounding
  // -------------------------------------------------------------------------------------------------

  // A stretch of the line between two majors, and where it runs in between.
  struct Stretch {
    double t_low, t_high;  // shares of the distance
    double w_low, w_high;  // minor coordinates
    double line_low;       // the line stays above
  };
  Stretch stretch(double m_a, double m_b) const {
    const double xi_a = xi_of(m_a), xi_b = xi_of(m_b), width = std::abs(xi_b - xi_a);
    double w_a, w_b, pad;
    if (bow_size_ < kStraightEnough) {  // chord and margin are cheaper than the path itself
      w_a = line_.path_.chord(xi_a);
      w_b = line_.path_.chord(xi_b);
      pad = bow_size_;
    } else {
      w_a = line_.path_.minor(xi_a);
      w_b = line_.path_.minor(xi_b);
      pad = bow_ * width * width / 8;
    }
    const double t_low = std::max(std::min(xi_a, xi_b) - stretch_size_, 0.0),
                 t_high = std::max(xi_a, xi_b) + stretch_size_;
    // The line bulges below its chord by at most drop (share of the distance)^2 / 4.
    const double top = objective_.target_height();
    const double low = std::min(height(t_low, top), height(t_high, top)) -
                       line_.drop_ * (t_high - t_low) * (t_high - t_low) / 4;
    return {t_low, t_high, std::min(w_a, w_b) - pad, std::max(w_a, w_b) + pad, low};
  }

  // Nothing in a stretch whose terrain stays below z matters.
  bool excludes(const Stretch& s, double z, double sigma_max) const {
    if (s.t_low <= 0) return false;
    const bool in_end_zone =
        s.t_low * line_.distance_ < scene_.end_zone_m || (1 - s.t_high) * line_.distance_ < scene_.end_zone_m;
    const double ratio = objective_.ratio();
    const double sigma = ratio > 0 ? sigma_max : in_end_zone ? kLeastSigma : scene_.least_sigma;
    return s.line_low - z >= ratio * sigma + kSlack;
  }

  // ---- sixteen at once
  // -----------------------------------------------------------------------------------------------------

  void describe_line() {
    ScannedLine& s = scanned_;
    s.minor0 = static_cast<float>(line_.path_.chord(0) + line_.base_minor_);
    s.minor_span = static_cast<float>(line_.path_.chord(1) - line_.path_.chord(0));
    s.terms = line_.path_.bow().terms;
    for (std::size_t t = 0; t < s.bow.size(); ++t) s.bow[t] = static_cast<float>(line_.path_.bow().c[t]);
    s.drop = static_cast<float>(line_.drop_);
    s.eye = static_cast<float>(line_.eye_height_);
    s.share_pad = static_cast<float>(stretch_size_ + 1e-6);
    s.minors = line_.minors_;
    s.rim = static_cast<float>(kRim - float_pad());
    s.uniform = static_cast<float>(scene_.least_sigma);
    s.ends = static_cast<float>(ends_most());
    s.least_sigma = static_cast<float>(scene_.least_sigma);
    s.end_zone_sigma = static_cast<float>(kLeastSigma);
    s.end_zone_share = static_cast<float>(scene_.end_zone_m / line_.distance_ + 1e-6);
  }
  // Heights change with the target's.
  const ScannedLine& scanned() {
    scanned_.rise = static_cast<float>(objective_.target_height() - line_.eye_height_);
    scanned_.height_pad = static_cast<float>(
        1e-3 + 1e-6 * (std::abs(scanned_.rise) + scanned_.drop + std::abs(scanned_.eye) + 1e4));
    return scanned_;
  }
  // Cells that float arithmetic may have a minor coordinate wrong by.
  double float_pad() const { return 4e-7 * (line_.minors_ + 4 * bow_size_) + kScanPad; }
  double minor_pad(double xi_step) const { return bow_ * xi_step * xi_step / 8 + float_pad(); }
  double ends_most() const {
    return scene_.ends_move ? std::max(line_.eye_sampling_, line_.target_sampling_) : 0;
  }

  // Sixteen finest nodes, from `first` on. Holes need the nodes one by one.
  bool can_scan() const { return !scene_.highest.any_hole() || scene_.see_across_nodata; }
  void scan(int first) {
    const Grid<float>& finest = scene_.highest.finest();
    const double step = (1 << MaxPyramid::kFinest) * per_span_;
    const std::size_t at =
        static_cast<std::size_t>(first) * static_cast<std::size_t>(line_.transposed_ ? finest.cols() : 1);
    NodeScan s;
    s.highest = finest.data() + at;
    s.widest = scene_.uniform ? nullptr : scene_.widest.finest().data() + at;
    s.major_stride = line_.transposed_ ? finest.cols() : 1;
    s.minor_stride = line_.transposed_ ? 1 : finest.cols();
    s.xi = static_cast<float>(xi_of(m_of(first << MaxPyramid::kFinest)));
    s.xi_step = static_cast<float>(step);
    s.minor_pad = static_cast<float>(minor_pad(step));
    s.ratio = static_cast<float>(objective_.ratio());
    scan_nodes(scanned(), s, matters_.data());
  }

  // From the observer and from the target in turn.
  void scan_end_places() {
    PlaceScan s;
    s.heights = scene_.heights.data();
    s.major_stride = static_cast<int>(line_.major_stride_);
    s.minor_stride = static_cast<int>(line_.minor_stride_);
    s.majors = line_.majors_;
    s.major0 = static_cast<float>(line_.major0_ + line_.base_major_);
    s.major_span = static_cast<float>(line_.span_);
    s.pad = static_cast<float>(float_pad() + 4e-7 * line_.majors_ + bow_size_ * 1e-6 +
                               scanned_.share_pad * std::abs(line_.span_));
    const double cell = scene_.error.larger_side_m / line_.distance_;
    for (std::size_t i = 0; i < kEndPlaces.size(); ++i) {
      s.shares[2 * i] = static_cast<float>(kEndPlaces[i] * cell);
      s.shares[2 * i + 1] = static_cast<float>(1 - kEndPlaces[i] * cell);
    }
    const double ratio = objective_.ratio();
    s.clearance = static_cast<float>(ratio * (ratio > 0 ? scene_.most_between() + ends_most() : kLeastSigma));
    scan_places(scanned(), s, matters_.data());
  }

  // Steps [from, to], the most promising of sixteen first.
  void steps(int from, int to) {
    for (int first = from; first <= to && !objective_.done(); first += kScan) {
      const int count = std::min(kScan, to - first + 1);
      if (first > line_.majors_ - 2) {  // beyond the last column
        step(first);
        continue;
      }
      bound(first);
      for (const int known : judged_) {
        if (known >= first && known < first + count)
          ratios_[static_cast<std::size_t>(known - first)] = kNoRatio;
      }
      while (!objective_.done()) {
        const auto end = ratios_.begin() + count, best = std::min_element(ratios_.begin(), end);
        if (static_cast<double>(*best) >= objective_.ratio()) break;
        *best = kNoRatio;
        step(first + static_cast<int>(best - ratios_.begin()));
      }
    }
  }
  void bound(int first) {
    StepScan s;
    s.heights = scene_.heights.data() + sample(first, 0);
    s.major_stride = static_cast<int>(line_.major_stride_);
    s.minor_stride = static_cast<int>(line_.minor_stride_);
    s.steps = line_.majors_ - 1 - first;
    if (!scene_.uniform) {
      const Grid<float>& finest = scene_.widest.finest();
      s.widest_major_stride = line_.transposed_ ? finest.cols() : 1;
      s.widest_minor_stride = line_.transposed_ ? 1 : finest.cols();
      s.widest =
          finest.data() + static_cast<std::ptrdiff_t>(first >> MaxPyramid::kFinest) * s.widest_major_stride;
    }
    s.first = first;
    s.xi = static_cast<float>(xi_of(m_of(first)));
    s.xi_step = static_cast<float>(per_span_);
    s.minor_pad = static_cast<float>(minor_pad(per_span_));
    bound_steps(scanned(), s, ratios_.data());
  }

  bool excluded(int level, int node) {
    const Stretch part = stretch(std::max(low_, m_of(std::max(node << level, from_))),
                                 std::min(high_, m_of(std::min((node + 1) << level, to_ + 1))));
    const int a = cell_of(part.w_low) >> level, b = cell_of(part.w_high) >> level;
    bool unknown = is_outside(part.w_low) || is_outside(part.w_high);
    float z = std::numeric_limits<float>::lowest(), sigma = 0;
    for (int minor = a; minor <= b; ++minor) {
      const int row = line_.transposed_ ? node : minor, col = line_.transposed_ ? minor : node;
      z = std::max(z, scene_.highest.max(level, row, col));
      if (!scene_.uniform) sigma = std::max(sigma, scene_.widest.max(level, row, col));
      unknown = unknown || scene_.highest.has_hole(level, row, col);
    }
    if (unknown && !scene_.see_across_nodata && objective_.unknown_matters()) {
      return false;
    }
    const double most = (scene_.uniform ? scene_.least_sigma : static_cast<double>(sigma)) + ends_most();
    return excludes(part, static_cast<double>(z), most);
  }

  void descend(int level, int node) {
    if (objective_.done()) return;
    if (level <= kStepLevel) {
      steps(std::max(from_, node << level), std::min(to_, ((node + 1) << level) - 1));
      return;
    }
    const int nodes = scene_.highest.finest_nodes(line_.transposed_);
    if (level == kScanLevel && can_scan() && nodes >= kScan) {
      const int first = std::min(node * kScan, nodes - kScan);
      scan(first);
      // Four nodes make sixteen steps.
      for (int group = 0; group < kScan && !objective_.done(); group += 4) {
        const int begin = line_.span_ > 0 ? kScan - 4 - group : group;
        int low = begin, high = begin + 3;
        while (low <= high && matters_[static_cast<std::size_t>(low)] == 0) ++low;
        while (high >= low && matters_[static_cast<std::size_t>(high)] == 0) --high;
        const int from = std::max({from_, node << level, (first + low) << MaxPyramid::kFinest});
        if (low <= high) {
          steps(from,
                std::min({to_, ((node + 1) << level) - 1, ((first + high + 1) << MaxPyramid::kFinest) - 1}));
        }
      }
      return;
    }
    // The end nearer to the target first: on rising ground it decides more often.
    const int child = line_.span_ > 0 ? 2 * node + 1 : 2 * node;
    for (const int c : {child, 4 * node + 1 - child}) {
      if (c < (from_ >> (level - 1)) || c > (to_ >> (level - 1))) continue;
      if (!excluded(level - 1, c)) descend(level - 1, c);
    }
  }

  // ---- places
  // ---------------------------------------------------------------------------------------------------

  double height(double t) const { return height(t, line_.target_height_); }
  double height(double t, double target) const {
    return line_.eye_height_ + t * (target - line_.eye_height_) - line_.drop_ * t * (1 - t);
  }

  void judge_first(int s) {
    for (int& known : judged_) {
      if (known == s) return;
      if (known != kNoStep) continue;
      known = s;
      return step(s);
    }
  }
  void step(int s) {
    step(s, [this](const Stencil& stencil, bool outside, double d, double xi) {
      judge(stencil, outside, d, xi);
    });
  }
  void end_places() {
    const auto visit = [this](const Stencil& stencil, bool outside, double d, double xi) {
      judge(stencil, outside, d, xi);
    };
    scan_end_places();
    for (std::size_t i = 0; i < kEndPlaces.size(); ++i) {
      if (matters_[2 * i] != 0) end_place(kEndPlaces[i], visit);
      if (matters_[2 * i + 1] != 0) end_place(-kEndPlaces[i], visit);
    }
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

 public:
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

 private:
  void judge(const Stencil& stencil, bool outside, double d, double xi) {
    const double t = line_.path_.share(xi);
    if (!is_between(t)) return;
    const double z = outside ? std::numeric_limits<double>::quiet_NaN() : stencil.of(scene_.heights.data());
    if (std::isnan(z)) {
      Stencil whole = stencil;
      if (!outside && whole.give_up_slivers(scene_.heights.data())) return judge(whole, false, d, xi);
      if (!scene_.see_across_nodata && objective_.take_unknown()) {
        critical_xi_ = xi;
        hole_ = true;
      }
      return;
    }
    const double clearance = height(t) - z;
    if (objective_.take(t, clearance, sigma(stencil, d, t) + moving_ends(t))) {
      critical_xi_ = xi;
      hole_ = false;
    }
  }

  const SightLine& line_;
  const Scene& scene_;
  Objective objective_;
  double bow_, bow_size_, stretch_size_;
  bool curved_;
  ScannedLine scanned_;
  std::array<std::int32_t, kScan> matters_{};
  std::array<float, kScan> ratios_{};
  std::array<int, 3> judged_{kNoStep, kNoStep, kNoStep};  // steps judged before all others
  double low_, high_, per_span_;
  double at_end_;          // share of the distance
  int first_, last_;       // steps of the line, in the scene's grid
  int from_ = 0, to_ = 0;  // those being searched
  double critical_xi_ = -1;
  bool hole_ = false;
};

}  // namespace sightbound
