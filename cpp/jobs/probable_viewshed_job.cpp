// SPDX-License-Identifier: GPL-3.0-or-later
// Method. Find what is the same in all terrains; draw the others sixteen at a time, look from every observer
// over all of them, count who is seen, and leave those that are settled.
#include "jobs/probable_viewshed_job.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/memory_budget.h"
#include "base/parallel.h"
#include "error_model/posterior.h"
#include "error_model/verdict.h"
#include "io/crs.h"
#include "jobs/cells_in_doubt.h"
#include "jobs/early_stop.h"
#include "jobs/loaded_terrain.h"
#include "jobs/observer_posts.h"
#include "sight/probable_view.h"

namespace sightbound {

namespace {

constexpr int kMostRealisations = 65535;
constexpr std::size_t kMostHeights = kMostLayers - 1;

void check(const ProbableOptions& options) {
  if (options.realisations < 1 || options.realisations > kMostRealisations) {
    throw InvalidInput("realisations is " + std::to_string(options.realisations) + "; give 1 to " +
                       std::to_string(kMostRealisations) + ".");
  }
  if (!(options.precision >= 0 && options.precision <= 0.5)) {
    throw InvalidInput("precision is " + std::to_string(options.precision) +
                       "; give 0 (draw all realisations) to 0.5.");
  }
  if (options.refinement < 0 || options.refinement > 1) {
    throw InvalidInput("refinement is " + std::to_string(options.refinement) +
                       "; give 0 (half cells) or 1 (finer near eye and target).");
  }
  if (options.heights.size() > kMostHeights) {
    throw InvalidInput("heights has " + std::to_string(options.heights.size()) + " values; give at most " +
                       std::to_string(kMostHeights) + ".");
  }
  for (const double height : options.heights) {
    if (!std::isfinite(height) || height < 0)
      throw InvalidInput("heights has " + std::to_string(height) + "; give metres above ground, 0 or more.");
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
  std::size_t bytes;  // but for cells in doubt
};

Plan plan_memory(const std::vector<Post>& posts, const DemSource& source, const ErrorModel& model,
                 const ViewshedOptions& options, std::size_t heights) {
  Plan plan;
  for (const Post& post : posts) {
    plan.canvas = bounding(plan.canvas, post.reach);
    plan.terrain = bounding(plan.terrain, post.lines);
  }
  if (options.extent) plan.canvas = window_of(options.extent, source);
  // Rays that targets ask run beside them; what is drawn there depends on samples farther out (posterior.h).
  constexpr int kBeside = 2 + 4;
  plan.terrain = intersection({plan.terrain.col - kBeside, plan.terrain.row - kBeside,
                               plan.terrain.cols + 2 * kBeside, plan.terrain.rows + 2 * kBeside},
                              source.window());
  plan.terrain = with_room(plan.terrain, source);
  // Of a cell: the posterior's values, who asks, the layers and the place of a cell in doubt; results.
  const std::size_t of_terrain = 6 * sizeof(float) + 1 + 2 * sizeof(Layers) + sizeof(std::uint32_t);
  const std::size_t of_canvas = (2 + heights) * sizeof(float) + sizeof(std::uint16_t) + 1;
  plan.bytes = LoadedTerrain::memory(plan.terrain, model, options).peak + plan.terrain.cells() * of_terrain +
               plan.canvas.cells() * of_canvas;
  MemoryBudget(options.memory_budget)
      .require(plan.bytes,
               "A probable viewshed of " + std::to_string(plan.canvas.cols) + " x " +
                   std::to_string(plan.canvas.rows) + " cells",
               "Give a smaller max_distance or an extent, or allow a larger memory_budget.");
  return plan;
}

// Whether an observer is asked about a cell of the terrain's grid.
class Asking {
 public:
  Asking(const Post& post, const LoadedTerrain& terrain)
      : post_(post),
        terrain_(terrain),
        window_(terrain.window()),
        limits_(limits_of(post.observer, terrain.scene().error.larger_side_m)),
        eye_(interpolate(terrain.scene().heights, post.place.whole_col() - window_.col,
                         post.place.whole_row() - window_.row) +
             post.observer.height) {}

  bool operator()(int row, int col) const {
    const float ground = terrain_.scene().heights.at(row, col);
    const int r = row + window_.row, c = col + window_.col;
    if (!post_.targets.contains({c, r, 1, 1}) || std::isnan(ground)) return false;
    const double x = c - post_.place.base_col, y = r - post_.place.base_row;
    const FramePlace place = post_.frames.of(x, y).at(x, y);
    const double distance = place.distance();
    if (distance < limits_.min_distance || distance > limits_.max_distance) return false;
    if (!limits_.all_azimuths() && !limits_.admits_azimuth(place.azimuth_deg())) return false;
    if (limits_.all_angles()) return true;
    const double rise = ground + post_.observer.target_height - terrain_.scene().bend * place.bulge - eye_;
    const double angle = std::atan2(rise, distance) * 180 / M_PI;
    return angle >= limits_.angle_from && angle <= limits_.angle_to;
  }

 private:
  const Post& post_;
  const LoadedTerrain& terrain_;
  const Window window_;
  const ViewLimits limits_;
  const double eye_;
};

// Who is asked about a cell by any of them.
Grid<std::uint8_t> asked_of(const std::vector<Post>& posts, const LoadedTerrain& terrain,
                            const Workers& workers, Progress& progress) {
  const Window& window = terrain.window();
  auto asked = Grid<std::uint8_t>::zeros(window.rows, window.cols);
  std::vector<Asking> asking;
  for (const Post& post : posts) asking.emplace_back(post, terrain);
  workers.for_each(static_cast<std::size_t>(window.rows), [&](std::size_t n) {
    progress.check();
    const int row = static_cast<int>(n);
    for (int col = 0; col < window.cols; ++col) {
      asked.at(row, col) =
          std::ranges::any_of(asking, [&](const Asking& asks) { return asks(row, col); }) ? 1 : 0;
    }
  });
  return asked;
}

// Of the model, what a perturbed DEM is drawn from: errors of measurement alone. What lies between the
// samples is not drawn then, nor what means leave open at their own places, which is no measurement's error.
ErrorModel of_measurement(ErrorModel model) {
  model.geologic_variation = 0.0;
  model.geologic_shape = GeologicShape::kGaussian;
  model.growth_exponent.reset();
  model.geologic_range.reset();
  model.terrain_types.reset();
  return model;
}

// The terrains that are drawn.
class Behind {
 public:
  Behind(const LoadedTerrain& terrain, const ProbableOptions& options, const Workers& workers,
         Progress& progress)
      : is_perturbed_(options.method == Terrains::kPerturb),
        posterior_(is_perturbed_
                       ? Posterior()
                       : posterior(terrain.scene().heights, terrain.scene().error, workers, progress)),
        open_{posterior_.mean.empty() ? terrain.scene().heights : posterior_.mean,
              is_perturbed_ && !perturbs_alike(terrain) ? terrain.scene().error.sampling : posterior_.spread,
              terrain.scene().error,
              terrain.window().row,
              terrain.window().col,
              options.seed,
              terrain.scene().error.surface ? &posterior_.rises : nullptr,
              perturbs_alike(terrain) ? &terrain.scene().error.sampling
                                      : (posterior_.has_shared() ? &posterior_.shared : nullptr),
              largest_draw(terrain.scene().error)} {}
  const OpenTerrain& open() const { return open_; }

 private:
  // All that is drawn is correlated.
  bool perturbs_alike(const LoadedTerrain& terrain) const {
    return is_perturbed_ && !terrain.scene().error.noise.is_independent();
  }

  const bool is_perturbed_;
  const Posterior posterior_;
  const OpenTerrain open_;
};

std::vector<ProbableView> views_of(const std::vector<Post>& posts, const LoadedTerrain& terrain,
                                   const OpenTerrain& open, const ProbableOptions& options) {
  const Window& window = terrain.window();
  const Refinement refinement = options.refinement > 0 ? Refinement::end_zones() : Refinement::none();
  std::vector<ProbableView> views;
  for (const Post& post : posts) {
    const ProbableEye eye{
        &post.frames.widest(),
        post.place.base_col - window.col,
        post.place.base_row - window.row,
        post.observer.height,
        {post.reach.col - window.col, post.reach.row - window.row, post.reach.cols, post.reach.rows},
        Asking(post, terrain)};
    std::vector<float> heights{static_cast<float>(post.observer.target_height)};
    for (const double height : options.heights) heights.push_back(static_cast<float>(height));
    views.emplace_back(open, eye, std::move(heights), terrain.scene().bend, refinement);
  }
  return views;
}

void say_what_was_seen(const CellsInDoubt& cells, const Grid<std::uint8_t>& asked, const EarlyStop& stop,
                       const LoadedTerrain& terrain, const Window& canvas, ProbableViewshed& result) {
  const Window& window = terrain.window();
  const auto empty = [&] {
    return Grid<float>(canvas.rows, canvas.cols, std::numeric_limits<float>::quiet_NaN());
  };
  result.probability = empty();
  result.standard_error = empty();
  for (std::size_t n = 0; n < result.report.heights.size(); ++n) result.at_heights.push_back(empty());
  result.verdict = Grid<std::uint8_t>(canvas.rows, canvas.cols, kNoVerdict);
  result.realisations = Grid<std::uint16_t>(canvas.rows, canvas.cols, 0);
  ProbableReport& report = result.report;
  const int most = report.realisations;
  const Window both = intersection(window, canvas);
  for (int row = both.row; row < both.row_end(); ++row) {
    const double area = terrain.cell_areas()[static_cast<std::size_t>(row - window.row)];
    for (int col = both.col; col < both.col_end(); ++col) {
      const int r = row - window.row, c = col - window.col, i = row - canvas.row, j = col - canvas.col;
      if (asked.at(r, c) == 0) continue;
      const auto [p, n, proven] = cells.answer(r, c, 0, most);
      const double error = std::sqrt(p * (1 - p) / n);
      const std::uint8_t sure = p > 0 ? kVisible : kHidden;
      const std::uint8_t verdict = proven ? sure : stop.claim(p, stop.look_at(n));
      result.probability.at(i, j) = static_cast<float>(p);
      result.standard_error.at(i, j) = static_cast<float>(error);
      result.verdict.at(i, j) = verdict;
      result.realisations.at(i, j) = static_cast<std::uint16_t>(n);
      for (std::size_t l = 0; l < result.at_heights.size(); ++l) {
        result.at_heights[l].at(i, j) =
            static_cast<float>(cells.answer(r, c, static_cast<int>(l) + 1, most).share);
      }
      report.expected_m2 += p * area;
      report.largest_standard_error = std::max(report.largest_standard_error, error);
      report.in_doubt_m2 += proven ? 0 : area;
      (verdict == kVisible  ? report.visible_m2
       : verdict == kHidden ? report.hidden_m2
                            : report.uncertain_m2) += area;
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

void warn_of_one_terrain(const OpenTerrain& open, const ProbableOptions& options, ProbableReport& report) {
  const SampleField& measured = open.shared ? *open.shared : open.spread;
  if (options.method != Terrains::kPerturb || !measured.is_constant() || measured.constant() > 0) return;
  report.warnings.push_back(
      "The error model holds no measurement error, so there is nothing to add: all perturbed terrains are "
      "the DEM. "
      "Give vertical_rmse.");
}

// An observer sees what he stands on.
void see_own_cells(const std::vector<Post>& posts, const Window& window, CellsInDoubt& cells) {
  for (const Post& post : posts) {
    if (post.place.col == 0 && post.place.row == 0)
      cells.add_seen(post.place.base_row - window.row, post.place.base_col - window.col);
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
  report.heights = options.heights;

  const Georeference georeference = georeference_of(source);
  const std::vector<Post> posts = place_observers(source, georeference, observers, options.extent, progress);
  const auto drawn = [&](const ErrorModel& whole) {
    return options.method == Terrains::kPerturb ? of_measurement(whole) : whole;
  };
  const Plan plan = plan_memory(posts, source, drawn(model), loading, options.heights.size());
  progress.begin(0.05, 1);
  const ErrorModel completed = complete_model(model, source, report.warnings, progress);
  report.error_model = completed.describe();
  progress.begin(0.05, 1);
  const LoadedTerrain terrain(source, georeference, plan.terrain, drawn(completed), loading, report.warnings,
                              workers, progress);
  place_eyes(posts, terrain, report);
  const Grid<std::uint8_t> asked = asked_of(posts, terrain, workers, progress);
  const Behind behind(terrain, options, workers, progress);
  warn_of_one_terrain(behind.open(), options, report);
  std::vector<ProbableView> views = views_of(posts, terrain, behind.open(), options);
  const EarlyStop stop(options.realisations, options.confidence, options.precision);
  CellsInDoubt cells(plan.terrain.rows, plan.terrain.cols, static_cast<int>(options.heights.size()) + 1);
  cells.count(views, stop, MemoryBudget(options.memory_budget), plan.bytes, workers, progress, 0.88);
  see_own_cells(posts, plan.terrain, cells);
  say_what_was_seen(cells, asked, stop, terrain, plan.canvas, result);

  const std::vector<std::string> notes = source.notes();
  report.warnings.insert(report.warnings.begin(), notes.begin(), notes.end());
  if (source.flipped()) {
    result.probability.flip_rows();
    result.standard_error.flip_rows();
    result.verdict.flip_rows();
    result.realisations.flip_rows();
    for (Grid<float>& one : result.at_heights) one.flip_rows();
  }
  result.geotransform = delivered_geotransform(source, plan.canvas);
  result.crs_wkt = source.crs_wkt();
  progress.finish();
  return result;
}

}  // namespace sightbound
