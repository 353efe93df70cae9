// SPDX-License-Identifier: GPL-3.0-or-later
//   s      distance along the ground, metres
//   rise   (height - eye) / s - bend s / 2R: the slope of a line of sight to there, over the curved ground
#include "sight/probable_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sight/fine_ground.h"

namespace sightbound {

namespace {

constexpr int kRaysOfBlock = 64;
constexpr double kRaysOfSample = 2;  // at the far end
// How finely ground is drawn between the places that rays cross, half a cell apart: in halves, quarters ...
constexpr int kNearestSteps = 2, kNearSteps = 8;  // from the eye
constexpr int kDepthNearest = 2, kDepthNear = 1, kDepthAtTarget = 2;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

SIGHTBOUND_VECTOR
void cross(const Lanes& a, const Lanes& b, float part, Lanes& ground) {
  for (int l = 0; l < kLanes; ++l) ground.v[l] = a.v[l] + part * (b.v[l] - a.v[l]);
}

SIGHTBOUND_VECTOR
std::uint16_t seen_over(const Lanes& horizon, const Lanes& ground, float target, const Lanes& eye,
                        float per_s, float drop) {
  std::uint32_t bits = 0;
  for (int l = 0; l < kLanes; ++l) {
    const float rise = (ground.v[l] + target - eye.v[l]) * per_s - drop;
    bits |= rise >= horizon.v[l] ? 1u << l : 0u;
  }
  return static_cast<std::uint16_t>(bits);
}

// In samples along the major axis.
double reach_of(const ProbableEye& eye, bool transposed, int sign) {
  const double at = transposed ? eye.base_row + eye.frame->row() : eye.base_col + eye.frame->col();
  const int first = transposed ? eye.reach.row : eye.reach.col;
  const int last = (transposed ? eye.reach.row_end() : eye.reach.col_end()) - 1;
  return sign > 0 ? last - at : at - first;
}

}  // namespace

// One block on its way outward.
class ProbableView::March {
 public:
  March(const ProbableView& view, const Block& block, std::uint32_t first_realisation, SeenBits& seen)
      : view_(view),
        side_(block.side),
        seen_(seen),
        columns_(view.terrain_, block.side.transposed, first_realisation),
        fine_(view.terrain_, block.side.transposed, view.eye_.base_row, view.eye_.base_col,
              first_realisation),
        eye_(view.eye_heights(first_realisation)),
        base_major_(side_.transposed ? view.eye_.base_row : view.eye_.base_col),
        base_minor_(side_.transposed ? view.eye_.base_col : view.eye_.base_row),
        major_(side_.transposed ? view.eye_.frame->row() : view.eye_.frame->col()),
        minor_(side_.transposed ? view.eye_.frame->col() : view.eye_.frame->row()),
        first_minor_(-base_minor_),
        last_minor_((columns_.minors() - 1) / 2 - base_minor_) {
    const double reach = reach_of(view.eye_, side_.transposed, side_.sign);
    // One ray more on either side shares the samples between two blocks.
    first_ray_ = std::max(block.first - 1, 0);
    const int end = std::min(block.first + block.count + 1, block.rays);
    own_from_ = block.first - first_ray_;
    own_to_ = own_from_ + block.count - 1;
    first_of_side_ = block.first == 0;
    last_of_side_ = block.first + block.count == block.rays;
    for (int i = first_ray_; i < end; ++i) {
      const double slope = block.rays > 1 ? 2.0 * i / (block.rays - 1) - 1 : 0;
      add_ray(slope, reach);
    }
  }

  void run() {
    const int first = side_.sign > 0 ? static_cast<int>(std::floor(2 * major_)) + 1
                                     : static_cast<int>(std::ceil(2 * major_)) - 1;
    for (int m = first; m >= -2 * base_major_ && m < columns_.majors() - 2 * base_major_; m += side_.sign) {
      if (!step_to(m)) return;
    }
  }

 private:
  struct Ray {
    GeodesicRay path;
    double per_2r;   // bend / 2R along it
    RayPlace place;  // where it is now
    bool inside = true;
  };

