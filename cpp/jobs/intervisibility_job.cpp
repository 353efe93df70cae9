// SPDX-License-Identifier: GPL-3.0-or-later
// Method. Some hundred points of the first list at a time: make the frame of each (its map of the ground, the
// dear part), then judge all their pairs. Threads share points, then pairs.
#include "jobs/intervisibility_job.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/memory_budget.h"
#include "base/number_text.h"
#include "io/crs.h"
#include "jobs/line_judge.h"

namespace sightbound {

namespace {

constexpr std::size_t kAtATime = 256;  // points; frames take some 100 kB each

// A point on its way through the job.
struct Placed {
  LineEnd end;
  PairStatus status = PairStatus::kJudged;
};

std::vector<Placed> placed(const DemSource& source, const std::vector<Station>& points, const char* list) {
  std::vector<Placed> all;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Station& point = points[i];
    Observer o;
    o.x = point.x, o.y = point.y, o.height = point.height;
    validate(o, "Point " + std::to_string(i + 1) + " of " + list);
    Placed one;
    const std::optional<GridPlace> place = find_on(source, point.x, point.y);
    if (place) one.end = {*place, point.height};
    if (!place) one.status = PairStatus::kOutside;
    all.push_back(one);
  }
  return all;
}

PairStatus worse(PairStatus one, PairStatus other) {
  if (one == PairStatus::kJudged) return other;
  return other == PairStatus::kOutside ? other : one;
}

Window around(const GridPlace& place) { return {place.base_col, place.base_row, 2, 2}; }

class Network {
 public:
  Network(const DemSource& source, std::vector<Placed> a, std::vector<Placed> b, double max_distance)
      : source_(source),
        georeference_(georeference_of(source)),
        a_(std::move(a)),
        b_(std::move(b)),
        max_distance_(max_distance) {}

  // What lines must have in memory; empty without any.
  Window lines(const LineExtras& extras, const Workers& workers, Progress& progress) const {
    std::vector<Window> windows(a_.size());
    workers.for_each(a_.size(), [&](std::size_t from) {
      progress.check();
      const Window reach = reach_of_point(from);
      if (reach.empty()) return;
      const GridPlace& place = a_[from].end.place;
      windows[from] = lines_window(source_, frame_of(georeference_, place, reach), place, reach);
    });
    Window all;
    for (const Window& window : windows) all = bounding(all, window);
    return all.empty() ? all : window_for(all, extras, source_);
  }

  void require_ground(const LineJudge& judge) {
    for (std::vector<Placed>* points : {&a_, &b_}) {
      for (Placed& point : *points) {
        if (point.status == PairStatus::kJudged && !judge.has_ground(point.end.place))
          point.status = PairStatus::kNodata;
      }
    }
  }

  // `judge` may be null when no line needs it.
  void judge(const LineJudge* judge, const Workers& workers, Progress& progress, Intervisibility& out) const {
    for (std::size_t first = 0; first < a_.size(); first += kAtATime) {
      const std::size_t count = std::min(kAtATime, a_.size() - first);
      std::vector<std::optional<ObserverFrames>> frames(count);
      workers.for_each(count, [&](std::size_t n) {
        progress.check();
        const Window reach = reach_of_point(first + n);
        if (reach.empty()) return;
        frames[n].emplace(frames_of(source_, georeference_, a_[first + n].end.place, reach));
      });
      const std::size_t begin = out.pairs.size();
      for (std::size_t n = 0; n < count; ++n) list_pairs(first + n, frames[n], out);
      workers.for_each(out.pairs.size() - begin, [&](std::size_t n) {
        JudgedPair& pair = out.pairs[begin + n];
        if (pair.status == PairStatus::kJudged) {
          const ObserverFrames& seen_from = *frames[pair.from - first];
          pair.sight =
              judge->judge(a_[pair.from].end, others()[pair.to].end, seen_from.widest(), &seen_from, false);
        } else {
          progress.check();
        }
      });
      progress.advance(static_cast<double>(count));
    }
  }

 private:
  const std::vector<Placed>& others() const { return b_.empty() ? a_ : b_; }
  std::size_t first_partner(std::size_t from) const { return b_.empty() ? from + 1 : 0; }

