// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/fan_block.h"

namespace sightbound {

double reach_of_side(const Scene& scene, const Eye& eye, bool transposed, int sign) {
  const double major = transposed ? eye.frame->row() : eye.frame->col();
  const int base = transposed ? eye.base_row : eye.base_col;
  const int majors = transposed ? scene.heights.rows() : scene.heights.cols();
  return sign > 0 ? majors - 1 - base - major : major + base;
}

double Fan3::bend() const {
  constexpr double kSafety = 2;  // on the error of interpolating between two geodesics, measured half way
  return kSafety * std::abs(middle - (a + b) / 2);
}

FanColumns::FanColumns(const Scene& scene, const Eye& eye, const FanBlock& block) : block_(block) {
  const double low = static_cast<double>(block.index) / kBlocksPerUnit, width = 1.0 / kBlocksPerUnit;
  for (std::size_t i = 0; i < 3; ++i) {
    rays_[i] =
        eye.frame->ray(block.transposed, block.sign, low + static_cast<double>(i) * width / 2, block.reach);
  }
  base_major_ = block.transposed ? eye.base_row : eye.base_col;
  base_minor_ = block.transposed ? eye.base_col : eye.base_row;
  major0_ = block.transposed ? eye.frame->row() : eye.frame->col();
  minor0_ = block.transposed ? eye.frame->col() : eye.frame->row();
  majors_ = block.transposed ? scene.heights.rows() : scene.heights.cols();
  minors_ = block.transposed ? scene.heights.cols() : scene.heights.rows();
  frame_pad_ = 2 * eye.frame->error_cells();
  bound_curvature(scene, eye);
}

int FanColumns::first_major() const {
  return block_.sign > 0 ? static_cast<int>(std::floor(major0_)) + 1
                         : static_cast<int>(std::ceil(major0_)) - 1;
}

// bend D^2 / 2R over D^2: within the block it varies by a per mille.
void FanColumns::bound_curvature(const Scene& scene, const Eye& eye) {
  double low = 1e300, high = 0;
  for (const GeodesicRay& ray : rays_) {
    for (const double share : {0.02, 0.25, 0.5, 0.75, 1.0}) {
      const double step = share * block_.reach, major = major0_ + block_.sign * step, minor = ray.minor(step);
      if (share > 0.02 && (minor < -base_minor_ || minor > minors_ - 1 - base_minor_)) continue;
      const FramePlace at = block_.transposed ? eye.frame->at(minor, major) : eye.frame->at(major, minor);
      const double square = at.east * at.east + at.north * at.north;
      low = std::min(low, at.bulge / square);
      high = std::max(high, at.bulge / square);
    }
  }
  const double margin = (high - low) / 2 + 1e-6 * high;
  curvature_low_ = scene.bend * std::max(low - margin, 0.0);
  curvature_high_ = scene.bend * (high + margin);
}

ColumnPlace FanColumns::place(int major) const {
  ColumnPlace p;
  p.major = major;
  p.step = std::max(block_.sign * (major - major0_), 0.0);
  const auto three = [](auto f) { return Fan3{f(0), f(1), f(2)}; };
  p.minor = three([&](std::size_t i) { return rays_[i].minor(p.step); });
  const std::array distance{rays_[0].distance(p.step), rays_[1].distance(p.step), rays_[2].distance(p.step)};
  p.distance = three([&](std::size_t i) { return distance[i]; });
  p.tau = three([&](std::size_t i) { return distance[i] / rays_[i].metres_per_step(); });
  p.square = three([&](std::size_t i) { return distance[i] * distance[i]; });
  return p;
}

bool FanColumns::is_off_grid(const ColumnPlace& p) const {
  return p.minor.high() + base_minor_ < -2 || p.minor.low() + base_minor_ > minors_ + 1;
}

RowRange FanColumns::targets_at(const ColumnPlace& here) const {
  int low = static_cast<int>(std::ceil(here.minor.a)), high = static_cast<int>(std::ceil(here.minor.b));
  const auto mine = [&](int minor) {
    const double off = std::abs(minor - minor0_), along = std::abs(here.major - major0_);
    return block_.transposed ? off < along : off <= along;
  };
  low = std::max(low, -base_minor_);
  high = std::min(high, minors_ - base_minor_);
  while (low < high && !mine(low)) ++low;
  while (low < high && !mine(high - 1)) --high;
  return {low, high};
}

Linear FanColumns::drop(const ColumnPlace& p, int wedges, double curvature, int side) const {
  const double step = (p.square.b - p.square.a) / wedges;
  const double slack = std::abs(step) + p.square.bend();
  return {static_cast<float>(curvature * (p.square.a + side * slack)), static_cast<float>(curvature * step)};
}

}  // namespace sightbound
