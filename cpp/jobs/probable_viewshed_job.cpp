// SPDX-License-Identifier: GPL-3.0-or-later
// Method. Draw sixteen terrains at a time, look from every observer over all of them at once, count who is
// seen.
#include "jobs/probable_viewshed_job.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/memory_budget.h"
#include "base/parallel.h"
#include "error_model/posterior.h"
#include "error_model/verdict.h"
#include "error_model/wilson.h"
#include "io/crs.h"
#include "jobs/loaded_terrain.h"
#include "jobs/observer_posts.h"
#include "sight/probable_view.h"

namespace sightbound {

namespace {

constexpr int kMostRealisations = 65535;

void check(const ProbableOptions& options) {
  if (options.realisations < 1 || options.realisations > kMostRealisations) {
    throw InvalidInput("realisations is " + std::to_string(options.realisations) + "; give 1 to " +
                       std::to_string(kMostRealisations) + ".");
  }
}

ViewshedOptions of_loading(const ProbableOptions& options) {
  ViewshedOptions view;
  view.confidence = options.confidence;
  view.refraction = options.refraction;
  view.curvature = options.curvature;
  view.extent = options.extent;
  view.threads = options.threads;
  view.memory_budget = options.memory_budget;
  validate(view);
  return view;
}

struct Plan {
  Window canvas, terrain;
};

Plan plan_memory(const std::vector<Post>& posts, const DemSource& source, const ErrorModel& model,
                 const ViewshedOptions& options) {
  Plan plan;
  for (const Post& post : posts) {
    plan.canvas = bounding(plan.canvas, post.reach);
    plan.terrain = bounding(plan.terrain, post.lines);
  }
  if (options.extent) plan.canvas = window_of(options.extent, source);
  // Rays that targets ask run beside them.
  constexpr int kBeside = 2;
  plan.terrain = intersection({plan.terrain.col - kBeside, plan.terrain.row - kBeside,
                               plan.terrain.cols + 2 * kBeside, plan.terrain.rows + 2 * kBeside},
                              source.window());
  plan.terrain = with_room(plan.terrain, source);
  // Of a cell: the posterior's two values, bits of all and of one observer, a count, what each is asked
  // about.
  const std::size_t of_terrain = 2 * sizeof(float) + 3 * sizeof(std::uint16_t) + posts.size();
  const std::size_t of_canvas = 2 * sizeof(float) + 1;
  MemoryBudget(options.memory_budget)
      .require(LoadedTerrain::memory(plan.terrain, model, options).peak + plan.terrain.cells() * of_terrain +
                   plan.canvas.cells() * of_canvas,
               "A probable viewshed of " + std::to_string(plan.canvas.cols) + " x " +
                   std::to_string(plan.canvas.rows) + " cells",
               "Give a smaller max_distance or an extent, or allow a larger memory_budget.");
  return plan;
}

// 0xFFFF where the observer is asked about the cell, else 0.
SeenBits asked_of(const Post& post, const LoadedTerrain& terrain, const Workers& workers,
                  Progress& progress) {
  const Window& window = terrain.window();
  const Grid<float>& heights = terrain.scene().heights;
  const ViewLimits limits = limits_of(post.observer, terrain.scene().error.larger_side_m);
  const double eye =
      interpolate(heights, post.place.whole_col() - window.col, post.place.whole_row() - window.row) +
      post.observer.height;
  SeenBits asked(window.rows, window.cols, 0);
  workers.for_each(static_cast<std::size_t>(window.rows), [&](std::size_t n) {
    progress.check();
    const int row = window.row + static_cast<int>(n);
    for (int col = window.col; col < window.col_end(); ++col) {
      const float ground = heights.at(row - window.row, col - window.col);
      if (!post.targets.contains({col, row, 1, 1}) || std::isnan(ground)) continue;
      const double x = col - post.place.base_col, y = row - post.place.base_row;
      const FramePlace place = post.frames.of(x, y).at(x, y);
      const double distance = place.distance();
      if (distance < limits.min_distance || distance > limits.max_distance) continue;
      if (!limits.all_azimuths() && !limits.admits_azimuth(place.azimuth_deg())) continue;
      if (!limits.all_angles()) {
        const double rise = ground + post.observer.target_height - terrain.scene().bend * place.bulge - eye;
        const double angle = std::atan2(rise, distance) * 180 / M_PI;
        if (angle < limits.angle_from || angle > limits.angle_to) continue;
      }
      asked.at(row - window.row, col - window.col) = 0xFFFF;
    }
  });
  return asked;
}

class Counting {
 public:
  Counting(const std::vector<Post>& posts, const LoadedTerrain& terrain, const ProbableOptions& options,
           const Workers& workers, Progress& progress)
      : terrain_(terrain),
        posterior_(posterior(terrain.scene().heights, terrain.scene().error, workers, progress)),
        open_{posterior_.mean.empty() ? terrain.scene().heights : posterior_.mean,
              posterior_.spread,
              terrain.scene().error,
              terrain.window().row,
              terrain.window().col,
              options.seed},
        realisations_(options.realisations),
        workers_(workers) {
    const Window& window = terrain.window();
    for (const Post& post : posts) {
      const ProbableEye eye{
          &post.frames.widest(),
          post.place.base_col - window.col,
          post.place.base_row - window.row,
          post.observer.height,
          {post.reach.col - window.col, post.reach.row - window.row, post.reach.cols, post.reach.rows}};
      views_.emplace_back(open_, eye, post.observer.target_height, terrain.scene().bend);
      asked_.push_back(asked_of(post, terrain, workers, progress));
      own_.push_back(post.place.col == 0 && post.place.row == 0 ? Window{eye.base_col, eye.base_row, 1, 1}
                                                                : Window{});
    }
  }

