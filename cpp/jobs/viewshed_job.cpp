// SPDX-License-Identifier: GPL-3.0-or-later
// Method. Place every observer, plan windows and memory, learn the error once; then load terrain (once for
// observers whose windows lie together, else for one after the other) and paint every observer's view on one
// canvas.
#include "jobs/viewshed_job.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/memory_budget.h"
#include "io/crs.h"
#include "jobs/loaded_terrain.h"
#include "jobs/observer_eye.h"
#include "jobs/observer_posts.h"
#include "sight/viewshed.h"

namespace sightbound {

namespace {

// What is in memory at once.
struct Plan {
  Window canvas;          // the result
  bool together = false;  // one terrain for all observers
  Window terrain;         // ... and its window
  std::size_t bytes = 0;  // planned peak
};

Plan plan_memory(const std::vector<Post>& posts, const ErrorModel& model, const ViewshedOptions& options,
                 const DemSource& source, const MemoryBudget& budget) {
  Plan plan;
  std::size_t separate_cells = 0, separate_bytes = 0;
  for (const Post& post : posts) {
    plan.canvas = bounding(plan.canvas, post.reach);
    plan.terrain = bounding(plan.terrain, post.lines);
    separate_cells += post.lines.cells();
    separate_bytes = std::max(separate_bytes, LoadedTerrain::memory(post.lines, model, options).peak);
  }
  if (options.extent) plan.canvas = window_of(options.extent, source);
  const std::size_t per_cell = sizeof(float) + 1 + (posts.size() > 1 ? sizeof(std::uint32_t) : 0) +
                               (options.heights ? 2 * sizeof(float) : 0);
  const std::size_t canvas_bytes = plan.canvas.cells() * per_cell;
  const std::size_t together_bytes = LoadedTerrain::memory(plan.terrain, model, options).peak;
  constexpr std::size_t kWorthwhile =
      2;  // reading twice the cells once beats many small windows' halos and set-up
  plan.together =
      plan.terrain.cells() <= kWorthwhile * separate_cells && canvas_bytes + together_bytes <= budget.bytes();
  plan.bytes = canvas_bytes + (plan.together ? together_bytes : separate_bytes);
  budget.require(plan.bytes,
                 "A viewshed of " + std::to_string(plan.canvas.cols) + " x " +
                     std::to_string(plan.canvas.rows) + " cells",
                 "Give a smaller max_distance or an extent, ask for one result per observer, or allow a "
                 "larger memory_budget.");
  return plan;
}

class Run {
 public:
  Run(const DemSource& source, const Georeference& georeference, const ErrorModel& model,
      const ViewshedOptions& options, const Workers& workers, Canvas& canvas, const Window& canvas_window,
      ViewshedReport& report, Progress& progress)
      : source_(source),
        georeference_(georeference),
        model_(model),
        options_(options),
        workers_(workers),
        canvas_(canvas),
        canvas_window_(canvas_window),
        report_(report),
        progress_(progress) {}

  void together(const std::vector<Post>& posts, const Window& window, double share) {
    progress_.begin(share / 4, 1);
    const LoadedTerrain terrain = load(window);
    progress_.begin(share * 3 / 4, cells(posts));
    for (const Post& post : posts) view(post, terrain);
  }

  void one_by_one(const std::vector<Post>& posts, double share) {
    const double all = cells(posts);
    for (const Post& post : posts) {
      const double part = share * static_cast<double>(post.lines.cells()) / all;
      progress_.begin(part / 4, 1);
      const LoadedTerrain terrain = load(post.lines);
      progress_.begin(part * 3 / 4, static_cast<double>(post.lines.cells()));
      view(post, terrain);
    }
  }

 private:
  static double cells(const std::vector<Post>& posts) {
    double sum = 0;
    for (const Post& post : posts) sum += static_cast<double>(post.lines.cells());
    return sum;
  }

  LoadedTerrain load(const Window& window) {
    return LoadedTerrain(source_, georeference_, with_room(window, source_), model_, options_,
                         report_.warnings, workers_, progress_);
  }

  void view(const Post& post, const LoadedTerrain& terrain) {
    const Window& window = terrain.window();
    const Observer& o = post.observer;
    const ObserverEye placed =
        eye_above(terrain, o, post.name, post.place, post.frames, options_.height_reference);
    ObserverReport out;
    out.x = o.x;
    out.y = o.y;
    out.name = o.name;
    out.status = "ok";
    out.ground_height = placed.ground;
    out.eye_height = placed.eye.height;
    if (placed.below > 0) {
      out.status = "eye below the terrain";
      report_.warnings.push_back(post.name + ": the eye is " + std::to_string(placed.below) +
                                 " m below the terrain.");
    }

    View view{terrain.scene(), placed.eye, {}, terrain.ground(), terrain.cell_areas(), {}};
    const bool absolute = options_.height_reference == HeightReference::kAbsolute;
    view.tops = {absolute ? nullptr : &terrain.ground(), o.target_height};
    view.limits = limits_of(o, terrain.scene().error.larger_side_m);
    canvas_.move_to(canvas_window_.col - window.col, canvas_window_.row - window.row);
    const ViewTotals seen = viewshed(view, canvas_, workers_, progress_);
    canvas_.next_observer();
    out.visible_m2 = seen.visible_m2;
    out.uncertain_m2 = seen.uncertain_m2;
    out.hidden_m2 = seen.hidden_m2;
    report_.hole_doubt_m2 += seen.hole_doubt_m2;
    report_.cells_settled += seen.settled;
    report_.observers.push_back(std::move(out));
  }

