// SPDX-License-Identifier: GPL-3.0-or-later
// Notation: t = share of the line; zone = within 1.5 L of an end; d = distance to the nearest sample.
#include "sight/volume_sight.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sight/face_under.h"
#include "sight/line_ends.h"

namespace sightbound {

namespace {

RatioInterval lesser(const RatioInterval& a, const RatioInterval& b) {
  return {std::min(a.low, b.low), std::min(a.high, b.high)};
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
  if (surface.metric() == Metric::kNormal) {
    in_space_.emplace(dynamic_cast<const TinSurface&>(surface), place, reach);
    return;
  }
  constexpr double up = 1e6;  // any height
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

RatioInterval EndZone::least_in_space(const VolumeLine& line, double t0, double t1, bool from_start,
                                      float beyond) const {
  const double cell = surface_->spacing_m() / length_in(line, Metric::kNormal);
  std::vector<double> judged;
  for (const double share : kEndPlaces) judged.push_back(from_start ? share * cell : 1 - share * cell);
  return in_space_->least(line, t0, t1, judged, beyond);
}

VolumeSight::VolumeSight(const VolumeRays& rays, const GroundBend& bend) : rays_(rays), bend_(bend) {}

LeastOnLine VolumeSight::least(const EndZone& observer, const EndZone& target, double hint) const {
  const Xyz &from = observer.place(), &to = target.place();
  const VolumeLine line{from, to, bend_.drop(to.x - from.x, to.y - from.y)};
  const Surface& surface = rays_.volume().surface();
  const float beyond = rays_.volume().beyond_ratio();
  const double length = length_in(line, surface.metric());
  if (length == 0) return {{beyond, beyond}};
  LeastOnLine found;
  found.k = lesser(observer.least(line, true, beyond), target.least(line, false, beyond));
  const double zone = kEndZoneCells * surface.spacing_m() / length;
  if (found.k.high > -static_cast<float>(rays_.volume().largest_ratio()) && zone < 0.5) {
    const LeastOnLine between = rays_.least_near(line, zone, 1 - zone, hint);
    found = {lesser(found.k, between.k), between.at};
  }
  return found;
}

LineBundle VolumeSight::bundle(const Box3& from, const Box3& to) const {
  LineBundle bundle;
  bundle.from_room = 0.5 * (from.high - from.low);
  bundle.to_room = 0.5 * (to.high - to.low);
  const Xyz a = 0.5 * (from.low + from.high), b = 0.5 * (to.low + to.high);
  const Xyz apart = b - a, room = bundle.from_room + bundle.to_room;
  bundle.middle = {a, b, bend_.drop(apart.x, apart.y)};
  // The form is convex: largest at a corner, nowhere below its tangent plane in the middle.
  double most = bundle.middle.drop;
  for (const double x : {apart.x - room.x, apart.x + room.x}) {
    for (const double y : {apart.y - room.y, apart.y + room.y}) most = std::max(most, bend_.drop(x, y));
  }
  const double slope_x = 2 * std::abs(bend_.xx * apart.x + bend_.xy * apart.y),
               slope_y = 2 * std::abs(bend_.xy * apart.x + bend_.yy * apart.y);
  bundle.drop_spread = std::max(most - bundle.middle.drop, slope_x * room.x + slope_y * room.y);
  const bool in_space = rays_.volume().surface().metric() == Metric::kNormal;
  const auto near = [](double d, double r) { return std::max(std::abs(d) - r, 0.0); };
  const auto far = [](double d, double r) { return std::abs(d) + r; };
  bundle.shortest =
      std::hypot(near(apart.x, room.x), near(apart.y, room.y), in_space ? near(apart.z, room.z) : 0);
  bundle.longest =
      std::hypot(far(apart.x, room.x), far(apart.y, room.y), in_space ? far(apart.z, room.z) : 0);
  return bundle;
}

namespace {

VolumeBeam beam_of(const LineBundle& bundle) {
  const VolumeLine& line = bundle.middle;
  return {{line.from - bundle.from_room, line.from + bundle.from_room},
          {line.to - bundle.to_room, line.to + bundle.to_room},
          std::max(line.drop - bundle.drop_spread, 0.0),
          line.drop + bundle.drop_spread};
}

}  // namespace

bool VolumeSight::clear(const EndRoom& observer, const EndRoom& target, double ratio) const {
  const LineBundle lines = bundle(observer.box(), target.box());
  if (!observer.clear(lines, true, ratio) || !target.clear(lines, false, ratio)) return false;
  const double zone = kEndZoneCells * rays_.volume().surface().spacing_m() / lines.longest;
  return zone >= 0.5 || rays_.clear(beam_of(lines), {zone, 1 - zone}, ratio, Grain::kVoxels);
}

bool VolumeSight::clear(const EndRoom& observer, const Box3& targets, double ratio) const {
  const LineBundle lines = bundle(observer.box(), targets);
  const double zone = kEndZoneCells * rays_.volume().surface().spacing_m() / lines.longest;
  return zone < 1 && rays_.clear(beam_of(lines), {zone, 1}, ratio, Grain::kBlocks) &&
         observer.clear(lines, true, ratio);
}

bool VolumeSight::blocked(const Box3& observers, const Box3& targets, double ratio, Grain grain) const {
  const LineBundle lines = bundle(observers, targets);
  if (!(lines.shortest > 0)) return false;
  const double zone = kEndZoneCells * rays_.volume().surface().spacing_m() / lines.shortest;
  return zone < 0.5 && rays_.blocked(beam_of(lines), {zone, 1 - zone}, ratio, grain);
}

bool VolumeSight::doubtful(const Box3& observers, const Box3& targets, double most, Grain grain) const {
  const LineBundle lines = bundle(observers, targets);
  if (!(lines.shortest > 0)) return false;
  const double zone = kEndZoneCells * rays_.volume().surface().spacing_m() / lines.shortest;
  return zone < 0.5 && rays_.doubtful(beam_of(lines), {zone, 1 - zone}, most, grain);
}

bool VolumeSight::blocked(const EndRoom& observer, const EndRoom& target, double ratio) const {
  if (blocked(observer.box(), target.box(), ratio, Grain::kVoxels)) return true;
  const LineBundle lines = bundle(observer.box(), target.box());
  return observer.blocked(lines, true, ratio) || target.blocked(lines, false, ratio);
}

double proven_probability(const RatioInterval& k, Tails tails) {
  if (k.low > 0) return cdf(static_cast<double>(k.low), tails);
  return k.high < 0 ? cdf(static_cast<double>(k.high), tails) : 0.5;
}

}  // namespace sightbound
