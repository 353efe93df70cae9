// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/line_judge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "jobs/early_stop.h"
#include "jobs/observer_posts.h"
#include "sight/confidence.h"
#include "sight/fresnel.h"
#include "sight/line_bound.h"

namespace sightbound {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Xy place_of(const DemSource& source, const GridPlace& base, double col, double row) {
  return source.geotransform().of_sample(base.base_col + col, base.base_row + row);
}

SightProfile profile_of(const SightLine& line, std::vector<JudgedPlace> places, const DemSource& source,
                        const GridPlace& base) {
  std::sort(places.begin(), places.end(),
            [](const JudgedPlace& a, const JudgedPlace& b) { return a.share < b.share; });
  SightProfile profile;
  for (const JudgedPlace& place : places) {
    const Xy at = place_of(source, base, line.col(place.xi), line.row(place.xi));
    profile.distance.push_back(place.share * line.distance());
    profile.x.push_back(at.x);
    profile.y.push_back(at.y);
    profile.ground.push_back(place.ground);
    profile.sigma.push_back(place.sigma);
    profile.line.push_back(place.line);
    profile.clearance.push_back((place.line - place.ground) / place.sigma);
  }
  return profile;
}

// Of what is compared along the line, the least, and where: the nearest to the observer where several are
// equal.
struct Least {
  double value = std::numeric_limits<double>::infinity();
  JudgedPlace place;

  void take(double candidate, const JudgedPlace& at) {
    if (candidate < value || (candidate == value && at.share < place.share)) value = candidate, place = at;
  }
  bool found() const { return std::isfinite(value); }
};

struct Extremes {
  Least clearance;  // in sigma
  Least unknown;    // the first place of unknown ground
  Least zone;       // shares of the zone's radius
  Least zone_k;     // clearance of the share of the zone asked for, in sigma
};

Extremes extremes_of(const std::vector<JudgedPlace>& places, double distance,
                     const std::optional<RadioOptions>& radio) {
  Extremes found;
  const double wavelength = radio ? wavelength_m(radio->frequency_mhz) : 0;
  for (const JudgedPlace& place : places) {
    if (std::isnan(place.ground)) {
      found.unknown.take(place.share, place);
      continue;
    }
    const double above = place.line - place.ground;
    found.clearance.take(above / place.sigma, place);
    if (!radio) continue;
    const double radius = first_zone_radius(wavelength, distance, place.share);
    found.zone.take(above / radius, place);
    found.zone_k.take((above - radio->zone_share * radius) / place.sigma, place);
  }
  return found;
}

FresnelClearance fresnel_of(const Extremes& extremes, const Scene& scene, const SightLine& line,
                            const RadioOptions& radio, const DemSource& source, const GridPlace& base) {
  FresnelClearance out;
  const double wavelength = wavelength_m(radio.frequency_mhz);
  out.middle_radius = first_zone_radius(wavelength, line.distance(), 0.5);
  out.k = scene.largest_ratio;
  out.clear = out.x = out.y = out.distance = out.radius = kNan;
  if (extremes.zone.found()) {
    const JudgedPlace& worst = extremes.zone.place;
    const Xy at = place_of(source, base, line.col(worst.xi), line.row(worst.xi));
    out.clear = extremes.zone.value;
    out.x = at.x, out.y = at.y, out.distance = worst.share * line.distance();
    out.radius = first_zone_radius(wavelength, line.distance(), worst.share);
    out.k = std::clamp(extremes.zone_k.value, -scene.largest_ratio, scene.largest_ratio);
  }
  if (extremes.unknown.found() && !scene.see_across_nodata) out.k = std::min(out.k, 0.0);
  out.p = static_cast<double>(probability(scene, out.k));
  out.verdict = verdict(scene, out.k);
  return out;
}

}  // namespace

Window window_for(const Window& lines, const LineExtras& extras, const DemSource& source) {
  // What is drawn beside a line depends on samples farther out (posterior.h).
  constexpr int kAround = 2 + 4;
  const int around = extras.whole_line ? kAround : 0;
  return with_room(
      intersection({lines.col - around, lines.row - around, lines.cols + 2 * around, lines.rows + 2 * around},
                   source.window()),
      source);
}

LineJudge::LineJudge(const DemSource& source, const LoadedTerrain& terrain, const ViewshedOptions& options,
                     const LineExtras& extras, const Workers& workers, Progress& progress)
    : source_(source),
      terrain_(terrain),
      options_(options),
      extras_(extras),
      posterior_(extras.whole_line
                     ? posterior(terrain.scene().heights, terrain.scene().error, workers, progress)
                     : Posterior{}),
      open_{posterior_.mean.empty() ? terrain.scene().heights : posterior_.mean,
            posterior_.spread,
            terrain.scene().error,
            terrain.window().row,
            terrain.window().col,
            extras.whole_line ? extras.whole_line->seed : 0,
            terrain.scene().error.surface ? &posterior_.rises : nullptr,
            posterior_.has_shared() ? &posterior_.shared : nullptr},
      columns_(open_, false),
      rows_(open_, true) {}

std::size_t LineJudge::memory(const Window& window, const LineExtras& extras) {
  return extras.whole_line ? 6 * sizeof(float) * window.cells() : 0;  // the posterior
}

double LineJudge::at(const Grid<float>& values, const GridPlace& place) const {
  const Window& window = terrain_.window();
  return interpolate(values, place.whole_col() - window.col, place.whole_row() - window.row);
}

double LineJudge::sampling(const GridPlace& place) const {
  const SampleField& field = terrain_.scene().error.sampling;
  return field.is_constant() ? static_cast<double>(field.constant()) : at(field.values(), place);
}

