// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightbound {

double SurfaceFace::nearest_corner_in_plan(double x, double y) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Xyz& p : corner) {
    const double dx = x - p.x, dy = y - p.y;
    const double u = to_ground[0] * dx + to_ground[1] * dy, v = to_ground[2] * dx + to_ground[3] * dy;
    least = std::min(least, u * u + v * v);
  }
  return std::sqrt(least);
}

double SurfaceFace::nearest_corner_in_space(const Xyz& place) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Xyz& p : corner) least = std::min(least, dot(place - p, place - p));
  return std::sqrt(least);
}

SurfacePlace place_on(const SurfaceFace& face, const GrowthProfile& profile, double x, double y) {
  const Xyz &p = face.corner[0], a = face.corner[1] - p, b = face.corner[2] - p;
  const double area = a.x * b.y - a.y * b.x;
  const double v = ((x - p.x) * b.y - (y - p.y) * b.x) / area, w = (a.x * (y - p.y) - a.y * (x - p.x)) / area;
  const auto linear = [&](const std::array<double, 3>& at) {
    return at[0] + v * (at[1] - at[0]) + w * (at[2] - at[0]);
  };
  SurfacePlace place;
  place.height = p.z + v * a.z + w * b.z;
  place.sampling = linear(face.sampling);
  const double amplitude = std::max(linear(face.amplitude), 0.0);
  if (amplitude > 0) place.between = amplitude * profile(face.nearest_corner_in_plan(x, y), amplitude);
  return place;
}

}  // namespace sightbound
