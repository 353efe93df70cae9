// SPDX-License-Identifier: GPL-3.0-or-later
// Notation: step = major steps from the observer; edges a, b = the two geodesics that bound a block; between them wedge edges
// are interpolated linearly, the geodesic in the middle tells by how much that can be wrong. tau = distance over metres per
// step at the observer, the measure in which a wedge's slopes are compared.
#include "sight/wedge_fan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace sightbound {

namespace {

constexpr int kBlocksPerUnit = 32;    // blocks per unit of slope: enough tasks for many threads, enough wedges for vectors
constexpr int kLeastWedges = 8;       // per block
constexpr double kWedgesPerCell = 1;  // at least so many wedges cross a cell side
constexpr double kFirstBelow = 0.5;   // steps from the observer where the lower horizon begins
constexpr double kFirstAbove = 2;     // ... and the upper one: nearer, a corner's slope says nothing
constexpr double kInterpolation = 2;  // safety on the error of interpolating between two geodesics, measured half way

// A quantity along the block's three geodesics at one column.
struct Fan3 {
  double a = 0, middle = 0, b = 0;
  double bend() const { return kInterpolation * std::abs(middle - (a + b) / 2); }
  double low() const { return std::min({a, middle, b}) - bend(); }
  double high() const { return std::max({a, middle, b}) + bend(); }
};

struct ColumnPlace {
  int major = 0;
  double step = 0;
  Fan3 minor, distance, tau, square;  // square = distance^2
};

}  // namespace

class WedgeFan::March {
 public:
  March(const WedgeFan& fan, const Block& block)
      : scene_(fan.scene_), eye_(fan.eye_), tops_(fan.tops_), block_(block), wedges_(kLeastWedges) {
    const double low = static_cast<double>(block.index) / kBlocksPerUnit, width = 1.0 / kBlocksPerUnit;
    for (std::size_t i = 0; i < 3; ++i) {
      rays_[i] = eye_.frame->ray(block.transposed, block.sign, low + static_cast<double>(i) * width / 2, block.reach);
    }
    base_major_ = block.transposed ? eye_.base_row : eye_.base_col;
    base_minor_ = block.transposed ? eye_.base_col : eye_.base_row;
    major0_ = block.transposed ? eye_.frame->row() : eye_.frame->col();
    minor0_ = block.transposed ? eye_.frame->col() : eye_.frame->row();
    majors_ = block.transposed ? scene_.heights.rows() : scene_.heights.cols();
    minors_ = block.transposed ? scene_.heights.cols() : scene_.heights.rows();
    const double moving = scene_.ends_move ? scene_.largest_ratio * eye_.sampling : 0;
    eye_above_ = static_cast<float>(eye_.height - moving);
    eye_below_ = static_cast<float>(eye_.height + moving);
    // A float is right to 6e-8 of its size; some eight roundings meet in one slope.
    height_pad_ = static_cast<float>(1e-3 + 5e-7 * std::max(std::abs(eye_.height), 1e4));
    above_.assign(static_cast<std::size_t>(wedges_), kUnbounded);
    before_ = above_;
    below_.assign(static_cast<std::size_t>(wedges_), -kUnbounded);
    bound_curvature();
  }

  void run(double reach_m, const std::function<void(const FanColumn&)>& visit) {
    int major = block_.sign > 0 ? static_cast<int>(std::floor(major0_)) + 1 : static_cast<int>(std::ceil(major0_)) - 1;
    ColumnPlace near = place(major - block_.sign), here = place(major), next = place(major + block_.sign);
    Column near_column, column;
    for (; here.major + base_major_ >= 0 && here.major + base_major_ < majors_; major += block_.sign) {
      if (here.distance.low() > reach_m) return;
      next = place(here.major + block_.sign);
      if (is_off_grid(here)) {
        // The block has left the grid; should a bent one come back, nothing is known of what it missed.
        std::fill(above_.begin(), above_.end(), kUnbounded);
        before_ = above_;
        near_column.rows = 0;
      } else {
        load(near, here, next, column);
        targets(here, column, visit);
        split(here.step);
        advance(near, here, near_column, column);
        std::swap(near_column, column);
      }
      near = here;
      here = next;
    }
  }