  void add_ray(double slope, double reach) {
    const ObserverFrame& frame = *view_.eye_.frame;
    Ray ray{frame.ray(side_.transposed, side_.sign, slope, reach), 0, {}};
    // Of the part of the ray within reach, the far end.
    const Window& all = view_.eye_.reach;
    const int first = (side_.transposed ? all.col : all.row) - base_minor_,
              last = (side_.transposed ? all.col_end() : all.row_end()) - 1 - base_minor_;
    double step = reach;
    if (slope > 0) step = std::min(step, std::max((last - minor_) / slope, 0.5));
    if (slope < 0) step = std::min(step, std::max((first - minor_) / slope, 0.5));
    const double end_minor = ray.path.minor(step), end_major = major_ + side_.sign * step;
    const FramePlace end = side_.transposed ? frame.at(end_minor, end_major) : frame.at(end_major, end_minor);
    const double d = end.distance();
    ray.per_2r = d > 0 ? view_.bend_ * end.bulge / (d * d) : 0;
    ray.place = {major_, minor_, 0, eye_};
    for (float& ground : ray.place.ground.v) ground -= static_cast<float>(view_.eye_.height);
    rays_.push_back(ray);
    next_.push_back(minor_);
    Lanes low;
    std::fill_n(low.v, kLanes, -std::numeric_limits<float>::infinity());
    horizons_.push_back(low);
  }

  // False when all rays have left the raster.
  bool step_to(int m) {
    const double step = std::abs(0.5 * m - major_);
    int from = std::numeric_limits<int>::max(), to = std::numeric_limits<int>::min();
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      next_[i] = rays_[i].path.minor(step);
      rays_[i].inside = next_[i] >= first_minor_ && next_[i] <= last_minor_;
      if (!rays_[i].inside) continue;
      const int n = static_cast<int>(std::floor(2 * next_[i]));
      from = std::min(from, n);
      to = std::max(to, std::min(n + 1, 2 * last_minor_));
    }
    if (m % 2 == 0) widen_to_targets(step, from, to);
    if (to < from) return false;
    const int shift = 2 * base_minor_;
    const Lanes* nodes = columns_.nodes(m + 2 * base_major_, from + shift, to + shift) + shift;
    if (m % 2 == 0) ask_targets(m, step, nodes);
    ++steps_;
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      if (rays_[i].inside) go_on(i, 0.5 * m, step, nodes);
    }
    return true;
  }

  void go_on(std::size_t i, double major, double step, const Lanes* nodes) {
    Ray& ray = rays_[i];
    const int n = static_cast<int>(std::floor(2 * next_[i])), beside = std::min(n + 1, 2 * last_minor_);
    RayPlace place{major, next_[i], ray.path.distance(step), {}};
    cross(nodes[n], nodes[beside], static_cast<float>(2 * next_[i] - n), place.ground);
    fine_.depart(place, 2 * next_[i] - n, view_.terrain_.error.larger_side_m / 2);
    const RaySlopes slopes{eye_, ray.per_2r};
    if (steps_ <= kNearSteps) {
      const int depth = steps_ <= kNearestSteps ? kDepthNearest : kDepthNear;
      fine_.raise(ray.place, place, depth, slopes, horizons_[i]);
    }
    raise_horizon(place, slopes, horizons_[i]);
    ray.place = place;
  }

  // The block's targets on a line of samples: those nearer to its own rays than to others, within the side's
  // half of the quadrant.
  struct Range {
    int from, to;
  };
  Range targets_at(double step) const {
    const auto between = [&](int i) { return 0.5 * (next_[at(i)] + next_[at(i + 1)]); };
    double low = minor_ - step, high = minor_ + step;
    if (!first_of_side_) low = std::max(low, between(own_from_ - 1));
    if (!last_of_side_) high = std::min(high, between(own_to_));
    // A target half-way between two blocks belongs to the second; one on a diagonal to the side of columns.
    int from = static_cast<int>(std::ceil(low)) - (first_of_side_ ? 1 : 0);
    int to = last_of_side_ ? static_cast<int>(std::floor(high)) + 1 : static_cast<int>(std::ceil(high)) - 1;
    const auto owns = [&](int n) {
      const double off = std::abs(n - minor_);
      return side_.transposed ? off < step : off <= step;
    };
    while (from <= to && !owns(from)) ++from;
    while (to >= from && !owns(to)) --to;
    return {std::max(from, first_minor_), std::min(to, last_minor_)};
  }

  void widen_to_targets(double step, int& from, int& to) const {
    const Range targets = targets_at(step);
    if (targets.from > targets.to) return;
    from = std::min(from, 2 * targets.from);
    to = std::max(to, 2 * targets.to);
  }

  void ask_targets(int m, double step, const Lanes* nodes) {
    const Range targets = targets_at(step);
    std::size_t nearest = 0;
    for (int n = targets.from; n <= targets.to; ++n) {
      const auto off = [&](std::size_t i) { return std::abs(next_[i] - n); };
      while (nearest + 1 < rays_.size() && off(nearest + 1) < off(nearest)) ++nearest;
      const int major = base_major_ + m / 2, minor = base_minor_ + n;
      seen_.at(side_.transposed ? major : minor, side_.transposed ? minor : major) =
          ask(nearest, {0.5 * m, static_cast<double>(n), rays_[nearest].path.distance(step), nodes[2 * n]});
    }
  }

  // The ground between the ray's last place and the target is drawn where that may decide.
  std::uint16_t ask(std::size_t i, const RayPlace& target) const {
    const Ray& ray = rays_[i];
    const auto height = static_cast<float>(view_.target_height_);
    const auto per_s = static_cast<float>(1 / target.s), drop = static_cast<float>(ray.per_2r * target.s);
    const std::uint16_t seen = seen_over(horizons_[i], target.ground, height, eye_, per_s, drop);
    if (seen == 0) return 0;
    Lanes horizon = horizons_[i];
    fine_.raise(ray.place, target, kDepthAtTarget, {eye_, ray.per_2r}, horizon);
    return seen_over(horizon, target.ground, height, eye_, per_s, drop);
  }

  const ProbableView& view_;
  const Side side_;
  SeenBits& seen_;
  RealisedColumns columns_;
  const FineGround fine_;
  const Lanes eye_;
  const int base_major_, base_minor_;
  // From here on places are in samples from the eye's base sample: whatever window is in memory, they are the
  // same.
  const double major_, minor_;  // of the eye
  const int first_minor_, last_minor_;
  int first_ray_ = 0, own_from_ = 0, own_to_ = 0;
  bool first_of_side_ = false, last_of_side_ = false;
  std::vector<Ray> rays_;
  std::vector<double> next_;  // where each ray crosses the line at hand, samples
  int steps_ = 0;
  std::vector<Lanes> horizons_;
};

