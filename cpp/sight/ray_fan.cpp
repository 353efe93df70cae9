// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/ray_fan.h"

#include <algorithm>
#include <cmath>

namespace sightbound {

namespace {

constexpr int kRaysOfBlock = 64;
constexpr double kRaysOfSample = 2;  // at the far end

// In samples along the major axis.
double reach_of(const ProbableEye& eye, bool transposed, int sign) {
  const double at = transposed ? eye.base_row + eye.frame->row() : eye.base_col + eye.frame->col();
  const int first = transposed ? eye.reach.row : eye.reach.col;
  const int last = (transposed ? eye.reach.row_end() : eye.reach.col_end()) - 1;
  return sign > 0 ? last - at : at - first;
}

}  // namespace

std::vector<RayBlock> ray_blocks(const ProbableEye& eye) {
  std::vector<RayBlock> blocks;
  for (const bool transposed : {false, true}) {
    for (const int sign : {1, -1}) {
      const double reach = reach_of(eye, transposed, sign);
      if (reach <= 0) continue;
      const int rays = 2 * static_cast<int>(std::ceil(kRaysOfSample * reach)) + 1;
      for (int first = 0; first < rays; first += kRaysOfBlock)
        blocks.push_back({transposed, sign, first, std::min(kRaysOfBlock, rays - first), rays});
    }
  }
  return blocks;
}

std::optional<RowCrossing> row_between(const RayPlace& a, const RayPlace& b) {
  const double low = 2 * std::min(a.minor, b.minor), high = 2 * std::max(a.minor, b.minor);
  const double node = std::ceil(high) - 1;
  if (node <= low) return {};
  const double part = (node / 2 - a.minor) / (b.minor - a.minor);
  return RowCrossing{{a.major + part * (b.major - a.major), node / 2, a.s + part * (b.s - a.s)},
                     static_cast<int>(node),
                     part};
}

RayFan::RayFan(const OpenTerrain& terrain, const ProbableEye& eye, double bend, const RayBlock& block)
    : transposed_(block.transposed),
      sign_(block.sign),
      base_major_(transposed_ ? eye.base_row : eye.base_col),
      base_minor_(transposed_ ? eye.base_col : eye.base_row),
      major_(transposed_ ? eye.frame->row() : eye.frame->col()),
      minor_(transposed_ ? eye.frame->col() : eye.frame->row()),
      first_of_side_(block.first == 0),
      last_of_side_(block.first + block.count == block.rays) {
  const int majors = transposed_ ? terrain.mean.rows() : terrain.mean.cols(),
            minors = transposed_ ? terrain.mean.cols() : terrain.mean.rows();
  first_minor_ = -base_minor_;
  last_minor_ = minors - 1 - base_minor_;
  first_major_ =
      sign_ > 0 ? static_cast<int>(std::floor(2 * major_)) + 1 : static_cast<int>(std::ceil(2 * major_)) - 1;
  const int last_major = sign_ > 0 ? 2 * (majors - 1 - base_major_) : -2 * base_major_;
  lines_ = std::max(sign_ * (last_major - first_major_) + 1, 0);

  const double reach = reach_of(eye, transposed_, sign_);
  const int first = std::max(block.first - 1, 0), end = std::min(block.first + block.count + 1, block.rays);
  own_from_ = block.first - first;
  own_to_ = own_from_ + block.count - 1;
  for (int i = first; i < end; ++i)
    add_ray(eye, bend, block.rays > 1 ? 2.0 * i / (block.rays - 1) - 1 : 0, reach);
}

void RayFan::add_ray(const ProbableEye& eye, double bend, double slope, double reach) {
  const ObserverFrame& frame = *eye.frame;
  // Of the part of the ray within reach, the far end.
  const Window& all = eye.reach;
  const int first = (transposed_ ? all.col : all.row) - base_minor_,
            last = (transposed_ ? all.col_end() : all.row_end()) - 1 - base_minor_;
  double step = reach;
  if (slope > 0) step = std::min(step, std::max((last - minor_) / slope, 0.5));
  if (slope < 0) step = std::min(step, std::max((first - minor_) / slope, 0.5));
  const GeodesicRay path = frame.ray(transposed_, sign_, slope, reach);
  const double end_minor = path.minor(step), end_major = major_ + sign_ * step;
  const FramePlace end = transposed_ ? frame.at(end_minor, end_major) : frame.at(end_major, end_minor);
  const double d = end.distance();
  rays_.push_back({path, d > 0 ? bend * end.bulge / (d * d) : 0});
}

RayFan::Range RayFan::targets(int line, const std::vector<double>& minors) const {
  const double step = steps_to(line);
  const auto between = [&](int i) { return 0.5 * (minors[at(i)] + minors[at(i + 1)]); };
  double low = minor_ - step, high = minor_ + step;
  if (!first_of_side_) low = std::max(low, between(own_from_ - 1));
  if (!last_of_side_) high = std::min(high, between(own_to_));
  // A target half-way between two blocks belongs to the second; one on a diagonal to the side of columns.
  int from = static_cast<int>(std::ceil(low)) - (first_of_side_ ? 1 : 0);
  int to = last_of_side_ ? static_cast<int>(std::floor(high)) + 1 : static_cast<int>(std::ceil(high)) - 1;
  const auto owns = [&](int n) {
    const double off = std::abs(n - minor_);
    return transposed_ ? off < step : off <= step;
  };
  while (from <= to && !owns(from)) ++from;
  while (to >= from && !owns(to)) --to;
  return {std::max(from, first_minor_), std::min(to, last_minor_)};
}

}  // namespace sightbound
