// SPDX-License-Identifier: GPL-3.0-or-later
// Notation: t = share of the line; zone = within 1.5 L of an end; d = distance to the nearest sample.
#include "sight/volume_sight.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sight/line_ends.h"
#include "volume/triangle.h"

namespace sightbound {

namespace {

// Of an edge's length: a crossing this far beyond its ends is one of its ends.
constexpr double kAtCorner = 1e-9;
// Share of a zone that may lie in no face, for rounding.
constexpr double kUncovered = 1e-6;

double plan_length(const VolumeLine& line) {
  return std::hypot(line.to.x - line.from.x, line.to.y - line.from.y);
}
double length_in(const VolumeLine& line, Metric metric) {
  const double plan = plan_length(line);
  return metric == Metric::kVertical ? plan : std::hypot(plan, line.to.z - line.from.z);
}

RatioInterval lesser(const RatioInterval& a, const RatioInterval& b) {
  return {std::min(a.low, b.low), std::min(a.high, b.high)};
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
    const Xyz at = line_.at(t);
    const SurfacePlace ground = place_on(face_, profile_, at.x, at.y);
    return (at.z - ground.height) / std::max(ground.between, kLeastSigma);
  }

 private:
  void add(double t) { t_[static_cast<std::size_t>(count_++)] = t; }

  const SurfaceFace& face_;
  const GrowthProfile& profile_;
  const VolumeLine& line_;
  std::array<double, 3> t_{};
  int count_ = 0;
};

// Does the segment meet the triangle?
bool meets(const Xyz& from, const Xyz& to, const std::array<Xyz, 3>& corner) {
  const Xyz along = to - from, e1 = corner[1] - corner[0], e2 = corner[2] - corner[0];
  const Xyz p = cross(along, e2);
  const double area = dot(e1, p);
  if (area == 0) return false;  // parallel: it meets a neighbour, or nothing
  const Xyz s = from - corner[0], q = cross(s, e1);
  const double u = dot(s, p) / area, v = dot(along, q) / area, t = dot(e2, q) / area;
  return u >= -kAtCorner && v >= -kAtCorner && u + v <= 1 + kAtCorner && t >= 0 && t <= 1;
}

}  // namespace

EndZone::EndZone(const Surface& surface, const Xyz& place) : surface_(&surface), place_(place) {
  find_faces();
}

void EndZone::move_to_height(double z) {
  if (z == place_.z) return;
  place_.z = z;
  if (surface_->metric() == Metric::kNormal) find_faces();
}

void EndZone::find_faces() {
  const Surface& surface = *surface_;
  const Xyz& place = place_;
  const double reach = kEndZoneCells * surface.spacing_m();
  constexpr double kAnyHeight = 1e6;
  const double up = surface.metric() == Metric::kVertical ? kAnyHeight : reach;
  faces_.clear();
  std::vector<std::uint32_t> near;
  surface.faces_near(
      {{place.x - reach, place.y - reach, place.z - up}, {place.x + reach, place.y + reach, place.z + up}},
      near);
  for (const std::uint32_t number : near) {
    if (const auto face = surface.face(number)) faces_.push_back(*face);
  }
}

RatioInterval EndZone::least(const VolumeLine& line, bool from_start, float beyond) const {
  const double length = length_in(line, surface_->metric()), cell = surface_->spacing_m() / length;
  const double zone = std::min(kEndZoneCells * cell, 1.0), end = kAtEnd * cell;
  const double t0 = from_start ? end : std::max(1 - zone, end),
               t1 = from_start ? std::min(zone, 1 - end) : 1 - end;
  if (!(t0 < t1)) return {beyond, beyond};
  return surface_->metric() == Metric::kVertical ? least_in_plan(line, t0, t1, from_start, beyond)
                                                 : least_in_space(line, t0, t1, from_start, beyond);
}

RatioInterval EndZone::least_in_plan(const VolumeLine& line, double t0, double t1, bool from_start,
                                     float beyond) const {
  const double cell = surface_->spacing_m() / plan_length(line);
  std::array<double, kEndPlaces.size()> places;
  for (std::size_t n = 0; n < places.size(); ++n)
    places[n] = from_start ? kEndPlaces[n] * cell : 1 - kEndPlaces[n] * cell;
  double least = static_cast<double>(beyond), covered = 0;
  for (const SurfaceFace& face : faces_) {
    const FaceUnder under(face, surface_->profile(), line);
    if (under.crossings() < 2) continue;
    covered += std::max(std::min(under.to(), t1) - std::max(under.from(), t0), 0.0);
    for (int n = 0; n < under.crossings(); ++n) {
      const double t = under.crossing(n);
      if (t > t0 && t <= t1) least = std::min(least, under.ratio(t));
    }
    for (const double t : places) {
      if (t > t0 && t < t1 && t >= under.from() && t <= under.to()) least = std::min(least, under.ratio(t));
    }
  }
  // Ground that is not there is unknown.
  if (covered < (t1 - t0) * (1 - kUncovered)) least = std::min(least, 0.0);
  const double k = std::clamp(least, -static_cast<double>(beyond), static_cast<double>(beyond));
  return {static_cast<float>(k), static_cast<float>(k)};
}

// A line that meets no face keeps its clearance; one that does is through the surface, how far is left open.
RatioInterval EndZone::least_in_space(const VolumeLine& line, double t0, double t1, bool from_start,
                                      float beyond) const {
  const Xyz from = line.at(t0), to = line.at(t1);
  const double length = length_in(line, Metric::kNormal);
  double least = static_cast<double>(beyond);
  for (const SurfaceFace& face : faces_) {
    if (meets(from, to, face.corner)) return {-beyond, 0};
    if (!surface_->has_between()) continue;
    for (const double share : kEndPlaces) {
      const double s = share * surface_->spacing_m() / length, t = from_start ? s : 1 - s;
      if (t <= t0 || t >= t1) continue;
      const Xyz at = line.at(t), near = closest_on(face.corner, at);
      const double amplitude = *std::max_element(face.amplitude.begin(), face.amplitude.end());
      const double sigma = std::max(
          amplitude * surface_->profile()(face.nearest_corner_in_space(near), amplitude), kLeastSigma);
      const Xyz apart = at - near;
      least = std::min(least, std::sqrt(dot(apart, apart)) / sigma);
    }
  }
  return {static_cast<float>(least), beyond};
}

VolumeSight::VolumeSight(const VolumeRays& rays, const GroundBend& bend) : rays_(rays), bend_(bend) {}

RatioInterval VolumeSight::ratio(const EndZone& observer, const EndZone& target) const {
  const Xyz &from = observer.place(), &to = target.place();
  const VolumeLine line{from, to, bend_.drop(to.x - from.x, to.y - from.y)};
  const Surface& surface = rays_.volume().surface();
  const float beyond = rays_.volume().beyond_ratio();
  const double length = length_in(line, surface.metric());
  if (length == 0) return {beyond, beyond};
  RatioInterval k = lesser(observer.least(line, true, beyond), target.least(line, false, beyond));
  const double zone = kEndZoneCells * surface.spacing_m() / length;
  if (k.high > -static_cast<float>(rays_.volume().largest_ratio()) && zone < 0.5) {
    k = lesser(k, rays_.least(line, zone, 1 - zone));
  }
  return k;
}

double proven_probability(const RatioInterval& k) {
  if (k.low > 0) return normal_cdf(static_cast<double>(k.low));
  return k.high < 0 ? normal_cdf(static_cast<double>(k.high)) : 0.5;
}

}  // namespace sightbound