ProbableView::ProbableView(const OpenTerrain& terrain, const ProbableEye& eye, double target_height,
                           double bend)
    : terrain_(terrain), eye_(eye), target_height_(target_height), bend_(bend) {
  for (const bool transposed : {false, true}) {
    for (const int sign : {1, -1}) {
      const double reach = reach_of(eye, transposed, sign);
      if (reach <= 0) continue;
      const int rays = 2 * static_cast<int>(std::ceil(kRaysOfSample * reach)) + 1;
      for (int first = 0; first < rays; first += kRaysOfBlock)
        blocks_.push_back({{transposed, sign}, first, std::min(kRaysOfBlock, rays - first), rays});
    }
  }
}

// The ground in the eye's place: between the four nodes around.
Lanes ProbableView::eye_heights(std::uint32_t first_realisation) const {
  RealisedColumns columns(terrain_, false, first_realisation);
  const double col = 2 * eye_.frame->col(), row = 2 * eye_.frame->row();
  const int c = 2 * eye_.base_col + static_cast<int>(col), r = 2 * eye_.base_row + static_cast<int>(row);
  const int c1 = std::min(c + 1, columns.majors() - 1), r1 = std::min(r + 1, columns.minors() - 1);
  const auto u = static_cast<float>(col - std::floor(col)), v = static_cast<float>(row - std::floor(row));
  Lanes sum{};
  for (const auto& [line, part] : {std::pair{c, 1 - u}, std::pair{c1, u}}) {
    if (part == 0) continue;
    const Lanes* nodes = columns.nodes(line, r, r1);
    for (int l = 0; l < kLanes; ++l)
      sum.v[l] += part * (v == 0 ? nodes[r].v[l] : (1 - v) * nodes[r].v[l] + v * nodes[r1].v[l]);
  }
  for (float& height : sum.v) height += static_cast<float>(eye_.height);
  return sum;
}

void ProbableView::march(std::size_t block, std::uint32_t first_realisation, SeenBits& seen) const {
  March(*this, blocks_[block], first_realisation, seen).run();
}

}  // namespace sightbound
