// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/viewshed.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace sightbound {

namespace {
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
}

inline void Canvas::put(int row, int col, float p, std::uint8_t claim) {
  const int r = row - window_.row, c = col - window_.col;
  if (fresh_) {
    confidence.at(r, c) = p;
    verdict.at(r, c) = claim;
    if (!count.empty()) count.at(r, c) = claim == kVisible;
    return;
  }
  float& p_before = confidence.at(r, c);
  std::uint8_t& claim_before = verdict.at(r, c);
  if (claim_before == kNoVerdict || (best_ ? p > p_before : p < p_before)) p_before = p;
  if (claim_before == kNoVerdict || (best_ ? claim > claim_before : claim < claim_before))
    claim_before = claim;
  if (count.empty()) return;
  std::uint32_t& n = count.at(r, c);
  if (n == kNoCount) n = 0;
  if (claim == kVisible) ++n;
}

void Canvas::hide(int row, int col, int run, bool along_row) {
  if (!fresh_ || !count.empty()) {
    for (int i = 0; i < run; ++i) put(along_row ? row : row + i, along_row ? col + i : col, 0, kHidden);
    return;
  }
  if (start_ == CanvasStart::kAllHidden) return;
  float* p = &confidence.at(row - window_.row, col - window_.col);
  std::uint8_t* claim = &verdict.at(row - window_.row, col - window_.col);
  if (along_row) {
    std::fill_n(p, run, 0.0f);
    std::fill_n(claim, run, kHidden);
    return;
  }
  for (int i = 0; i < run; ++i, p += window_.cols, claim += window_.cols) {
    *p = 0;
    *claim = kHidden;
  }
}

void Canvas::leave(int row, int col) {
  if (!fresh_ || start_ == CanvasStart::kNobodyAsked) return;
  confidence.at(row - window_.row, col - window_.col) = kNan;
  verdict.at(row - window_.row, col - window_.col) = kNoVerdict;
}

namespace {

// What one block of the fan does with its targets.
class Painter {
 public:
  Painter(const View& view, Canvas& canvas, Progress& progress)
      : view_(view), scene_(view.scene), canvas_(canvas), progress_(progress) {}

  const ViewTotals& totals() const { return totals_; }

  void paint(const FanColumn& column, const WedgeFan::OpenPartsOf& open_parts) {
    const ViewLimits& limits = view_.limits;
    const bool by_place = column.least_distance < limits.min_distance ||
                          column.most_distance > limits.max_distance || !limits.all_azimuths() ||
                          !limits.all_angles();
    const bool plain = !by_place && !canvas_.has_heights();  // hidden is all there is to say of most
    // The part on the canvas.
    const Window& window = canvas_.window();
    const int first = column.transposed ? window.col : window.row,
              end = column.transposed ? window.col_end() : window.row_end();
    const int major_first = column.transposed ? window.row : window.col;
    const int major_end = column.transposed ? window.row_end() : window.col_end();
    const bool off = column.major < major_first || column.major >= major_end;
    const int from = std::max(first - column.first_minor, 0);
    const int to = off ? from : std::min(end - column.first_minor, column.count);

    double hint = -1;
    for (int i = from; i < to; ++i) {
      const int minor = column.first_minor + i;
      const int row = column.transposed ? column.major : minor,
                col = column.transposed ? minor : column.major;
      const bool hidden = column.all_hidden() || column.state[i] == kSurelyHidden;
      if (plain && hidden) {
        int run = column.all_hidden() ? to - i : 1;
        while (i + run < to && column.state[i + run] == kSurelyHidden) ++run;
        canvas_.hide(row, col, run, column.transposed);
        if (column.transposed) {
          totals_.hidden_m2 += run * area(row);
        } else {
          for (int r = 0; r < run; ++r) totals_.hidden_m2 += area(row + r);
        }
        i += run - 1;
        continue;
      }
      if (!has_target(row, col) || (by_place && !asked(row, col))) {
        canvas_.leave(row, col);
        continue;
      }
      if (hidden && !canvas_.has_heights()) {
        put(row, col, -scene_.largest_ratio);
        continue;
      }
      settle(hidden ? OpenParts() : open_parts(i), hidden, row, col, hint);
    }
    work_ += column.count;
    if (work_ > kReportEvery) {
      progress_.advance(work_);
      work_ = 0;
    }
  }