  const DemSource& source_;
  const Georeference& georeference_;
  const ErrorModel& model_;
  const ViewshedOptions& options_;
  const Workers& workers_;
  Canvas& canvas_;
  const Window& canvas_window_;
  ViewshedReport& report_;
  Progress& progress_;
};

CanvasStart start_of_canvas(const Post& first, const Plan& plan, const ViewshedOptions& options) {
  const Observer& o = first.observer;
  const bool everywhere = first.targets == plan.canvas && o.min_distance <= 0 &&
                          o.max_distance >= Observer().max_distance && o.azimuth_to - o.azimuth_from >= 360 &&
                          o.angle_from <= -90 && o.angle_to >= 90;
  return everywhere && !options.heights ? CanvasStart::kAllHidden : CanvasStart::kNobodyAsked;
}

// Areas of the combined verdict. One observer's are those already counted.
void total_areas(const DemSource& source, const Georeference& georeference, const Window& window,
                 const Canvas& canvas, ViewshedReport& report, const Workers& workers, Progress& progress) {
  if (report.observers.size() == 1) {
    const ObserverReport& only = report.observers.front();
    report.visible_m2 = only.visible_m2;
    report.uncertain_m2 = only.uncertain_m2;
    report.hidden_m2 = only.hidden_m2;
    return;
  }
  const std::vector<double> areas = cell_areas(
      ground_cell_sizes(georeference, {0, window.row, source.cols(), window.rows}), source.geotransform());
  std::vector<std::array<std::uint32_t, 256>> cells(areas.size());
  workers.for_each(areas.size(), [&](std::size_t r) {
    progress.check();
    const std::uint8_t* row = canvas.verdict.row(static_cast<int>(r));
    for (int c = 0; c < window.cols; ++c) ++cells[r][row[c]];
  });
  for (std::size_t r = 0; r < areas.size(); ++r) {
    report.visible_m2 += areas[r] * cells[r][kVisible];
    report.uncertain_m2 += areas[r] * cells[r][kUncertain];
    report.hidden_m2 += areas[r] * cells[r][kHidden];
  }
}

// What the sources had to say of their data, once it is read; first, since all else rests on it.
void add_notes(const DemSource& source, const ViewshedOptions& options, std::vector<std::string>& warnings) {
  std::vector<std::string> notes = source.notes();
  if (options.ground) {
    for (const std::string& note : options.ground->notes()) notes.push_back("ground: " + note);
  }
  warnings.insert(warnings.begin(), notes.begin(), notes.end());
}

}  // namespace

ViewshedResult run_viewshed(const DemSource& source, const std::vector<Observer>& observers,
                            const ErrorModel& model, const ViewshedOptions& options, Progress& progress) {
  validate(options);
  model.validate();
  if (observers.empty()) throw InvalidInput("observers is empty; give at least one.");
  const MemoryBudget budget(options.memory_budget);
  const Workers workers(options.threads);
  ViewshedResult result;
  ViewshedReport& report = result.report;

  const Georeference georeference = georeference_of(source);
  const std::vector<Post> posts = place_observers(source, georeference, observers, options.extent, progress);
  const Plan plan = plan_memory(posts, model, options, source, budget);
  report.memory_bytes = plan.bytes;

  progress.begin(0.1, 1);
  const ErrorModel completed = complete_model(model, source, report.warnings, progress);
  report.error_model = completed.describe();

  Canvas canvas(plan.canvas, start_of_canvas(posts.front(), plan, options), options.combine == Combine::kBest,
                options.heights, workers, progress);
  if (observers.size() > 1) canvas.start_counting(workers, progress);
  Run run(source, georeference, completed, options, workers, canvas, plan.canvas, report, progress);
  if (plan.together) {
    run.together(posts, plan.terrain, 0.88);
  } else {
    run.one_by_one(posts, 0.88);
  }
  total_areas(source, georeference, plan.canvas, canvas, report, workers, progress);
  add_notes(source, options, report.warnings);

  canvas.seal_heights(workers, progress);
  if (source.flipped()) canvas.flip_rows();
  result.confidence = std::move(canvas.confidence);
  result.verdict = std::move(canvas.verdict);
  result.count = std::move(canvas.count);
  result.lowest_visible_height = std::move(canvas.certain_height);
  result.likely_visible_height = std::move(canvas.likely_height);
  result.geotransform = delivered_geotransform(source, plan.canvas);
  result.crs_wkt = source.crs_wkt();
  progress.finish();
  return result;
}

}  // namespace sightbound
