// SPDX-License-Identifier: GPL-3.0-or-later
// Notation: step = major steps from the observer; edges a, b = the two geodesics that bound a block; between
// them wedge edges are interpolated linearly, the geodesic in the middle tells by how much that can be wrong.
// tau = distance over metres per step at the observer, the measure in which a wedge's slopes are compared.
#include "sight/wedge_fan.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace sightbound {

namespace {

constexpr int kBlocksPerUnit =
    16;  // blocks per unit of slope: enough tasks for many threads, enough wedges for vectors
constexpr int kLeastWedges = kVector;  // per block
constexpr double kWedgesPerCell =
    1.0 / 3;  // at least so many wedges cross a cell side: more cost more than the cells they would prove
constexpr int kLeastPart = 16;  // columns an upper horizon stands for, at least
constexpr int kMostParts = 128;
constexpr double kFirstBelow = 0.5;  // steps from the observer where the lower horizon begins
constexpr double kFirstAbove = 2;    // ... and the upper one: nearer, a corner's slope says nothing
constexpr double kInterpolation =
    2;  // safety on the error of interpolating between two geodesics, measured half way

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
      rays_[i] = eye_.frame->ray(block.transposed, block.sign, low + static_cast<double>(i) * width / 2,
                                 block.reach);
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
    below_.assign(static_cast<std::size_t>(wedges_), -kUnbounded);
    // Parts of equal length, a power of two, so many that a search can be confined to few columns.
    while (part_length_ * kMostParts < block.reach) part_length_ *= 2;
    frame_pad_ = 2 * eye_.frame->error_cells();
    bound_curvature();
  }

  void run(double reach_m, const Visitor& visit) {
    int major = block_.sign > 0 ? static_cast<int>(std::floor(major0_)) + 1
                                : static_cast<int>(std::ceil(major0_)) - 1;
    ColumnPlace before = place(major - 2 * block_.sign), near = place(major - block_.sign),
                here = place(major);
    Column before_column, near_column, column;
    for (; here.major + base_major_ >= 0 && here.major + base_major_ < majors_; major += block_.sign) {
      if (here.distance.low() > reach_m) return;
      const ColumnPlace next = place(here.major + block_.sign);
      if (is_off_grid(here)) {
        // The block has left the grid; should a bent one come back, nothing is known of what it missed.
        for (Part& part : parts_) std::fill(part.above.begin(), part.above.end(), kUnbounded);
        column.rows = 0;
      } else {
        load(near, here, next, column);
        targets(here, column, visit);
        split(here.step);
        lower(here, column);
      }
      // The upper horizon stays two columns behind the targets: nearer places are judged without the
      // measurement error.
      raise(before, near, before_column, near_column);
      std::swap(before_column, near_column);
      std::swap(near_column, column);
      before = near;
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
    const std::array distance{rays_[0].distance(p.step), rays_[1].distance(p.step),
                              rays_[2].distance(p.step)};
    p.distance = three([&](std::size_t i) { return distance[i]; });
    p.tau = three([&](std::size_t i) { return distance[i] / rays_[i].metres_per_step(); });
    p.square = three([&](std::size_t i) { return distance[i] * distance[i]; });
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
        const double step = share * block_.reach, major = major0_ + block_.sign * step,
                     minor = ray.minor(step);
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
    return {static_cast<float>(curvature * (p.square.a + (high ? slack : -slack))),
            static_cast<float>(curvature * step)};
  }

  Linear edges(const ColumnPlace& p, int first) const {
    return {static_cast<float>(p.minor.a - first), static_cast<float>((p.minor.b - p.minor.a) / wedges_)};
  }

  // Of one wedge, cells.
  double width(const ColumnPlace& p) const { return (p.minor.b - p.minor.a) / wedges_; }

  // A frame may be wrong by `frame_pad_` cells.
  float largest_inverse(const ColumnPlace& p) const {
    return static_cast<float>((1 + 1e-6 + frame_pad_ / std::max(p.step, kFirstBelow)) / p.tau.low());
  }
  float smallest_inverse(const ColumnPlace& p) const {
    return static_cast<float>((1 - 1e-6 - frame_pad_ / std::max(p.step, kFirstBelow)) / p.tau.high());
  }

  void load(const ColumnPlace& near, const ColumnPlace& here, const ColumnPlace& next, Column& column) {
    constexpr int kMargin = 3;  // rows beyond the edges: pads and the cell around an edge
    const double low = std::min({near.minor.low(), here.minor.low(), next.minor.low()});
    const double high = std::max({near.minor.high(), here.minor.high(), next.minor.high()});
    column.first = static_cast<int>(std::floor(low)) - kMargin;
    column.rows = static_cast<int>(std::ceil(high)) + kMargin - column.first + 1;
    const auto room = static_cast<std::size_t>(column.rows + 2 * kVector);
    for (auto* values : {&column.above, &column.below, &column.top_above, &column.top_below, &z_}) {
      if (values->size() < room) values->resize(room);
    }
    const int major = here.major + base_major_;
    copy(scene_.heights, major, column, z_, std::numeric_limits<float>::quiet_NaN());

    const double k = scene_.largest_ratio;
    ColumnBounds bounds;
    bounds.count = column.rows;
    bounds.unknown = scene_.see_across_nodata ? -kUnbounded : kUnbounded;
    bounds.end_zone = here.distance.high() < scene_.end_zone_m;
    bounds.pad = height_pad_;
    bounds.ratio = static_cast<float>(k * (1 + 1e-6));
    bounds.full = static_cast<float>(k * scene_.least_sigma) + height_pad_;
    bounds.near_end = bounds.end_zone ? static_cast<float>(k * kLeastSigma) + height_pad_ : bounds.full;
    if (!scene_.uniform) {
      sampling_.resize(room);
      between_.resize(room);
      copy(scene_.error.sampling, major, column, sampling_);
      copy(scene_.error.amplitude, major, column, between_);
      const auto profile = static_cast<float>(scene_.largest_profile());
      for (int j = 0; j < column.rows; ++j) between_[static_cast<std::size_t>(j)] *= profile;
      bounds.sampling = sampling_.data();
      bounds.between = between_.data();
    }
    bound_column(bounds, z_.data(), column.above.data(), column.below.data());
    load_tops(major, column);
  }

  // A column of a grid, `outside` where the grid has none.
  void copy(const Grid<float>& from, int major, const Column& column, std::vector<float>& to,
            float outside) const {
    const int minor = column.first + base_minor_, begin = std::clamp(-minor, 0, column.rows);
    const int end = std::clamp(minors_ - minor, begin, column.rows);
    std::fill_n(to.begin(), begin, outside);
    std::fill(to.begin() + end, to.begin() + column.rows, outside);
    if (block_.transposed) {
      std::copy_n(from.row(major) + minor + begin, end - begin, to.begin() + begin);
    } else {
      for (int j = begin; j < end; ++j) to[static_cast<std::size_t>(j)] = from.at(minor + j, major);
    }
  }
  void copy(const SampleField& from, int major, const Column& column, std::vector<float>& to) const {
    if (from.is_constant()) {
      std::fill_n(to.begin(), column.rows, from.constant());
    } else {
      copy(from.values(), major, column, to, 0);
    }
  }

  // What the targets of a column reach up to: at least and at most, when the ground under them moves.
  void load_tops(int major, Column& column) {
    const auto height = static_cast<float>(tops_.height);
    if (tops_.surface == nullptr) {
      std::fill_n(z_.begin(), column.rows, 0.0f);
    } else if (tops_.surface != &scene_.heights) {
      copy(*tops_.surface, major, column, z_, 0);
    }
    if (scene_.ends_move) {
      sampling_.resize(z_.size());
      copy(scene_.error.sampling, major, column, sampling_);
    }
    for (int j = 0; j < column.rows; ++j) {
      const auto at = static_cast<std::size_t>(j);
      const float slack =
          height_pad_ + (scene_.ends_move ? static_cast<float>(scene_.largest_ratio) * sampling_[at] : 0);
      column.top_above[at] = z_[at] + height - slack;
      column.top_below[at] = z_[at] + height + slack;
      // Where there is no terrain there is no target either, whatever the tops stand on.
      if (column.below[at] <= -kUnbounded) column.top_below[at] = std::numeric_limits<float>::quiet_NaN();
    }
  }

  void targets(const ColumnPlace& here, const Column& column, const Visitor& visit) {
    // Rows between the block's edges, on this side's half of the diagonals (the diagonals belong to the
    // columns' sides).
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

    states_.resize(static_cast<std::size_t>(whole_vectors(high - low)));
    TargetStep step;
    step.first_row = low - column.first;
    step.rows = high - low;
    step.wedges = wedges_;
    step.edges = edges(here, column.first);
    step.pad = static_cast<float>(here.minor.bend() + frame_pad_) + kPositionPad;
    step.drop_low = drop(here, false);
    step.drop_high = drop(here, true);
    step.eye_above = eye_above_;
    step.eye_below = eye_below_;
    step.least = largest_inverse(here);
    step.most = smallest_inverse(here);
    if (2 * step.pad < step.edges.step) {
      judge_targets(step, below_.data(), column.top_below.data(), states_.data());
    } else {  // wedges too thin for their pad: leave everything open
      std::fill(states_.begin(), states_.end(), static_cast<std::int32_t>(kOpen));
    }
    FanColumn out;
    out.transposed = block_.transposed;
    out.major = here.major + base_major_;
    out.first_minor = low + base_minor_;
    out.count = high - low;
    out.state = states_.data();
    out.least_distance = here.distance.low();
    out.most_distance = here.distance.high();
    visit(out, [&](int i) {
      return open_parts(step, i, column.top_above[static_cast<std::size_t>(step.first_row + i)], out.major);
    });
  }

  // Everything from the observer to where the upper horizon begins, the parts it does not clear, and what it
  // has not reached.
  OpenParts open_parts(const TargetStep& step, int i, float top_above, int target_major) {
    ranges_.clear();
    const WedgePair wedge = wedges_of(step, i);
    const float slope = flattest_slope(step, wedge.a, top_above);
    const bool thin = 2 * step.pad >= step.edges.step;
    const int observer = static_cast<int>(std::floor(major0_)) + base_major_ + (block_.sign < 0 ? 1 : 0);
    add_range(observer, (parts_.empty() ? target_major : parts_.front().from + base_major_));
    for (const Part& part : parts_) {
      const float reaches = std::max(part.above[static_cast<std::size_t>(wedge.a)],
                                     part.above[static_cast<std::size_t>(wedge.b)]);
      if (thin || !(reaches + 1e-6f * std::abs(reaches) < slope))
        add_range(part.from + base_major_, part.to + base_major_);
    }
    if (!parts_.empty()) add_range(parts_.back().to + base_major_, target_major);
    return ranges_;
  }

  // Columns in the order of the march; steps in order of the grid.
  void add_range(int from, int to) {
    const MajorRange range{std::min(from, to), std::max(from, to)};
    if (range.from == range.to) return;
    if (!ranges_.empty() && block_.sign > 0 && ranges_.back().to == range.from) {
      ranges_.back().to = range.to;
    } else if (!ranges_.empty() && block_.sign < 0 && ranges_.back().from == range.to) {
      ranges_.back().from = range.from;
    } else {
      ranges_.push_back(range);
    }
  }

  void split(double step) {
    const auto doubled = [](std::vector<float>& values) {
      values.resize(2 * values.size());
      for (std::size_t i = values.size(); i-- > 0;) values[i] = values[i / 2];
    };
    while (wedges_ * kBlocksPerUnit < kWedgesPerCell * step) {
      for (Part& part : parts_) doubled(part.above);
      doubled(below_);
      wedges_ *= 2;
    }
  }

  void lower(const ColumnPlace& here, const Column& column) {
    if (here.step < kFirstBelow) return;
    WedgeStep step;
    step.wedges = wedges_;
    step.far = edges(here, column.first);
    step.pad = static_cast<float>(here.minor.bend() + frame_pad_) + kPositionPad;
    step.rows = column.rows;
    step.window = window_for(width(here) + 2 * static_cast<double>(step.pad));
    widened_.resize(static_cast<std::size_t>(column.rows + step.window + 2 * kVector));
    std::copy_n(column.below.begin(), column.rows, widened_.begin());
    widen_lowest(column.rows, step.window, widened_.data());
    step.drop_high = drop(here, true);
    step.eye_below = eye_below_;
    step.far_most = smallest_inverse(here);
    step.far_least = largest_inverse(here);
    raise_below(step, column.below.data(), widened_.data(), below_.data());
  }

  // Parts are short near the observer, where an upper horizon is loose and should not speak for many columns.
  int part_number(int major) const {
    const auto steps = static_cast<unsigned>(std::abs(major - static_cast<int>(std::floor(major0_))));
    if (steps >= static_cast<unsigned>(part_length_)) return static_cast<int>(steps) / part_length_;
    return static_cast<int>(std::bit_width(steps)) - std::numeric_limits<unsigned>::digits;
  }

  void raise(const ColumnPlace& near, const ColumnPlace& here, const Column& near_column,
             const Column& column) {
    if (near.step < kFirstAbove) return;
    const int number = part_number(here.major);
    if (parts_.empty() || parts_.back().number != number) {
      parts_.push_back({number, near.major, near.major,
                        std::vector<float>(static_cast<std::size_t>(wedges_), -kUnbounded)});
    }
    Part& part = parts_.back();
    part.to = here.major;
    if (near_column.rows == 0 || column.rows == 0) {
      std::fill(part.above.begin(), part.above.end(), kUnbounded);
      return;
    }
    const int first = std::max(near_column.first, column.first);
    const int end = std::min(near_column.first + near_column.rows, column.first + column.rows);
    WedgeStep step;
    step.wedges = wedges_;
    step.near = edges(near, first);
    step.far = edges(here, first);
    step.pad = static_cast<float>(std::max(near.minor.bend(), here.minor.bend()) + frame_pad_) + kPositionPad;
    step.rows = end - first;
    const double shift =
        std::max(std::abs(here.minor.a - near.minor.a), std::abs(here.minor.b - near.minor.b));
    step.window = window_for(std::max(width(near), width(here)) + shift + 2 * static_cast<double>(step.pad));
    cells_.resize(static_cast<std::size_t>(end - first + step.window + 2 * kVector));
    highest_corners(end - first - 1, near_column.above.data() + (first - near_column.first),
                    column.above.data() + (first - column.first), cells_.data());
    widen_highest(end - first - 1, step.window, cells_.data());
    step.drop_low = drop(near, false);
    step.eye_above = eye_above_;
    step.near_least = largest_inverse(near);
    step.far_most = smallest_inverse(here);
    raise_above(step, cells_.data(), part.above.data());
  }

  // The upper horizon of some columns alone.
  struct Part {
    int number;
    int from, to;              // majors from the base sample
    std::vector<float> above;  // one a wedge
  };

  const Scene& scene_;
  const Eye& eye_;
  const TargetTops& tops_;
  const Block& block_;
  std::array<GeodesicRay, 3> rays_;
  int base_major_, base_minor_, majors_, minors_;
  double major0_, minor0_;
  float eye_above_, eye_below_, height_pad_;
  double frame_pad_ = 0;  // cells
  double curvature_low_ = 0, curvature_high_ = 0;
  int wedges_;
  int part_length_ = kLeastPart;
  std::vector<Part> parts_;
  std::vector<float> below_;  // the lower horizon, one a wedge
  std::vector<MajorRange> ranges_;
  std::vector<float> cells_, widened_, z_, sampling_, between_;  // scratch
  std::vector<std::int32_t> states_;
};

