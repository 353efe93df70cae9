// SPDX-License-Identifier: GPL-3.0-or-later
// A face under a line, in plan (height fields). Internal to cpp/sight.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "volume/surface.h"
#include "volume/volume_ray.h"

namespace sightbound {

// Of an edge's length: a crossing this far beyond its ends is one of its ends.
inline constexpr double kAtCorner = 1e-9;
// Share of a zone that may lie in no face, for rounding.
inline constexpr double kUncovered = 1e-6;

// As d is measured: in plan for height fields, else in space.
inline double length_in(const VolumeLine& line, Metric metric) {
  const double plan = plan_length(line);
  return metric == Metric::kVertical ? plan : std::hypot(plan, line.to.z - line.from.z);
}

// Where a line runs within a triangle in plan: t, and the height and sigma_g of the ground there.
class FaceUnder {
 public:
  FaceUnder(const SurfaceFace& face, const GrowthProfile& profile, const VolumeLine& line)
      : face_(face), profile_(profile), line_(line) {
    const double dx = line.to.x - line.from.x, dy = line.to.y - line.from.y;
    for (std::size_t n = 0; n < 3; ++n) {
      const Xyz &a = face.corner[n], &b = face.corner[(n + 1) % 3];
      const double ex = b.x - a.x, ey = b.y - a.y, cross = dx * ey - dy * ex;
      if (cross == 0) continue;
      const double ax = a.x - line.from.x, ay = a.y - line.from.y;
      const double along = (ax * dy - ay * dx) / cross;
      if (along < -kAtCorner || along > 1 + kAtCorner) continue;
      add((ax * ey - ay * ex) / cross);
    }
  }

  int crossings() const { return count_; }
  double crossing(int n) const { return t_[static_cast<std::size_t>(n)]; }
  double from() const { return count_ > 0 ? *std::min_element(t_.begin(), t_.begin() + count_) : 2; }
  double to() const { return count_ > 0 ? *std::max_element(t_.begin(), t_.begin() + count_) : -2; }

  double ratio(double t) const {
    const SurfacePlace ground = at(t);
    return (line_.height(t) - ground.height) / std::max(ground.between, kLeastSigma);
  }
  double clearance(double t) const { return line_.height(t) - at(t).height; }

 private:
  void add(double t) { t_[static_cast<std::size_t>(count_++)] = t; }
  SurfacePlace at(double t) const {
    const Xyz place = line_.at(t);
    return place_on(face_, profile_, place.x, place.y);
  }

  const SurfaceFace& face_;
  const GrowthProfile& profile_;
  const VolumeLine& line_;
  std::array<double, 3> t_{};
  int count_ = 0;
};

}  // namespace sightbound
