// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/end_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "volume/triangle.h"

namespace sightbound {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Of an edge's length: a crossing this far beyond it is on it.
constexpr double kAtCorner = 1e-9;
// Crossings nearer to one another, metres, are one: at an edge both faces are met.
constexpr double kSamePlace = 1e-7;
// How often the way from a crossing is halved in search of places well beside it, but not past a border.
constexpr int kHalvings = 12;

// Where the segment meets the triangle. Moeller and Trumbore 1997.
std::optional<double> meets(const Xyz& from, const Xyz& along, const std::array<Xyz, 3>& corner) {
  const Xyz e1 = corner[1] - corner[0], e2 = corner[2] - corner[0], p = cross(along, e2);
  const double area = dot(e1, p);
  if (area == 0) return std::nullopt;  // parallel: it meets a neighbour, or nothing
  const Xyz s = from - corner[0], q = cross(s, e1);
  const double u = dot(s, p) / area, v = dot(along, q) / area, t = dot(e2, q) / area;
  if (!(u >= -kAtCorner && v >= -kAtCorner && u + v <= 1 + kAtCorner && t >= 0 && t <= 1))
    return std::nullopt;
  return t;
}

Box3 box_around(const Xyz& place, double reach) {
  const Xyz half{reach, reach, reach};
  return {place - half, place + half};
}

}  // namespace

EndFaces::EndFaces(const TinSurface& surface, const Xyz& place, double reach)
    : surface_(&surface), place_(place), reach_(reach) {
  surface.faces_near(box_around(place, reach), faces_);
  inside_ = surface.sides() == Sides::kSolid && lies_inside(place);
}

std::vector<EndFaces::Crossing> EndFaces::crossings(const Part& part,
                                                    const std::vector<std::uint32_t>& faces) const {
  std::vector<Crossing> found;
  for (const std::uint32_t number : faces) {
    const std::array<Xyz, 3> corner = surface_->face(number)->corner;
    const std::optional<double> t = meets(part.from, part.along, corner);
    if (!t) continue;
    const double out = dot(part.along, cross(corner[1] - corner[0], corner[2] - corner[0]));
    found.push_back({*t, out > 0 ? 1 : -1});
  }
  std::sort(found.begin(), found.end(), [](const Crossing& a, const Crossing& b) { return a.t < b.t; });
  // Through an edge: once. Out and in at one place touches only: kept as 0.
  const double same = kSamePlace / length(part.along);
  std::vector<Crossing> merged;
  for (const Crossing& one : found) {
    if (merged.empty() || one.t - merged.back().t > same) {
      merged.push_back(one);
    } else if (one.turn != merged.back().turn) {
      merged.back().turn = 0;
    }
  }
  return merged;
}

// Looking towards the middle of the nearest face, the first face that is met tells.
bool EndFaces::lies_inside(const Xyz& place) const {
  const ClosestPlace near = surface_->closest(place);
  if (near.distance < kSamePlace) return false;  // on it
  const std::array<Xyz, 3> corner = surface_->face(near.face)->corner;
  const Xyz middle = (1.0 / 3) * (corner[0] + corner[1] + corner[2]);
  const Part look{place, (1 + kAtCorner) * (middle - place)};
  std::vector<std::uint32_t> between;
  const auto [west, east] = std::minmax(place.x, middle.x);
  const auto [south, north] = std::minmax(place.y, middle.y);
  const auto [low, high] = std::minmax(place.z, middle.z);
  surface_->faces_near({{west, south, low}, {east, north, high}}, between);
  const std::vector<Crossing> met = crossings(look, between);
  return !met.empty() && met.front().turn > 0;
}

double EndFaces::between(std::size_t number, const Xyz& on_it) const {
  if (!surface_->has_between()) return kLeastSigma;
  const SurfaceFace face = *surface_->face(number);
  const double amplitude = *std::max_element(face.amplitude.begin(), face.amplitude.end());
  return std::max(amplitude * surface_->profile()(face.nearest_corner_in_space(on_it), amplitude),
                  kLeastSigma);
}