bool LineJudge::has_ground(const GridPlace& place) const {
  return !std::isnan(at(terrain_.ground(), place)) && !std::isnan(at(terrain_.scene().heights, place));
}

LineOfSight LineJudge::judge(const LineEnd& observer, const LineEnd& end, const ObserverFrame& frame,
                             const ObserverFrames* frames, bool described) const {
  const Window& window = terrain_.window();
  const Scene& scene = terrain_.scene();
  const bool absolute = options_.height_reference == HeightReference::kAbsolute;
  const GridPlace& base = observer.place;
  LineOfSight out;
  out.observer_ground = at(terrain_.ground(), base);
  out.target_ground = at(terrain_.ground(), end.place);
  out.eye_height = absolute ? observer.height : out.observer_ground + observer.height;
  out.target_top = absolute ? end.height : out.target_ground + end.height;

  const Eye eye{
      &frame, base.base_col - window.col, base.base_row - window.row, out.eye_height, sampling(base), frames};
  const Target target{end.place.base_col - base.base_col + end.place.col,
                      end.place.base_row - base.base_row + end.place.row, out.target_top,
                      sampling(end.place)};
  const SightLine line(scene, eye, target);
  const Critical critical = line.settle();
  out.k = critical.k;
  out.p = static_cast<double>(probability(scene, critical.k));
  out.verdict = verdict(scene, critical.k);
  out.distance = line.distance();
  out.azimuth = line.azimuth_deg();

  std::vector<JudgedPlace> places;
  line.for_each_place([&](const JudgedPlace& place) { places.push_back(place); });
  const Extremes extremes = extremes_of(places, out.distance, extras_.radio);
  // The place that decides: where the clearance is least; unknown ground when that holds k* down.
  const Least& decisive = critical.hole ? extremes.unknown : extremes.clearance;
  out.critical_x = out.critical_y = out.critical_distance = out.critical_clearance = kNan;
  if (decisive.found()) {
    const Xy at = place_of(source_, base, line.col(decisive.place.xi), line.row(decisive.place.xi));
    out.critical_x = at.x, out.critical_y = at.y;
    out.critical_distance = decisive.place.share * out.distance;
    out.critical_clearance = decisive.place.line - decisive.place.ground;
  }
  if (extras_.radio) out.fresnel = fresnel_of(extremes, scene, line, *extras_.radio, source_, base);
  if (extras_.whole_line) out.whole_line = whole_line(eye, target, out, base, described);
  if (!described) return out;

  out.profile = profile_of(line, std::move(places), source_, base);
  if (extras_.radio) {
    for (const double distance : out.profile.distance)
      out.profile.zone.push_back(first_zone_radius(wavelength_m(extras_.radio->frequency_mhz), out.distance,
                                                   distance / out.distance));
  }
  const double certain = line.needed_height(scene.quantile, out.target_ground),
               likely = line.needed_height(0, out.target_ground);
  out.required_height = std::isinf(certain) ? kNan : certain - out.target_ground;
  out.likely_height = std::isinf(likely) ? kNan : likely - out.target_ground;
  return out;
}

WholeLine LineJudge::whole_line(const Eye& eye, const Target& target, const LineOfSight& judged,
                                const GridPlace& base, bool described) const {
  const WholeLineOptions& asked = *extras_.whole_line;
  LineDoubt doubt;
  const GridPlace end{base.base_col, base.base_row, target.col, target.row};
  doubt.eye_ground = at(terrain_.scene().heights, base);
  doubt.target_ground = at(terrain_.scene().heights, end);
  doubt.ends_move = asked.stand == Stand::kGround && options_.height_reference == HeightReference::kGround;
  if (extras_.radio) {
    doubt.wavelength = wavelength_m(extras_.radio->frequency_mhz);
    doubt.zone_share = extras_.radio->zone_share;
  }
  const bool transposed = is_transposed(eye, target);
  const LineInDoubt line(terrain_.scene(), open_, transposed ? rows_ : columns_, eye, target, doubt);
  const LineCounts counts = count_clear(line, asked.realisations);

  WholeLine out;
  const double n = out.realisations = counts.realisations;
  out.seed = asked.seed;
  out.probability = counts.clear / n;
  out.standard_error = std::sqrt(out.probability * (1 - out.probability) / n);
  out.interval = wilson(out.probability, n, kZ95);
  out.verdict = out.interval.low >= (1 + options_.confidence) / 2    ? kVisible
                : out.interval.high <= (1 - options_.confidence) / 2 ? kHidden
                                                                     : kUncertain;
  out.blocked_bound = blocked_bound(line);
  out.zone_probability = extras_.radio ? counts.zone_clear / n : kNan;

  // In the order of the line; of several that block as often, the first.
  std::vector<std::size_t> order(line.places.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return line.places[a].share < line.places[b].share; });
  out.blocked_x = out.blocked_y = out.blocked_distance = kNan;
  int most = 0;
  for (const std::size_t i : order) {
    if (!line.places[i].judged) continue;
    const Xy at = place_of(source_, base, line.col(i), line.row(i));
    const double distance = line.places[i].share * judged.distance;
    if (counts.blocked[i] > most) {
      most = counts.blocked[i];
      out.blocked_x = at.x, out.blocked_y = at.y, out.blocked_distance = distance;
    }
    if (!described) continue;
    out.distance.push_back(distance);
    out.x.push_back(at.x);
    out.y.push_back(at.y);
    out.blocked.push_back(counts.blocked[i] / n);
  }
  out.blocked_share = most / n;
  return out;
}

}  // namespace sightbound
