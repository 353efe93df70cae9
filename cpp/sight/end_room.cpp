// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/end_room.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sight/face_under.h"
#include "sight/line_ends.h"
#include "volume/dem_surface.h"
#include "volume/error_volume.h"
#include "volume/triangle.h"

namespace sightbound {

namespace {

// Bundles whose lines differ more in length, or move more within the zone (cells), are left to smaller boxes.
constexpr double kMostUneven = 1.25, kMostMoved = 0.25;
constexpr int kSteps = 32;           // along an end zone in space
constexpr double kStepsInCell = 16;  // along one in plan

double plan_norm(const Xyz& a) { return std::hypot(a.x, a.y); }

Xyz greater(const Xyz& a, const Xyz& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

Xyz moved_at(const LineBundle& bundle, double t) {
  Xyz moved = (1 - t) * bundle.from_room + t * bundle.to_room;
  moved.z += bundle.drop_spread;
  return moved;
}

// The part of every line that lies in the end zone of one of them.
LinePart zone_of_any(const LineBundle& bundle, double spacing_m, bool from_start) {
  const double zone = std::min(kEndZoneCells * spacing_m / bundle.shortest, 1.0),
               end = kAtEnd * spacing_m / bundle.longest;
  return from_start ? LinePart{end, std::min(zone, 1 - end)} : LinePart{std::max(1 - zone, end), 1 - end};
}

// Slopes along x and y, without sign.
Xy slopes_of(const SurfaceFace& face) {
  const Xyz normal = cross(face.corner[1] - face.corner[0], face.corner[2] - face.corner[0]);
  constexpr double kVertical = std::numeric_limits<double>::infinity();
  if (normal.z == 0) return {kVertical, kVertical};
  return {std::abs(normal.x / normal.z), std::abs(normal.y / normal.z)};
}

// sigma_g is not above this anywhere on the face. No place of a triangle is farther from all corners than the
// longest side over sqrt(3).
double most_between(const SurfaceFace& face, const GrowthProfile& profile) {
  const double amplitude = *std::max_element(face.amplitude.begin(), face.amplitude.end());
  if (!(amplitude > 0)) return 0;
  double longest = 0;
  for (std::size_t n = 0; n < 3; ++n) {
    const Xyz side = face.corner[(n + 1) % 3] - face.corner[n];
    const auto& m = face.to_ground;
    longest = std::max(
        {longest, norm(side), std::hypot(m[0] * side.x + m[1] * side.y, m[2] * side.x + m[3] * side.y)});
  }
  return amplitude * profile(longest / std::numbers::sqrt3, amplitude);
}

// Is there a place without ground under one of the lines?
bool any_unknown(const ErrorVolume& volume, const LineBundle& bundle, const LinePart& part) {
  const PlanMask& unknown = volume.unknown_columns();
  const auto voxel = [&](double at) { return static_cast<int>(std::floor(at / volume.voxel_m())); };
  const Xyz a = bundle.middle.at(part.begin), b = bundle.middle.at(part.end);
  const Xyz at_a = moved_at(bundle, part.begin), at_b = moved_at(bundle, part.end);
  const double x = std::max(at_a.x, at_b.x), y = std::max(at_a.y, at_b.y);
  const int i0 = voxel(std::min(a.x, b.x) - x), i1 = voxel(std::max(a.x, b.x) + x),
            j0 = voxel(std::min(a.y, b.y) - y), j1 = voxel(std::max(a.y, b.y) + y);
  for (int j8 = j0 >> 3; j8 <= j1 >> 3; ++j8) {
    for (int i8 = i0 >> 3; i8 <= i1 >> 3; ++i8) {
      if (unknown.of_8(i8, j8) == PlanState::kNone) continue;
      for (int j = std::max(j0, 8 * j8); j <= std::min(j1, 8 * j8 + 7); ++j) {
        for (int i = std::max(i0, 8 * i8); i <= std::min(i1, 8 * i8 + 7); ++i) {
          if (unknown.at(i, j)) return true;
        }
      }
    }
  }
  return false;
}

}  // namespace

EndRoom::EndRoom(const ErrorVolume& volume, const Xyz& middle, const Xyz& room)
    : volume_(&volume), surface_(&volume.surface()), middle_(middle), room_(room) {
  const bool vertical = surface_->metric() == Metric::kVertical;
  constexpr double kAnyHeight = 1e6;
  const double reach = (kEndZoneCells * kMostUneven + kMostMoved) * surface_->spacing_m() +
                       (vertical ? plan_norm(room) : norm(room));
  const double up = vertical ? kAnyHeight : reach;
  std::vector<std::uint32_t> near;
  surface_->faces_near({{middle.x - reach, middle.y - reach, middle.z - up},
                        {middle.x + reach, middle.y + reach, middle.z + up}},
                       near);
  for (const std::uint32_t number : near) {
    const auto face = surface_->face(number);
    if (!face) continue;
    const Xy slopes = slopes_of(*face);
    rise_x_ = std::max(rise_x_, slopes.x);
    rise_y_ = std::max(rise_y_, slopes.y);
    most_between_ = std::max(most_between_, most_between(*face, surface_->profile()));
    amplitude_ = std::max(amplitude_, *std::max_element(face->amplitude.begin(), face->amplitude.end()));
    faces_.push_back(*face);
  }
  most_between_ = std::max(most_between_, kLeastSigma);
  is_dem_ = dynamic_cast<const DemSurface*>(surface_) != nullptr;
}

bool EndRoom::tells(const LineBundle& bundle, bool from_start) const {
  if (!(bundle.shortest > 0) || bundle.longest > kMostUneven * bundle.shortest) return false;
  const double spacing = surface_->spacing_m();
  const LinePart zone = zone_of_any(bundle, spacing, from_start);
  const Xyz moved = from_start ? zone.end * bundle.to_room : (1 - zone.begin) * bundle.from_room;
  if (!(zone.begin < zone.end && norm(moved) <= kMostMoved * spacing)) return false;
  return surface_->metric() == Metric::kNormal || !any_unknown(*volume_, bundle, zone);
}

bool EndRoom::clear(const LineBundle& bundle, bool from_start, double ratio) const {
  if (!tells(bundle, from_start)) return false;
  const LinePart zone = zone_of_any(bundle, surface_->spacing_m(), from_start);
  return surface_->metric() == Metric::kVertical ? clear_in_plan(bundle, zone, ratio)
                                                 : clear_in_space(bundle, zone, ratio);
}

bool EndRoom::clear_in_plan(const LineBundle& bundle, const LinePart& zone, double ratio) const {
  const double length = zone.end - zone.begin, step = surface_->spacing_m() / kStepsInCell / bundle.longest;
  // Between two places the curve of the line is below its chord by this much at most.
  const double sag = bundle.middle.drop * step * step / 4;
  double covered = 0;
  for (const SurfaceFace& face : faces_) {
    const FaceUnder under(face, surface_->profile(), bundle.middle);
    const double a = std::max(under.from(), zone.begin), b = std::min(under.to(), zone.end);
    if (under.crossings() < 2 || !(a <= b)) continue;
    covered += b - a;
    const int steps = static_cast<int>(std::ceil((b - a) / step)) + 1;
    for (int n = 0; n < steps; ++n) {
      const double t0 = a + (b - a) * n / steps, t1 = a + (b - a) * (n + 1) / steps;
      const Xyz moved = greater(moved_at(bundle, t0), moved_at(bundle, t1));
      const double least = std::min(under.clearance(t0), under.clearance(t1)) - sag - rise(moved);
      const Xyz middle = bundle.middle.at((t0 + t1) / 2);
      const double aside = (t1 - t0) / 2 * bundle.longest + plan_norm(moved);
      if (!(least >= ratio * between_around(face, middle, aside))) return false;
    }
  }
  return covered >= length * (1 - kUncovered);
}

// sigma_g is not above this within `aside` of the place. The distance to the nearest sample of a DEM is
// continuous over its faces, and changes no faster than the place.
double EndRoom::between_around(const SurfaceFace& face, const Xyz& place, double aside) const {
  if (!is_dem_) return most_between_;
  const auto& m = face.to_ground;
  const double stretch = std::hypot(std::hypot(m[0], m[1]), std::hypot(m[2], m[3]));
  const double d = face.nearest_corner_in_plan(place.x, place.y) + stretch * aside;
  return std::max(std::min(amplitude_ * surface_->profile()(d, amplitude_), most_between_), kLeastSigma);
}

bool EndRoom::clear_in_space(const LineBundle& bundle, const LinePart& zone, double ratio) const {
  const double step = (zone.end - zone.begin) / kSteps;
  const double between_steps = step * bundle.longest / 2;
  for (int n = 0; n <= kSteps; ++n) {
    const double t = zone.begin + n * step;
    const Xyz at = bundle.middle.at(t);
    const double needed = ratio * most_between_ + norm(moved_at(bundle, t)) + between_steps;
    for (const SurfaceFace& face : faces_) {
      if (!(norm(at - closest_on(face.corner, at)) >= needed)) return false;
    }
  }
  return true;
}

bool EndRoom::blocked(const LineBundle& bundle, bool from_start, double ratio) const {
  if (surface_->metric() != Metric::kVertical || !tells(bundle, from_start)) return false;
  const double zone = std::min(kEndZoneCells * surface_->spacing_m() / bundle.longest, 1.0),
               end = kAtEnd * surface_->spacing_m() / bundle.shortest;
  const LinePart part = from_start ? LinePart{end, zone} : LinePart{1 - zone, 1 - end};
  for (const SurfaceFace& face : faces_) {
    const FaceUnder under(face, surface_->profile(), bundle.middle);
    for (int n = 0; n < under.crossings(); ++n) {
      const double t = under.crossing(n);
      if (t < part.begin || t > part.end) continue;
      if (under.clearance(t) + rise(moved_at(bundle, t)) <= -ratio * most_between_) return true;
    }
  }
  return false;
}

}  // namespace sightbound