double EndFaces::ratio(const Xyz& place) const {
  const ClosestPlace near = surface_->closest(place);
  return near.distance / between(near.face, near.place);
}

double EndFaces::least_ratio(const Xyz& place) const {
  double least = kInfinity, nearest = kInfinity;
  for (const std::uint32_t face : faces_) {
    const Xyz on_it = closest_on(surface_->face(face)->corner, place);
    const double distance = norm(place - on_it);
    nearest = std::min(nearest, distance);
    least = std::min(least, distance / between(face, on_it));
  }
  const Xyz off = place - place_;
  const double beside = reach_ - std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)});
  return nearest <= beside ? least : std::min(least, ratio(place));  // else another face may be nearest
}

double EndFaces::border_distance(const Xyz& place) const {
  const Xyz off = place - place_;
  double nearest = reach_ - std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)});
  for (const std::uint32_t number : faces_) {
    const std::array<Xyz, 3> corner = surface_->face(number)->corner;
    for (std::size_t i = 0; i < 3; ++i) {
      if (surface_->topology().neighbours[number][i] >= 0) continue;
      const Xyz edge = corner[(i + 1) % 3] - corner[i];
      const double share = std::clamp(dot(place - corner[i], edge) / dot(edge, edge), 0.0, 1.0);
      nearest = std::min(nearest, norm(place - corner[i] - share * edge));
    }
  }
  return nearest;
}

// The largest k of a place inside a solid.
double EndFaces::inside_by(const Part& part, const std::vector<Crossing>& met) const {
  double most = 0;
  for (std::size_t n = 0; n <= met.size(); ++n) {
    const bool entered = n > 0 && met[n - 1].turn < 0, leaves = n < met.size() && met[n].turn > 0;
    const bool outside = (n > 0 && !entered) || (n < met.size() && !leaves);
    if (outside || (met.empty() && !inside_)) continue;
    const double a = n > 0 ? met[n - 1].t : 0, b = n < met.size() ? met[n].t : 1;
    for (const double share : {0.25, 0.5, 0.75}) most = std::max(most, ratio(part.at(a + share * (b - a))));
  }
  return most;
}

// The largest k that a line has on both sides of a sheet. What lies between two places r from where it goes
// through has its nearest place within 2 r of there.
double EndFaces::through_by(const Part& part, const std::vector<Crossing>& met) const {
  double most = 0;
  for (std::size_t n = 0; n < met.size(); ++n) {
    if (met[n].turn == 0) continue;
    const double border = border_distance(part.at(met[n].t)) / (2 * length(part.along));
    double before = 0, after = 0;
    double back = met[n].t - (n > 0 ? met[n - 1].t : 0),
           on = (n + 1 < met.size() ? met[n + 1].t : 1) - met[n].t;
    for (int half = 0; half < kHalvings; ++half, back /= 2, on /= 2) {
      if (back < border) before = std::max(before, ratio(part.at(met[n].t - back)));
      if (on < border) after = std::max(after, ratio(part.at(met[n].t + on)));
    }
    most = std::max(most, std::min(before, after));
  }
  return most;
}

RatioInterval EndFaces::least(const VolumeLine& line, double t0, double t1, const std::vector<double>& judged,
                              float beyond) const {
  const Part part{line.at(t0), line.at(t1) - line.at(t0)};
  const std::vector<Crossing> met = crossings(part, faces_);
  const bool solid = surface_->sides() == Sides::kSolid;
  if (!met.empty() || inside_) {
    const double k = solid ? inside_by(part, met) : through_by(part, met);
    return {-beyond, -static_cast<float>(std::min(k, static_cast<double>(beyond)))};
  }
  double least = static_cast<double>(beyond);
  if (surface_->has_between()) {
    for (const double t : judged) {
      if (t > t0 && t < t1) least = std::min(least, least_ratio(line.at(t)));
    }
  }
  return {static_cast<float>(least), beyond};
}

}  // namespace sightbound
