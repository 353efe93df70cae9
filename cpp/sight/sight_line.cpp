// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/sight_line.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sight/line_search.h"

namespace sightbound {

SightLine::SightLine(const Scene& scene, const Eye& eye, const Target& target)
    : scene_(scene),
      transposed_(std::abs(target.row - eye.frame->row()) > std::abs(target.col - eye.frame->col())),
      major_stride_(transposed_ ? scene.heights.cols() : 1),
      minor_stride_(transposed_ ? 1 : scene.heights.cols()),
      majors_(transposed_ ? scene.heights.rows() : scene.heights.cols()),
      minors_(transposed_ ? scene.heights.cols() : scene.heights.rows()),
      base_major_(transposed_ ? eye.base_row : eye.base_col),
      base_minor_(transposed_ ? eye.base_col : eye.base_row),
      major0_(transposed_ ? eye.frame->row() : eye.frame->col()),
      span_((transposed_ ? target.row : target.col) - major0_),
      eye_height_(eye.height),
      target_height_(target.height),
      eye_sampling_(eye.sampling),
      target_sampling_(target.sampling),
      place_(eye.frame_to(target.col, target.row).at(target.col, target.row)),
      distance_(place_.distance()),
      drop_(scene.bend * place_.bulge) {
  if (span_ != 0) path_ = eye.frame_to(target.col, target.row).path_to(target.col, target.row, transposed_);
}

double SightLine::elevation_deg() const {
  return std::atan2(target_height_ - drop_ - eye_height_, distance_) * 180 / std::numbers::pi;
}

Critical SightLine::settle(double hint) const {
  const MajorRange whole{std::numeric_limits<int>::min() / 2, std::numeric_limits<int>::max() / 2};
  return settle({&whole, 1}, hint);
}

Critical SightLine::settle(std::span<const MajorRange> open, double hint) const {
  if (span_ == 0) return {scene_.largest_ratio, -1, false};
  Search search(*this, LeastRatio(*this, -scene_.largest_ratio));
  search.within(open, hint);
  return {std::max(search.objective().best(), -scene_.largest_ratio), search.critical_xi(), search.hole()};
}

double SightLine::needed_height(double k, double floor, double& hint) const {
  if (span_ == 0) return floor;
  Search search(*this, NeededHeight(*this, k, floor));
  search.all(hint);
  hint = search.critical_xi();
  return search.objective().best();
}

void SightLine::for_each_place(const std::function<void(const JudgedPlace&)>& visit) const {
  if (span_ == 0) return;
  Places places(*this);
  places.every_place([&](const Stencil& stencil, bool outside, double d, double xi) {
    const JudgedPlace place = places.described(stencil, outside, d, xi);
    if (places.is_between(place.share)) visit(place);
  });
}

}  // namespace sightbound
