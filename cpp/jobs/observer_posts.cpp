// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/observer_posts.h"

#include <algorithm>

namespace sightbound {

namespace {
constexpr double kOnTheLimit = 1e-6;  // cells
}  // namespace

std::vector<Post> place_observers(const DemSource& source, const Georeference& georeference,
                                  const std::vector<Observer>& observers, const std::optional<Extent>& extent,
                                  Progress& progress) {
  const Window asked = window_of(extent, source);
  const double larger_side = larger_cell_side(georeference, source.rows(), source.cols());
  std::vector<Post> posts;
  posts.reserve(observers.size());
  for (std::size_t i = 0; i < observers.size(); ++i) {
    const Observer& o = observers[i];
    const std::string name = name_of(o, i);
    validate(o, name);
    const GridPlace place = place_on(source, o.x, o.y, name);
    const Window around = reach_of(source, georeference, place, o.max_distance);
    ObserverFrames frames = frames_of(source, georeference, place, around);
    const double limit = o.max_distance + kOnTheLimit * larger_side;
    const Window reach = samples_within(frames.widest(), place, around, limit);
    const Window targets = intersection(reach, asked);
    const Window lines = targets.empty() ? Window{place.base_col, place.base_row, 1, 1}
                                         : lines_window(source, frames.widest(), place, targets);
    posts.push_back({o, name, place, reach, targets, lines, std::move(frames)});
    progress.check();
  }
  return posts;
}

ViewLimits limits_of(const Observer& o, double larger_side_m) {
  const double on_the_limit = kOnTheLimit * larger_side_m;
  return {o.min_distance - on_the_limit,
          o.max_distance + on_the_limit,
          o.azimuth_from,
          o.azimuth_to,
          o.angle_from,
          o.angle_to};
}

Window with_room(Window w, const DemSource& source) {
  if (w.cols < 2) w = {std::min(w.col, source.cols() - 2), w.row, 2, w.rows};
  if (w.rows < 2) w = {w.col, std::min(w.row, source.rows() - 2), w.cols, 2};
  return w;
}

}  // namespace sightbound