  // Of the partners that may be near enough; empty: there are none, or the point is nowhere.
  Window reach_of_point(std::size_t from) const {
    const Placed& point = a_[from];
    Window reach;
    if (point.status == PairStatus::kOutside) return reach;
    const Window near = std::isfinite(max_distance_)
                            ? reach_of(source_, georeference_, point.end.place, max_distance_)
                            : source_.window();
    for (std::size_t to = first_partner(from); to < others().size(); ++to) {
      const Placed& other = others()[to];
      if (other.status == PairStatus::kOutside) continue;
      const Window ends = intersection(around(other.end.place), source_.window());
      if (near.contains({ends.col, ends.row, 1, 1})) reach = bounding(reach, ends);
    }
    if (reach.empty()) return reach;
    reach = bounding(reach, around(point.end.place));
    return intersection({reach.col - 2, reach.row - 2, reach.cols + 4, reach.rows + 4}, source_.window());
  }

  void list_pairs(std::size_t from, const std::optional<ObserverFrames>& frames, Intervisibility& out) const {
    const Placed& point = a_[from];
    for (std::size_t to = first_partner(from); to < others().size(); ++to) {
      const Placed& other = others()[to];
      const PairStatus status = worse(point.status, other.status);
      if (status == PairStatus::kOutside) {
        out.pairs.push_back({from, to, status, {}});
        continue;
      }
      const GridPlace &here = point.end.place, &there = other.end.place;
      const double col = there.base_col - here.base_col + there.col,
                   row = there.base_row - here.base_row + there.row;
      if (col == here.col && row == here.row) continue;
      if (std::isfinite(max_distance_) && !(frames && near_enough(*frames, col, row))) {
        ++out.too_far;
        continue;
      }
      out.pairs.push_back({from, to, status, {}});
    }
  }

  bool near_enough(const ObserverFrames& frames, double col, double row) const {
    return frames.of(col, row).at(col, row).distance() <= max_distance_;
  }

  const DemSource& source_;
  const Georeference georeference_;
  std::vector<Placed> a_, b_;
  const double max_distance_;
};

}  // namespace

std::string name_of(PairStatus status) {
  if (status == PairStatus::kOutside) return "outside";
  return status == PairStatus::kNodata ? "nodata" : "ok";
}

Intervisibility run_intervisibility(const DemSource& source, const std::vector<Station>& a,
                                    const std::vector<Station>& b, const ErrorModel& model,
                                    const ViewshedOptions& options, const LineExtras& extras,
                                    const StationOptions& stations, Progress& progress) {
  validate(options);
  validate(extras);
  model.validate();
  if (!(stations.max_distance > 0)) {
    throw InvalidInput("max_distance is " + number_text(stations.max_distance) +
                       "; it must be more than 0 metres.");
  }
  const Workers workers(options.threads);
  Intervisibility out;
  out.points_a = a.size(), out.points_b = b.size();
  Network network(source, placed(source, a, "points_a"), placed(source, b, "points_b"),
                  stations.max_distance);
  progress.begin(0.05, 1);
  const Window window = network.lines(extras, workers, progress);
  progress.begin(0.1, 1);
  const ErrorModel completed = complete_model(model, source, out.warnings, progress);
  out.error_model = completed.describe();
  std::unique_ptr<LoadedTerrain> terrain;
  std::unique_ptr<LineJudge> judge;
  if (!window.empty()) {
    MemoryBudget(options.memory_budget)
        .require(LoadedTerrain::memory(window, model, options).peak + LineJudge::memory(window, extras),
                 "The ground between the points, " + std::to_string(window.cols) + " x " +
                     std::to_string(window.rows) + " cells,",
                 "Give a smaller max_distance, fewer points at a time, or allow a larger memory_budget.");
    progress.begin(0.1, 1);
    const Georeference georeference = georeference_of(source);
    terrain = std::make_unique<LoadedTerrain>(source, georeference, window, completed, options, out.warnings,
                                              workers, progress);
    judge = std::make_unique<LineJudge>(source, *terrain, options, extras, workers, progress);
    network.require_ground(*judge);
  }
  progress.begin(0.75, static_cast<double>(a.size()));
  network.judge(judge.get(), workers, progress, out);
  const std::vector<std::string> notes = source.notes();
  out.warnings.insert(out.warnings.begin(), notes.begin(), notes.end());
  progress.finish();
  return out;
}

}  // namespace sightbound