 private:
  // One column of the grid within the block: bounds of the terrain, and of what stands there.
  struct Column {
    int first = 0, rows = 0;  // minor coordinates from the base sample
    std::vector<float> above, below, top_above, top_below;
  };

  ColumnPlace place(int major) const {
    ColumnPlace p;
    p.major = major;
    p.step = std::max(block_.sign * (major - major0_), 0.0);
    const auto three = [](auto f) { return Fan3{f(0), f(1), f(2)}; };
    p.minor = three([&](std::size_t i) { return rays_[i].minor(p.step); });
    p.distance = three([&](std::size_t i) { return rays_[i].distance(p.step); });
    p.tau = three([&](std::size_t i) { return rays_[i].distance(p.step) / rays_[i].metres_per_step(); });
    p.square = three([&](std::size_t i) { return rays_[i].distance(p.step) * rays_[i].distance(p.step); });
    return p;
  }

  bool is_off_grid(const ColumnPlace& p) const {
    return p.minor.high() + base_minor_ < -2 || p.minor.low() + base_minor_ > minors_ + 1;
  }

  // bend D^2 / 2R over D^2: within the block it varies by a per mille.
  void bound_curvature() {
    double low = 1e300, high = 0;
    for (const GeodesicRay& ray : rays_) {
      for (const double share : {0.02, 0.25, 0.5, 0.75, 1.0}) {
        const double step = share * block_.reach, major = major0_ + block_.sign * step, minor = ray.minor(step);
        if (share > 0.02 && (minor < -base_minor_ || minor > minors_ - 1 - base_minor_)) continue;
        const FramePlace at = block_.transposed ? eye_.frame->at(minor, major) : eye_.frame->at(major, minor);
        const double square = at.east * at.east + at.north * at.north;
        low = std::min(low, at.bulge / square);
        high = std::max(high, at.bulge / square);
      }
    }
    const double margin = (high - low) / 2 + 1e-6 * high;
    curvature_low_ = scene_.bend * std::max(low - margin, 0.0);
    curvature_high_ = scene_.bend * (high + margin);
  }

  Linear drop(const ColumnPlace& p, bool high) const {
    const double step = (p.square.b - p.square.a) / wedges_;
    const double slack = std::abs(step) + p.square.bend();
    const double curvature = high ? curvature_high_ : curvature_low_;
    return {static_cast<float>(curvature * (p.square.a + (high ? slack : -slack))), static_cast<float>(curvature * step)};
  }

  Linear edges(const ColumnPlace& p, int first) const {
    return {static_cast<float>(p.minor.a - first), static_cast<float>((p.minor.b - p.minor.a) / wedges_)};
  }

  static float largest_inverse(const ColumnPlace& p) { return static_cast<float>((1 + 1e-6) / p.tau.low()); }
  static float smallest_inverse(const ColumnPlace& p) { return static_cast<float>((1 - 1e-6) / p.tau.high()); }

  void load(const ColumnPlace& near, const ColumnPlace& here, const ColumnPlace& next, Column& column) const {
    constexpr int kMargin = 3;  // rows beyond the edges: pads and the cell around an edge
    const double low = std::min({near.minor.low(), here.minor.low(), next.minor.low()});
    const double high = std::max({near.minor.high(), here.minor.high(), next.minor.high()});
    column.first = static_cast<int>(std::floor(low)) - kMargin;
    column.rows = static_cast<int>(std::ceil(high)) + kMargin - column.first + 1;
    for (auto* values : {&column.above, &column.below, &column.top_above, &column.top_below}) {
      values->resize(static_cast<std::size_t>(column.rows));
    }
    const float unknown_above = scene_.see_across_nodata ? -kUnbounded : kUnbounded;
    const bool end_zone = here.distance.high() < scene_.end_zone_m;
    const double k = scene_.largest_ratio;
    const int major = here.major + base_major_;
    const float uniform_above = static_cast<float>(k * scene_.least_sigma) + height_pad_;
    const float uniform_below = static_cast<float>(k * (end_zone ? kLeastSigma : scene_.least_sigma)) + height_pad_;
    for (int j = 0; j < column.rows; ++j) {
      const auto at = static_cast<std::size_t>(j);
      const int minor = column.first + j + base_minor_;
      const int row = block_.transposed ? major : minor, col = block_.transposed ? minor : major;
      const float z = minor < 0 || minor >= minors_ ? std::numeric_limits<float>::quiet_NaN() : scene_.heights.at(row, col);
      if (z != z) {
        column.above[at] = unknown_above;
        column.below[at] = -kUnbounded;
        column.top_above[at] = column.top_below[at] = 0;
        continue;
      }
      const float top = static_cast<float>(tops_.at(row, col));
      const float moving = scene_.ends_move ? static_cast<float>(k) * scene_.error.sampling.at(row, col) : 0;
      column.top_above[at] = top - moving - height_pad_;
      column.top_below[at] = top + moving + height_pad_;
      if (scene_.uniform) {
        column.above[at] = z + uniform_above;
        column.below[at] = z - uniform_below;
      } else {
        const double between = std::max(scene_.between_bound(row, col), kLeastSigma);
        const float full = static_cast<float>(k * scene_.sigma_bound(row, col)) + height_pad_;
        column.above[at] = z + full;
        column.below[at] = z - (end_zone ? static_cast<float>(k * between) + height_pad_ : full);
      }
    }
  }