  // Realisations in which an observer sees the cell.
  Grid<std::uint16_t> counts(double share, Progress& progress) {
    const Window& window = terrain_.window();
    Grid<std::uint16_t> counts(window.rows, window.cols, 0);
    progress.begin(share, (realisations_ + kLanes - 1) / kLanes * static_cast<double>(views_.size()));
    for (int first = 0; first < realisations_; first += kLanes) {
      const int lanes = std::min(kLanes, realisations_ - first);
      SeenBits any = Grid<std::uint16_t>::zeros(window.rows, window.cols);
      for (std::size_t i = 0; i < views_.size(); ++i)
        look(i, static_cast<std::uint32_t>(first), any, progress);
      const auto used = static_cast<std::uint16_t>((1u << lanes) - 1);
      workers_.for_each(static_cast<std::size_t>(window.rows), [&](std::size_t n) {
        const int r = static_cast<int>(n);
        for (int c = 0; c < window.cols; ++c) {
          const auto bits = static_cast<std::uint16_t>(any.at(r, c) & used);
          counts.at(r, c) = static_cast<std::uint16_t>(counts.at(r, c) + std::popcount(bits));
        }
      });
    }
    return counts;
  }
  bool asked(int row, int col) const {
    return std::any_of(asked_.begin(), asked_.end(),
                       [&](const SeenBits& one) { return one.at(row, col) != 0; });
  }

 private:
  void look(std::size_t i, std::uint32_t first, SeenBits& any, Progress& progress) {
    const ProbableView& view = views_[i];
    SeenBits seen = Grid<std::uint16_t>::zeros(any.rows(), any.cols());
    const double part = 1.0 / static_cast<double>(view.blocks());
    workers_.for_each(view.blocks(), [&](std::size_t block) {
      progress.check();
      view.march(block, first, seen);
      progress.advance(part);
    });
    if (own_[i].cols > 0) seen.at(own_[i].row, own_[i].col) = 0xFFFF;
    workers_.for_each(static_cast<std::size_t>(any.rows()), [&](std::size_t n) {
      const int r = static_cast<int>(n);
      const std::uint16_t *from = seen.row(r), *asked = asked_[i].row(r);
      std::uint16_t* to = any.row(r);
      for (int c = 0; c < any.cols(); ++c) to[c] = static_cast<std::uint16_t>(to[c] | (from[c] & asked[c]));
    });
  }

