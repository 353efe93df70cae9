// SPDX-License-Identifier: GPL-3.0-or-later
// Method. Blocks of 2^l steps are bounded by the largest height and sigma of the one to three pyramid nodes
// they touch and skipped when they cannot matter; sixteen steps at once are bounded by their own crossings,
// and the most promising ones are judged place by place. Notation: line_places.h.
//
// Private to sight_line.cpp.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sight/line_objectives.h"
#include "sight/line_places.h"
#include "sight/search_kernel.h"

namespace sightbound {

// Cells a path may bow for its chord to bound it well enough.
inline constexpr double kStraightEnough = 0.25;
inline constexpr int kScanLevel = MaxPyramid::kFinest + 4;  // its nodes hold kScan of the finest
inline constexpr int kStepLevel = 4;                        // ... and kScan steps
inline constexpr int kFewSteps = 3 * kScan;                 // so few are bounded without looking at nodes
inline constexpr double kScanPad = 1e-3;                    // cells
inline constexpr int kNoStep = std::numeric_limits<int>::min();

template <class Objective>
class SightLine::Search : public SightLine::Places {
 public:
  Search(const SightLine& line, Objective objective) : Places(line), objective_(objective) {}

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

 private:
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
  // ---- judging
  // --------------------------------------------------------------------------------------------------

  void judge_first(int s) {
    for (int& known : judged_) {
      if (known == s) return;
      if (known != kNoStep) continue;
      known = s;
      return step(s);
    }
  }
  using Places::step;
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
  Objective objective_;
  ScannedLine scanned_;
  std::array<std::int32_t, kScan> matters_{};
  std::array<float, kScan> ratios_{};
  std::array<int, 3> judged_{kNoStep, kNoStep, kNoStep};  // steps judged before all others
  int from_ = 0, to_ = 0;                                 // those being searched
  double critical_xi_ = -1;
  bool hole_ = false;
};

}  // namespace sightbound