  // The sample the observer stands on exactly: nothing lies between.
  void paint_own_sample() {
    const int row = view_.eye.base_row, col = view_.eye.base_col;
    // It has no direction that limits could exclude.
    if (!canvas_.holds(row, col)) return;
    if (!has_target(row, col) || view_.limits.min_distance > 0) {
      canvas_.leave(row, col);
      return;
    }
    put(row, col, scene_.largest_ratio);
    if (canvas_.has_heights()) canvas_.put_heights(row, col, 0, 0);
  }

  void finish() { progress_.advance(work_); }

 private:
  static constexpr double kReportEvery =
      4096;  // cells; a fraction of a millisecond, tens of them when all are settled
  static constexpr double kSettleCost = 5;  // in cells, for the pace of the progress alone

  Target target(int row, int col) const {
    return {static_cast<double>(col - view_.eye.base_col), static_cast<double>(row - view_.eye.base_row),
            view_.tops.at(row, col),
            scene_.ends_move ? static_cast<double>(scene_.error.sampling.at(row, col)) : 0.0};
  }

  // Is there terrain at the cell, and something for the target to stand on?
  bool has_target(int row, int col) const {
    return !std::isnan(scene_.heights.at(row, col)) && !std::isnan(view_.tops.at(row, col));
  }

  bool asked(int row, int col) const {
    const ViewLimits& limits = view_.limits;
    const int from_col = col - view_.eye.base_col, from_row = row - view_.eye.base_row;
    const FramePlace place = view_.eye.frame_to(from_col, from_row).at(from_col, from_row);
    const double distance = place.distance();
    if (distance < limits.min_distance || distance > limits.max_distance) return false;
    if (!limits.all_azimuths() && !limits.admits_azimuth(place.azimuth_deg())) return false;
    if (limits.all_angles()) return true;
    const double rise = view_.tops.at(row, col) - scene_.bend * place.bulge - view_.eye.height;
    const double angle = std::atan2(rise, distance) * 180 / std::numbers::pi;
    return angle >= limits.angle_from && angle <= limits.angle_to;
  }

  void settle(OpenParts open, bool hidden, int row, int col, double& hint) {
    const double base_ground = static_cast<double>(view_.ground.at(row, col));
    const SightLine line(scene_, view_.eye, target(row, col));
    Critical critical{-scene_.largest_ratio, -1, false};
    if (!hidden) {
      critical = line.settle(open, hint);
      hint = critical.xi;
    }
    put(row, col, critical.k);
    if (critical.hole && verdict(scene_, critical.k) == kUncertain) {
      totals_.hole_doubt_m2 += area(row);
    }
    if (!hidden) ++totals_.settled;
    if (canvas_.has_heights() && !std::isnan(base_ground)) {
      const double likely = line.needed_height(0, base_ground, likely_hint_);
      const double certain = line.needed_height(scene_.quantile, base_ground, certain_hint_);
      const auto above = [&](double z) { return static_cast<float>(z - base_ground); };
      canvas_.put_heights(row, col, above(certain), above(likely));
    }
    work_ += kSettleCost;
  }

  void put(int row, int col, double k) {
    const std::uint8_t claim = verdict(scene_, k);
    canvas_.put(row, col, probability(scene_, k), claim);
    (claim == kVisible  ? totals_.visible_m2
     : claim == kHidden ? totals_.hidden_m2
                        : totals_.uncertain_m2) += area(row);
  }

  double area(int row) const { return view_.cell_areas[static_cast<std::size_t>(row)]; }

  const View& view_;
  const Scene& scene_;
  Canvas& canvas_;
  Progress& progress_;
  ViewTotals totals_;
  double likely_hint_ = -1, certain_hint_ = -1;  // where a neighbour's heights were decided
  double work_ = 0;
};

}  // namespace