  const LoadedTerrain& terrain_;
  const Posterior posterior_;
  const OpenTerrain open_;
  const int realisations_;
  const Workers& workers_;
  std::vector<ProbableView> views_;
  std::vector<SeenBits> asked_;
  std::vector<Window> own_;  // the cell that an observer stands on exactly
};

void say_what_was_seen(const Counting& counting, const Grid<std::uint16_t>& counts,
                       const LoadedTerrain& terrain, const Window& canvas, double confidence,
                       ProbableViewshed& result) {
  const Window& window = terrain.window();
  const double n = result.report.realisations;
  result.probability = Grid<float>(canvas.rows, canvas.cols, std::numeric_limits<float>::quiet_NaN());
  result.standard_error = Grid<float>(canvas.rows, canvas.cols, std::numeric_limits<float>::quiet_NaN());
  result.verdict = Grid<std::uint8_t>(canvas.rows, canvas.cols, kNoVerdict);
  const Window both = intersection(window, canvas);
  for (int row = both.row; row < both.row_end(); ++row) {
    const double area = terrain.cell_areas()[static_cast<std::size_t>(row - window.row)];
    for (int col = both.col; col < both.col_end(); ++col) {
      if (!counting.asked(row - window.row, col - window.col)) continue;
      const double p = counts.at(row - window.row, col - window.col) / n;
      const Interval known = wilson(p, n);
      const bool visible = known.low >= (1 + confidence) / 2, hidden = known.high <= (1 - confidence) / 2;
      result.probability.at(row - canvas.row, col - canvas.col) = static_cast<float>(p);
      result.standard_error.at(row - canvas.row, col - canvas.col) =
          static_cast<float>(std::sqrt(p * (1 - p) / n));
      result.verdict.at(row - canvas.row, col - canvas.col) =
          visible ? kVisible : (hidden ? kHidden : kUncertain);
      result.report.expected_m2 += p * area;
      (visible  ? result.report.visible_m2
       : hidden ? result.report.hidden_m2
                : result.report.uncertain_m2) += area;
    }
  }
}

void place_eyes(const std::vector<Post>& posts, const LoadedTerrain& terrain, ProbableReport& report) {
  const Window& window = terrain.window();
  for (const Post& post : posts) {
    ObserverReport out;
    out.x = post.observer.x, out.y = post.observer.y, out.name = post.observer.name, out.status = "ok";
    out.ground_height = interpolate(terrain.scene().heights, post.place.whole_col() - window.col,
                                    post.place.whole_row() - window.row);
    if (std::isnan(out.ground_height)) {
      throw InvalidInput(post.name +
                         " stands where the DEM has no height (nodata). Move it, or fill the hole first.");
    }
    out.eye_height = out.ground_height + post.observer.height;
    report.observers.push_back(std::move(out));
  }
}

}  // namespace

ProbableViewshed run_probable_viewshed(const DemSource& source, const std::vector<Observer>& observers,
                                       const ErrorModel& model, const ProbableOptions& options,
                                       Progress& progress) {
  check(options);
  const ViewshedOptions loading = of_loading(options);
  model.validate();
  if (observers.empty()) throw InvalidInput("observers is empty; give at least one.");
  const Workers workers(options.threads);
  ProbableViewshed result;
  ProbableReport& report = result.report;
  report.realisations = options.realisations;

  const Georeference georeference = georeference_of(source);
  const std::vector<Post> posts = place_observers(source, georeference, observers, options.extent, progress);
  const Plan plan = plan_memory(posts, source, model, loading);
  progress.begin(0.05, 1);
  const ErrorModel completed = complete_model(model, source, report.warnings, progress);
  report.error_model = completed.describe();
  progress.begin(0.05, 1);
  const LoadedTerrain terrain(source, georeference, plan.terrain, completed, loading, report.warnings,
                              workers, progress);
  place_eyes(posts, terrain, report);
  Counting counting(posts, terrain, options, workers, progress);
  const Grid<std::uint16_t> counts = counting.counts(0.88, progress);
  say_what_was_seen(counting, counts, terrain, plan.canvas, options.confidence, result);

  const std::vector<std::string> notes = source.notes();
  report.warnings.insert(report.warnings.begin(), notes.begin(), notes.end());
  if (source.flipped()) {
    result.probability.flip_rows();
    result.standard_error.flip_rows();
    result.verdict.flip_rows();
  }
  result.geotransform = delivered_geotransform(source, plan.canvas);
  result.crs_wkt = source.crs_wkt();
  progress.finish();
  return result;
}

}  // namespace sightbound