WedgeFan::WedgeFan(const Scene& scene, const Eye& eye, const TargetTops& tops, double reach_m)
    : scene_(scene), eye_(eye), tops_(tops), reach_m_(reach_m) {
  for (const bool transposed : {false, true}) {
    for (const int sign : {1, -1}) add_side(transposed, sign);
  }
}

void WedgeFan::add_side(bool transposed, int sign) {
  const ObserverFrame& frame = *eye_.frame;
  const double major0 = transposed ? frame.row() : frame.col(),
               minor0 = transposed ? frame.col() : frame.row();
  const int base_major = transposed ? eye_.base_row : eye_.base_col,
            base_minor = transposed ? eye_.base_col : eye_.base_row;
  const int majors = transposed ? scene_.heights.rows() : scene_.heights.cols();
  const int minors = transposed ? scene_.heights.cols() : scene_.heights.rows();
  const double reach = sign > 0 ? majors - 1 - base_major - major0 : major0 + base_major;
  if (reach <= 0) return;
  // A geodesic to a cell on the diagonal may leave the observer a little steeper than 1: some blocks more,
  // where needed.
  double steepest = 1;
  for (const int side : {1, -1}) {
    const double across = side > 0 ? minors - 1 - base_minor - minor0 : minor0 + base_minor;
    const double along = std::min(reach, across);
    for (const double share : {0.25, 0.5, 0.75, 1.0}) {
      const double major = major0 + sign * along * share, minor = minor0 + side * along * share;
      if (along * share <= 0) continue;
      const GeodesicPath path =
          frame.path_to(transposed ? minor : major, transposed ? major : minor, transposed);
      steepest = std::max(steepest, std::abs(path.minor_slope(0) / (along * share)));
    }
  }
  const int extra =
      steepest > 1 + 1e-9 ? static_cast<int>(std::ceil((steepest - 1) * kBlocksPerUnit)) + 1 : 1;
  for (int index = -kBlocksPerUnit - extra; index < kBlocksPerUnit + extra; ++index) {
    blocks_.push_back({transposed, sign, index, std::max(reach, 1.0)});
  }
}

void WedgeFan::march(std::size_t block, const Visitor& visit) const {
  March(*this, blocks_[block]).run(reach_m_, visit);
}

}  // namespace sightbound