bool ViewLimits::admits_azimuth(double azimuth_deg) const {
  const double width = azimuth_to - azimuth_from;
  double beyond = std::fmod(azimuth_deg - azimuth_from, 360);
  if (beyond < 0) beyond += 360;
  double span = std::fmod(width, 360);
  if (span < 0) span += 360;
  return beyond <= span;
}

Canvas::Canvas(const Window& window, CanvasStart start, bool best, bool heights, const Workers& workers,
               Progress& progress)
    : window_(window), start_(start), best_(best) {
  if (start == CanvasStart::kAllHidden) {
    confidence = Grid<float>::zeros(window.rows, window.cols);
    static_assert(kHidden == 0);
    verdict = Grid<std::uint8_t>::zeros(window.rows, window.cols);
    return;
  }
  confidence = Grid<float>(window.rows, window.cols);
  verdict = Grid<std::uint8_t>(window.rows, window.cols);
  if (heights) {
    certain_height = Grid<float>(window.rows, window.cols);
    likely_height = Grid<float>(window.rows, window.cols);
  }
  workers.for_each(static_cast<std::size_t>(window.rows), [&](std::size_t r) {
    progress.check();
    const int row = static_cast<int>(r);
    std::fill_n(verdict.row(row), window.cols, kNoVerdict);
    for (Grid<float>* grid : {&confidence, &certain_height, &likely_height}) {
      if (!grid->empty()) std::fill_n(grid->row(row), window.cols, kNan);
    }
  });
}

void Canvas::flip_rows() {
  for (Grid<float>* grid : {&confidence, &certain_height, &likely_height}) grid->flip_rows();
  verdict.flip_rows();
  count.flip_rows();
}

void Canvas::start_counting(const Workers& workers, Progress& progress) {
  count = Grid<std::uint32_t>(window_.rows, window_.cols);
  workers.for_each(static_cast<std::size_t>(window_.rows), [&](std::size_t r) {
    progress.check();
    std::fill_n(count.row(static_cast<int>(r)), window_.cols, kNoCount);
  });
}

void Canvas::put_heights(int row, int col, float certain, float likely) {
  const int r = row - window_.row, c = col - window_.col;
  const auto combine = [this](float& before, float now) {
    before = before != before ? now : best_ ? std::min(before, now) : std::max(before, now);
  };
  combine(certain_height.at(r, c), certain);
  combine(likely_height.at(r, c), likely);
}

void Canvas::seal_heights(const Workers& workers, Progress& progress) {
  for (Grid<float>* heights : {&certain_height, &likely_height}) {
    workers.for_each(static_cast<std::size_t>(heights->rows()), [&](std::size_t r) {
      progress.check();
      float* row = heights->row(static_cast<int>(r));
      for (int c = 0; c < heights->cols(); ++c) row[c] = std::isinf(row[c]) ? kNan : row[c];
    });
  }
}

ViewTotals& ViewTotals::operator+=(const ViewTotals& other) {
  visible_m2 += other.visible_m2;
  uncertain_m2 += other.uncertain_m2;
  hidden_m2 += other.hidden_m2;
  hole_doubt_m2 += other.hole_doubt_m2;
  settled += other.settled;
  return *this;
}

ViewTotals viewshed(const View& view, Canvas& canvas, const Workers& workers, Progress& progress) {
  const WedgeFan fan(view.scene, view.eye, view.tops, view.limits.max_distance);
  // Summed in the order of the blocks, whichever thread had them.
  std::vector<ViewTotals> totals(fan.blocks() + 1);
  if (view.eye.frame->col() == 0 && view.eye.frame->row() == 0) {
    Painter painter(view, canvas, progress);
    painter.paint_own_sample();
    totals.back() = painter.totals();
  }
  workers.for_each(fan.blocks(), [&](std::size_t block) {
    Painter painter(view, canvas, progress);
    fan.march(block, [&](const FanColumn& column, const WedgeFan::OpenPartsOf& open) {
      painter.paint(column, open);
    });
    painter.finish();
    totals[block] = painter.totals();
  });
  ViewTotals sum;
  for (const ViewTotals& t : totals) sum += t;
  return sum;
}

}  // namespace sightbound