  void targets(const ColumnPlace& here, const Column& column, const std::function<void(const FanColumn&)>& visit) {
    // Rows between the block's edges, on this side's half of the diagonals (the diagonals belong to the columns' sides).
    int low = static_cast<int>(std::ceil(here.minor.a)), high = static_cast<int>(std::ceil(here.minor.b));
    const auto mine = [&](int minor) {
      const double off = std::abs(minor - minor0_), along = std::abs(here.major - major0_);
      return block_.transposed ? off < along : off <= along;
    };
    low = std::max(low, -base_minor_);
    high = std::min(high, minors_ - base_minor_);
    while (low < high && !mine(low)) ++low;
    while (low < high && !mine(high - 1)) --high;
    if (low >= high) return;

    states_.resize(static_cast<std::size_t>(high - low));
    TargetStep step;
    step.first_row = low - column.first;
    step.rows = high - low;
    step.wedges = wedges_;
    step.edges = edges(here, column.first);
    step.pad = static_cast<float>(here.minor.bend()) + kPositionPad;
    step.drop_low = drop(here, false);
    step.drop_high = drop(here, true);
    step.eye_above = eye_above_;
    step.eye_below = eye_below_;
    step.least = largest_inverse(here);
    step.most = smallest_inverse(here);
    if (2 * step.pad < step.edges.step) {
      judge_targets(step, before_.data(), below_.data(), column.top_above.data(), column.top_below.data(), states_.data());
    } else {  // wedges too thin for their pad: leave everything open
      std::fill(states_.begin(), states_.end(), static_cast<std::uint8_t>(kOpen));
    }
    FanColumn out;
    out.transposed = block_.transposed;
    out.major = here.major + base_major_;
    out.first_minor = low + base_minor_;
    out.count = high - low;
    out.state = states_.data();
    out.clear_from = above_from_ + base_major_;
    out.clear_to = out.major - 2 * block_.sign;
    out.least_distance = here.distance.low();
    out.most_distance = here.distance.high();
    visit(out);
  }

  void split(double step) {
    while (wedges_ * kBlocksPerUnit < kWedgesPerCell * step) {
      for (auto* values : {&above_, &before_, &below_}) {
        values->resize(static_cast<std::size_t>(2 * wedges_));
        for (std::size_t i = values->size(); i-- > 0;) (*values)[i] = (*values)[i / 2];
      }
      wedges_ *= 2;
    }
  }

  void advance(const ColumnPlace& near, const ColumnPlace& here, const Column& near_column, const Column& column) {
    before_ = above_;
    if (!has_above_ && here.step >= kFirstAbove) {
      // From this column on the upper horizon is complete.
      has_above_ = true;
      above_from_ = here.major;
      std::fill(above_.begin(), above_.end(), -kUnbounded);
    } else if (has_above_) {
      raise(near, here, near_column, column);
    }
    if (here.step < kFirstBelow) return;
    WedgeStep step;
    step.wedges = wedges_;
    step.far = edges(here, column.first);
    step.pad = static_cast<float>(here.minor.bend()) + kPositionPad;
    step.rows = column.rows;
    step.drop_high = drop(here, true);
    step.eye_below = eye_below_;
    step.far_most = smallest_inverse(here);
    step.far_least = largest_inverse(here);
    raise_below(step, column.below.data(), below_.data());
  }

