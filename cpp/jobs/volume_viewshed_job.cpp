// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/volume_viewshed_job.h"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <random>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "jobs/sight_lines.h"

namespace sightbound {

namespace {

constexpr int kTile = 16;              // columns; targets are timed by the square
constexpr double kTimedSeconds = 1.5;  // for an estimate

// One job: views placed, targets laid out, memory asked for.
struct Prepared : PlacedViews {
  std::shared_ptr<const TargetLattice> targets;
};

Prepared prepare(const ErrorVolume& volume, const std::vector<ViewVolume>& views,
                 const VolumeSightOptions& options, std::shared_ptr<const TargetLattice> targets) {
  const SightNeed need{targets->targets(), targets->spacing_m, HiddenVolumeBuilder::bytes_needed(*targets)};
  return {place_views(volume, views, options, need), std::move(targets)};
}

std::shared_ptr<const TargetLattice> lay_out(const ErrorVolume& volume, const VolumeSightOptions& options,
                                             const Workers& workers, Progress& progress) {
  progress.begin(0.05, 1);
  return lattice_above(volume.surface(), options.targets, workers, progress);
}

HiddenVolume see(const SightLines& lines, const Prepared& job, const VolumeSightOptions& options,
                 const Workers& workers, Progress& progress) {
  HiddenVolume hidden = volume_viewshed(lines.sight(), job.views.places, job.targets,
                                        viewshed_options(options), workers, progress);
  hidden.info().error_model = lines.sight().rays().volume().error_model();
  hidden.info().observers = job.views.as_json;
  return hidden;
}

// Seconds that it takes.
double time_of(const SightLines& lines, const Prepared& job, const VolumeSightOptions& options,
               const Workers& workers) {
  Progress unheard;
  const auto begin = std::chrono::steady_clock::now();
  see(lines, job, options, workers, unheard);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// The same targets, all left out but those in squares [from, to) of a fixed order that strews them.
std::shared_ptr<const TargetLattice> some_of(const TargetLattice& all, std::size_t from, std::size_t to) {
  auto some = std::make_shared<TargetLattice>(all);
  const auto across = static_cast<std::size_t>((all.nx + kTile - 1) / kTile),
             squares = across * static_cast<std::size_t>((all.ny + kTile - 1) / kTile);
  std::vector<std::size_t> places(squares);
  std::iota(places.begin(), places.end(), std::size_t{0});
  std::shuffle(places.begin(), places.end(), std::mt19937(1));
  std::vector<bool> taken(squares, false);
  for (std::size_t n = from; n < std::min(to, squares); ++n) taken[places[n]] = true;
  for (int j = 0; j < all.ny; ++j) {
    for (int i = 0; i < all.nx; ++i) {
      TargetColumn& column = some->columns[all.number(i, j)];
      const auto square = static_cast<std::size_t>(j / kTile) * across + static_cast<std::size_t>(i / kTile);
      if (!taken[square]) column.last = column.first - 1;
    }
  }
  return some;
}

// From some of the targets, less what a viewshed without any takes.
double seconds_of(const SightLines& lines, const Prepared& job, const VolumeSightOptions& options,
                  const Workers& workers) {
  Prepared part = job;
  part.targets = some_of(*job.targets, 0, 0);
  const double idle = time_of(lines, part, options, workers), all = static_cast<double>(job.estimate.targets);
  double spent = 0, asked = 0;
  std::size_t from = 0;
  for (std::size_t to = 8; spent < kTimedSeconds && asked < all; from = std::exchange(to, 3 * to)) {
    part.targets = some_of(*job.targets, from, to);
    spent += std::max(time_of(lines, part, options, workers) - idle, 0.0);
    asked += static_cast<double>(part.targets->targets());
  }
  return asked > 0 ? idle + spent * all / asked : idle;
}

}  // namespace

SightEstimate estimate_sight(const ErrorVolume& volume, const std::vector<ViewVolume>& views,
                             const VolumeSightOptions& options, Progress& progress) {
  validate_sight(options);
  const Workers workers(options.threads);
  Prepared job = prepare(volume, views, options, lay_out(volume, options, workers, progress));
  progress.check();
  job.estimate.seconds = seconds_of(SightLines(volume, options), job, options, workers);
  progress.finish();
  return job.estimate;
}

HiddenResult run_volume_viewshed(const ErrorVolume& volume, const std::vector<ViewVolume>& views,
                                 const VolumeSightOptions& options, Progress& progress) {
  validate_sight(options);
  const Workers workers(options.threads);
  Prepared job = prepare(volume, views, options, lay_out(volume, options, workers, progress));
  HiddenVolume hidden = see(SightLines(volume, options), job, options, workers, progress);
  return {std::move(hidden), job.estimate, std::move(job.views.warnings)};
}

Subtraction subtract_observer(const HiddenVolume& hidden, const ErrorVolume& volume,
                              const std::vector<ViewVolume>& views, const VolumeSightOptions& options,
                              double height_m, Progress& progress) {
  validate_sight(options);
  const VolumeFrame &a = hidden.lattice().frame, &b = volume.surface().frame();
  if (a.x != b.x || a.y != b.y || a.metres_per_unit != b.metres_per_unit || a.crs_wkt != b.crs_wkt) {
    throw InvalidInput(
        "The hidden volume was made with another error volume (it lies elsewhere, or has another CRS); give "
        "that "
        "one.");
  }
  const HiddenArea before = hidden_area(hidden, height_m);
  VolumeSightOptions used = options;
  used.confidence = hidden.info().confidence;
  const Workers workers(options.threads);
  Prepared job = prepare(volume, views, used, hidden.shared_lattice());
  const HiddenVolume seen = see(SightLines(volume, used), job, used, workers, progress);
  Subtraction out{union_of_seen(hidden, seen), 0, 0, before, {}, job.estimate, std::move(job.views.warnings)};
  out.after = hidden_area(out.rest, height_m);
  const VerdictVolumes was = hidden.volumes(), is = out.rest.volumes();
  out.gained_m3 = is.visible_m3 - was.visible_m3;
  out.gained_core_m3 = was.hidden_m3 - is.hidden_m3;
  return out;
}

}  // namespace sightbound
