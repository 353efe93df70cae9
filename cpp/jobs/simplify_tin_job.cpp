// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/simplify_tin_job.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "base/error.h"
#include "base/memory_budget.h"
#include "base/number_text.h"
#include "simplify/both_ways.h"
#include "simplify/height_containment.h"
#include "simplify/simplify_tin.h"
#include "volume/error_volume.h"
#include "volume/tin_surface.h"
#include "volume/voxel_size.h"

namespace sightbound {

namespace {

constexpr double kAnyConfidence = 0.95;  // stands for a tolerance: any would do

// Of the voxel that just fits into the volume. A surface has the tolerance less about a voxel to move in.
constexpr double kVoxelShare = 0.5;

double confidence_of(const SimplifyTinJob& job) { return job.tolerance_m ? kAnyConfidence : job.confidence; }

// Metres that one sigma stands for in the tolerance.
TinError error_of(const Tin& tin, const SimplifyTinJob& job, Metric metric) {
  if (!job.tolerance_m) return resolve_tin_error(tin, job.model, metric);
  const double tolerance = *job.tolerance_m;
  if (!(tolerance >= 0 && tolerance <= kLargestError)) {
    throw InvalidInput("tolerance is " + number_text(tolerance) + "; give metres, 0 to " +
                       number_text(kLargestError) + ".");
  }
  const double sigma = tolerance / two_sided_quantile(kAnyConfidence);
  TinError error;
  error.sampling.assign(tin.vertices.size(), std::nextafter(static_cast<float>(sigma), 0.0F));
  error.spacing_m = median_edge(tin);
  return error;
}

void set_tolerances(const TinError& error, const SimplifyTinJob& job, SimplifyTinReport& report) {
  const double z = two_sided_quantile(confidence_of(job));
  double least = std::numeric_limits<double>::infinity(), largest = 0;
  for (std::size_t v = 0; v < error.sampling.size(); ++v) {
    const double sigma = static_cast<double>(error.sampling[v]);
    const double between = error.amplitude.empty() ? 0 : static_cast<double>(error.amplitude[v]);
    least = std::min(least, z * std::max(sigma, kLeastSigma));
    largest = std::max(largest, z * std::max(sigma + between, kLeastSigma));
  }
  report.least_tolerance_m = job.tolerance_m.value_or(least);
  report.largest_tolerance_m = job.tolerance_m.value_or(largest);
  if (job.border_tolerance_m) {
    report.border_tolerance_m = *job.border_tolerance_m;
  } else if (report.vertical) {
    report.border_tolerance_m = job.tolerance_m ? 0 : z * job.model.horizontal_rmse;
  } else {
    report.border_tolerance_m = report.least_tolerance_m;
  }
}

VolumeOptions volume_options(const Surface& surface, const SimplifyTinJob& job) {
  VolumeOptions options;
  options.confidence = options.largest_confidence = confidence_of(job);
  options.voxel_m = job.voxel_m;
  options.threads = job.threads;
  options.memory_bytes = job.memory_budget;
  if (options.voxel_m == 0) options.voxel_m = kVoxelShare * choose_voxels(surface, options).voxel_m;
  return options;
}

// metres at each vertex, at most.
std::vector<float> tolerances_of(const TinError& error, const SimplifyTinJob& job) {
  const double z = two_sided_quantile(confidence_of(job));
  std::vector<float> tolerance(error.sampling.size());
  for (std::size_t v = 0; v < tolerance.size(); ++v) {
    const double sigma = std::max(static_cast<double>(error.sampling[v]), kLeastSigma);
    tolerance[v] = std::nextafter(static_cast<float>(job.tolerance_m ? *job.tolerance_m : z * sigma), 0.0F);
  }
  return tolerance;
}

GridContainment grid_of(const Tin& tin, TinError error, const SimplifyTinJob& job, SimplifyTinReport& report,
                        Progress& progress) {
  const auto surface = std::make_shared<TinSurface>(tin, std::move(error), Metric::kNormal);
  const VolumeOptions options = volume_options(*surface, job);
  const std::size_t collapses = simplify_tin_memory(tin) + tin.faces.size() * BothWays::kBytesPerFace;
  MemoryBudget(job.memory_budget)
      .require(collapses + estimate_need(*surface, options).bytes,
               "Simplifying " + std::to_string(tin.faces.size()) + " faces with voxels of " +
                   number_text(options.voxel_m, 3) + " m",
               "Give a larger voxel_size, or a part of the TIN.");
  CoverMasks covers = build_covers(surface, options.confidence, options, progress);
  report.voxel_m = covers.voxel_m;
  const HeldFaces held = count_held(*surface, {covers.voxel_m, covers.voxel_height_m}, options.confidence);
  report.faces_not_held = held.not_held;
  if (held.not_held > 0) {
    report.warnings.push_back(std::to_string(held.not_held) + " of " + std::to_string(held.faces) +
                              " faces are too well known for voxels of " + number_text(covers.voxel_m, 3) +
                              " m: little of the tolerance can be used there.");
  }
  return {PermissionGrid(std::move(covers.inner), covers.voxel_m, covers.voxel_height_m),
          tin.vertices.front() - surface->vertex(0)};
}

bool is_below_all_voxels(const SimplifyTinJob& job, SimplifyTinReport& report) {
  const double least = two_sided_quantile(confidence_of(job)) * kLeastSigma;
  if (!job.tolerance_m || *job.tolerance_m > least) return false;
  if (*job.tolerance_m > 0) {
    report.warnings.push_back("A tolerance of less than " + number_text(least, 2) +
                              " m is taken for 0: only what is coplanar goes.");
  }
  return true;
}

// An outline that moves may run over another part of the TIN; then it must not.
TinSimplified simplify_height_field(const Tin& tin, const std::vector<float>& tolerance,
                                    const TinSimplifyOptions& options, SimplifyTinReport& report,
                                    Progress& progress) {
  const bool outline_moves = options.outline_tolerance_m > 0;
  HeightContainment heights(tin, tolerance);
  progress.begin(outline_moves ? 0.5 : 1, 1);
  TinSimplified made = simplify_tin(tin, heights, options, progress);
  if (!outline_moves || TinSurface::metric_of(made.tin) == Metric::kVertical) return made;
  report.warnings.emplace_back(
      "The outline stays as it is: if it moved, a part of the TIN would lie over another.");
  report.border_tolerance_m = 0;
  TinSimplifyOptions still = options;
  still.outline_tolerance_m = 0;
  HeightContainment again(tin, tolerance);
  progress.begin(0.5, 1);
  return simplify_tin(tin, again, still, progress);
}

TinSimplified simplify(const Tin& tin, TinError error, const SimplifyTinJob& job,
                       const TinSimplifyOptions& options, SimplifyTinReport& report, Progress& progress) {
  if (is_below_all_voxels(job, report)) {
    NothingContained nothing;
    progress.begin(1, 1);
    TinSimplified made = simplify_tin(tin, nothing, options, progress);
    if (report.vertical) made.largest_deviation_m = 0;
    return made;
  }
  const std::vector<float> tolerance = tolerances_of(error, job);
  if (report.vertical) {
    MemoryBudget(job.memory_budget)
        .require(simplify_tin_memory(tin) + tin.faces.size() * HeightContainment::kBytesPerFace,
                 "Simplifying " + std::to_string(tin.faces.size()) + " faces", "Give a part of the TIN.");
    return simplify_height_field(tin, tolerance, options, report, progress);
  }
  progress.begin(0.5, 1);
  GridContainment grid = grid_of(tin, std::move(error), job, report, progress);
  BothWays both_ways(tin, tolerance, grid);
  progress.begin(0.5, 1);
  return simplify_tin(tin, both_ways, options, progress);
}

}  // namespace

SimplifiedAnyTin run_simplify_tin(const Tin& tin, const SimplifyTinJob& job, Progress& progress) {
  check_sizes(tin, "The TIN");
  const Metric metric = TinSurface::metric_of(tin);
  SimplifiedAnyTin result;
  SimplifyTinReport& report = result.report;
  report.vertical = metric == Metric::kVertical;
  report.warnings = tin.notes;
  if (!job.tolerance_m) report.error_model = job.model.describe();
  TinError error = error_of(tin, job, metric);
  set_tolerances(error, job, report);

  TinSimplifyOptions options;
  options.height_field = report.vertical;
  options.outline_tolerance_m = report.border_tolerance_m;
  options.keep = job.keep;
  options.target_faces = job.target_faces;
  TinSimplified made = simplify(tin, std::move(error), job, options, report, progress);
  progress.finish();
  report.faces_before = made.faces_before;
  report.faces_after = made.tin.faces.size();
  report.largest_deviation_m = made.largest_deviation_m;
  report.fixed_vertices = made.fixed_vertices;
  if (made.fixed_vertices > 0) {
    report.warnings.push_back(std::to_string(made.fixed_vertices) +
                              " vertices stay as they are: the faces around them make no plain surface.");
  }
  if (!tin.sigma_v.empty() || !tin.vertex_attributes.empty() || !tin.face_attributes.empty())
    report.warnings.push_back("Attributes of vertices and faces are left out: new vertices have none.");
  result.tin = std::move(made.tin);
  return result;
}

}  // namespace sightbound