  void raise(const ColumnPlace& near, const ColumnPlace& here, const Column& near_column, const Column& column) {
    if (near_column.rows == 0) return;  // stays unbounded
    const int first = std::max(near_column.first, column.first);
    const int end = std::min(near_column.first + near_column.rows, column.first + column.rows);
    cells_.resize(static_cast<std::size_t>(end - first));
    highest_corners(end - first - 1, near_column.above.data() + (first - near_column.first),
                    column.above.data() + (first - column.first), cells_.data());
    WedgeStep step;
    step.wedges = wedges_;
    step.near = edges(near, first);
    step.far = edges(here, first);
    step.pad = static_cast<float>(std::max(near.minor.bend(), here.minor.bend())) + kPositionPad;
    step.rows = end - first;
    step.drop_low = drop(near, false);
    step.eye_above = eye_above_;
    step.near_least = largest_inverse(near);
    step.far_most = smallest_inverse(here);
    raise_above(step, cells_.data(), above_.data());
  }

  const Scene& scene_;
  const Eye& eye_;
  const TargetTops& tops_;
  const Block& block_;
  std::array<GeodesicRay, 3> rays_;
  int base_major_, base_minor_, majors_, minors_;
  double major0_, minor0_;
  float eye_above_, eye_below_, height_pad_;
  double curvature_low_ = 0, curvature_high_ = 0;
  int wedges_;
  bool has_above_ = false;
  int above_from_ = 0;
  std::vector<float> above_, before_, below_;  // horizons; before_ = above_ one column earlier
  std::vector<float> cells_;
  std::vector<std::uint8_t> states_;
};

WedgeFan::WedgeFan(const Scene& scene, const Eye& eye, const TargetTops& tops, double reach_m)
    : scene_(scene), eye_(eye), tops_(tops), reach_m_(reach_m) {
  for (const bool transposed : {false, true}) {
    for (const int sign : {1, -1}) add_side(transposed, sign);
  }
}

void WedgeFan::add_side(bool transposed, int sign) {
  const ObserverFrame& frame = *eye_.frame;
  const double major0 = transposed ? frame.row() : frame.col(), minor0 = transposed ? frame.col() : frame.row();
  const int base_major = transposed ? eye_.base_row : eye_.base_col, base_minor = transposed ? eye_.base_col : eye_.base_row;
  const int majors = transposed ? scene_.heights.rows() : scene_.heights.cols();
  const int minors = transposed ? scene_.heights.cols() : scene_.heights.rows();
  const double reach = sign > 0 ? majors - 1 - base_major - major0 : major0 + base_major;
  if (reach <= 0) return;
  // A geodesic to a cell on the diagonal may leave the observer a little steeper than 1: some blocks more, where needed.
  double steepest = 1;
  for (const int side : {1, -1}) {
    const double across = side > 0 ? minors - 1 - base_minor - minor0 : minor0 + base_minor;
    const double along = std::min(reach, across);
    for (const double share : {0.25, 0.5, 0.75, 1.0}) {
      const double major = major0 + sign * along * share, minor = minor0 + side * along * share;
      if (along * share <= 0) continue;
      const GeodesicPath path = frame.path_to(transposed ? minor : major, transposed ? major : minor, transposed);
      steepest = std::max(steepest, std::abs(path.minor_slope(0) / (along * share)));
    }
  }
  const int extra = steepest > 1 + 1e-9 ? static_cast<int>(std::ceil((steepest - 1) * kBlocksPerUnit)) + 1 : 1;
  for (int index = -kBlocksPerUnit - extra; index < kBlocksPerUnit + extra; ++index) {
    blocks_.push_back({transposed, sign, index, std::max(reach, 1.0)});
  }
}

void WedgeFan::march(std::size_t block, const std::function<void(const FanColumn&)>& visit) const {
  March(*this, blocks_[block]).run(reach_m_, visit);
}

}  // namespace sightbound
