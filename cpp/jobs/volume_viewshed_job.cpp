// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/volume_viewshed_job.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>

#include "base/error.h"
#include "base/memory_budget.h"
#include "base/number_text.h"
#include "base/parallel.h"

namespace sightbound {

namespace {

constexpr int kTile = 16;                       // columns; targets are timed by the square
constexpr double kTimedSeconds = 1.5;           // for an estimate
constexpr std::size_t kBytesOfView = 32 << 10;  // the faces around a view place and its cell, about

// One job: views placed, targets laid out, memory asked for.
struct Prepared {
  ViewPlaces views;
  std::shared_ptr<const TargetLattice> targets;
  SightEstimate estimate;
};

void require_lines(const SightEstimate& estimate, double spacing_m, double most) {
  if (estimate.lines <= most) return;
  const double fits =
      std::ceil(spacing_m * std::sqrt(estimate.lines / most));  // targets go with 1 / spacing^2
  throw InvalidInput("most_lines is " + number_text(most, 6) + ", but " + number_text(estimate.lines, 6) +
                     " lines of sight are needed (" + std::to_string(estimate.view_places) +
                     " view places, " + std::to_string(estimate.targets) + " targets " +
                     number_text(spacing_m, 6) + " m apart). Targets " + number_text(fits, 6) +
                     " m apart would fit, or a larger view_spacing, or a larger most_lines.");
}

Prepared prepare(const ErrorVolume& volume, const std::vector<ViewVolume>& views,
                 const VolumeSightOptions& options, std::shared_ptr<const TargetLattice> targets) {
  Prepared job;
  job.views = view_places(volume.surface(), views, options.height_reference, options.view_spacing,
                          targets->spacing_m);
  job.targets = std::move(targets);
  job.estimate.view_places = job.views.places.size();
  job.estimate.targets = job.targets->targets();
  job.estimate.lines =
      static_cast<double>(job.targets->targets()) * static_cast<double>(job.views.places.size());
  require_lines(job.estimate, job.targets->spacing_m, options.most_lines);
  job.estimate.bytes =
      HiddenVolumeBuilder::bytes_needed(*job.targets) + job.estimate.view_places * kBytesOfView;
  MemoryBudget(options.memory_budget)
      .require(job.estimate.bytes,
               "The hidden volume of " + std::to_string(job.estimate.targets) + " targets from " +
                   std::to_string(job.estimate.view_places) + " view places",
               "Give a larger target_spacing or view_spacing, or a lower target_ceiling.");
  return job;
}

std::shared_ptr<const TargetLattice> lay_out(const ErrorVolume& volume, const VolumeSightOptions& options,
                                             const Workers& workers, Progress& progress) {
  progress.begin(0.05, 1);
  return lattice_above(volume.surface(), options.targets, workers, progress);
}

void require_positive(double value, const char* field) {
  if (value > 0) return;  // false for a NaN
  throw InvalidInput(std::string(field) + " is " + std::to_string(value) + "; it must be more than 0.");
}

void validate(const VolumeSightOptions& options) {
  two_sided_quantile(options.confidence);  // refuses what is none
  require_positive(options.max_distance, "max_distance");
  require_positive(options.most_lines, "most_lines");
  if (!(options.refraction >= -1 && options.refraction <= 1))
    throw InvalidInput("refraction is " + std::to_string(options.refraction) + "; allowed are -1 to 1.");
}

// The volume made ready for lines.
class Lines {
 public:
  Lines(const ErrorVolume& volume, const VolumeSightOptions& options)
      : options_(options),
        rays_(volume),
        sight_(rays_, options.curvature ? ground_bend(volume.surface(), options.refraction) : GroundBend{}) {}

  HiddenVolume see(const Prepared& job, const Workers& workers, Progress& progress) const {
    VolumeViewshedOptions used;
    used.confidence = options_.confidence;
    used.seen_from = options_.seen_from;
    used.holds_for = options_.holds_for;
    used.max_distance_m = std::min(options_.max_distance, used.max_distance_m);
    HiddenVolume hidden = volume_viewshed(sight_, job.views.places, job.targets, used, workers, progress);
    hidden.info().error_model = rays_.volume().error_model();
    hidden.info().observers = job.views.as_json;
    return hidden;
  }

  // Seconds that it takes.
  double time_of(const Prepared& job, const Workers& workers) const {
    Progress unheard;
    const auto begin = std::chrono::steady_clock::now();
    see(job, workers, unheard);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }

 private:
  const VolumeSightOptions& options_;
  VolumeRays rays_;
  VolumeSight sight_;
};

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
double seconds_of(const Prepared& job, const Lines& lines, const Workers& workers) {
  Prepared part = job;
  part.targets = some_of(*job.targets, 0, 0);
  const double idle = lines.time_of(part, workers), all = static_cast<double>(job.estimate.targets);
  double spent = 0, asked = 0;
  std::size_t from = 0;
  for (std::size_t to = 8; spent < kTimedSeconds && asked < all; from = std::exchange(to, 3 * to)) {
    part.targets = some_of(*job.targets, from, to);
    spent += std::max(lines.time_of(part, workers) - idle, 0.0);
    asked += static_cast<double>(part.targets->targets());
  }
  return asked > 0 ? idle + spent * all / asked : idle;
}

}  // namespace

SightEstimate estimate_sight(const ErrorVolume& volume, const std::vector<ViewVolume>& views,
                             const VolumeSightOptions& options, Progress& progress) {
  validate(options);
  const Workers workers(options.threads);
  Prepared job = prepare(volume, views, options, lay_out(volume, options, workers, progress));
  progress.check();
  job.estimate.seconds = seconds_of(job, Lines(volume, options), workers);
  progress.finish();
  return job.estimate;
}

HiddenResult run_volume_viewshed(const ErrorVolume& volume, const std::vector<ViewVolume>& views,
                                 const VolumeSightOptions& options, Progress& progress) {
  validate(options);
  const Workers workers(options.threads);
  Prepared job = prepare(volume, views, options, lay_out(volume, options, workers, progress));
  HiddenVolume hidden = Lines(volume, options).see(job, workers, progress);
  return {std::move(hidden), job.estimate, std::move(job.views.warnings)};
}

Subtraction subtract_observer(const HiddenVolume& hidden, const ErrorVolume& volume,
                              const std::vector<ViewVolume>& views, const VolumeSightOptions& options,
                              double height_m, Progress& progress) {
  validate(options);
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
  const HiddenVolume seen = Lines(volume, used).see(job, workers, progress);
  Subtraction out{union_of_seen(hidden, seen), 0, 0, before, {}, job.estimate, std::move(job.views.warnings)};
  out.after = hidden_area(out.rest, height_m);
  const VerdictVolumes was = hidden.volumes(), is = out.rest.volumes();
  out.gained_m3 = is.visible_m3 - was.visible_m3;
  out.gained_core_m3 = was.hidden_m3 - is.hidden_m3;
  return out;
}

}  // namespace sightbound
