// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/simplify_tin_job.h"

#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/memory_budget.h"
#include "base/number_text.h"
#include "io/crs.h"
#include "jobs/tin_tolerance.h"
#include "jobs/tin_voxels.h"
#include "simplify/both_ways.h"
#include "simplify/break_lines.h"
#include "simplify/height_containment.h"
#include "simplify/simplify_tin.h"
#include "volume/error_volume.h"
#include "volume/tin_surface.h"
#include "volume/voxel_size.h"

namespace sightbound {

namespace {

// metres; a voxel has 1 mm at least.
constexpr double kLeastInVoxels = 0.002;

void tell(const TinTolerance& tolerance, const SimplifyTinJob& job, SimplifyTinReport& report) {
  const bool metres = job.tolerance_m || !job.tolerances_m.empty();
  if (!metres) report.error_model = job.model.describe();
  report.least_tolerance_m = tolerance.least;
  report.largest_tolerance_m = tolerance.largest;
  if (job.border_tolerance_m) {
    report.border_tolerance_m = *job.border_tolerance_m;
  } else if (report.vertical) {
    report.border_tolerance_m =
        metres ? 0 : two_sided_quantile(tolerance.confidence, tolerance.tails) * job.model.horizontal_rmse;
  } else {
    report.border_tolerance_m = tolerance.least;
  }
}

GridContainment grid_of(const Tin& tin, TinTolerance& tolerance, const SimplifyTinJob& job,
                        SimplifyTinReport& report, Progress& progress) {
  const std::size_t collapses = simplify_tin_memory(tin) + tin.faces.size() * BothWays::kBytesPerFace;
  const double wanted = voxel_for(tolerance);
  const auto surface = std::make_shared<TinSurface>(tin, std::move(tolerance.error), Metric::kNormal);
  VolumeOptions options;
  options.confidence = options.largest_confidence = tolerance.confidence;
  options.tails = tolerance.tails;
  options.threads = job.threads;
  options.memory_bytes = job.memory_budget;
  options.voxel_m = job.voxel_m;
  const MemoryBudget budget(job.memory_budget);
  if (job.voxel_m == 0) options.voxel_m = affordable_voxel(*surface, wanted, options, budget, collapses);
  budget.require(collapses + estimate_need(*surface, options).bytes,
                 "Simplifying " + std::to_string(tin.faces.size()) + " faces with voxels of " +
                     number_text(options.voxel_m, 3) + " m",
                 "Give a larger voxel_m, or a part of the TIN.");
  CoverMasks covers = build_covers(surface, options.confidence, options, progress);
  report.voxel_m = covers.voxel_m;
  const HeldFaces held =
      count_held(*surface, {covers.voxel_m, covers.voxel_height_m}, options.confidence, options.tails);
  report.faces_not_held = held.not_held;
  if (held.not_held > 0)
    report.warnings.push_back(too_coarse(held, covers.voxel_m, wanted, job.voxel_m == 0));
  return {PermissionGrid(std::move(covers.inner), covers.voxel_m, covers.voxel_height_m),
          tin.vertices.front() - surface->vertex(0)};
}

bool is_below_all_voxels(const TinTolerance& tolerance, SimplifyTinReport& report) {
  if (tolerance.largest > kLeastInVoxels) return false;
  report.warnings.push_back("No voxel is small enough for a tolerance of " +
                            number_text(tolerance.largest, 3) + " m (more than " +
                            number_text(kLeastInVoxels, 2) + " m would do): only what is coplanar goes.");
  return true;
}

// An outline that moves may run over another part of the TIN; then it must not.
TinSimplified simplify_height_field(const Tin& tin, const std::vector<float>& tolerance,
                                    const TinSimplifyOptions& options, SimplifyTinReport& report,
                                    Progress& progress) {
  const bool outline_moves = options.outline_tolerance_m > 0;
  HeightContainment heights(tin, tolerance, outline_moves);
  progress.begin(outline_moves ? 0.5 : 1, 1);
  TinSimplified made = simplify_tin(tin, heights, options, progress);
  if (!outline_moves || TinSurface::metric_of(made.tin) == Metric::kVertical) return made;
  report.warnings.emplace_back(
      "The outline stays as it is: if it moved, a part of the TIN would lie over another.");
  report.border_tolerance_m = 0;
  TinSimplifyOptions still = options;
  still.outline_tolerance_m = 0;
  HeightContainment again(tin, tolerance, false);
  progress.begin(0.5, 1);
  return simplify_tin(tin, again, still, progress);
}

std::vector<TinEdge> break_edges(const Tin& tin, const SimplifyTinJob& job, bool in_plan,
                                 Progress& progress) {
  for (const std::vector<Xyz>& line : job.break_lines) {
    for (const Xyz& p : line) {
      if (!std::isfinite(p.x) || !std::isfinite(p.y))
        throw InvalidInput("break_lines has a vertex without place.");
      if (in_plan || std::isfinite(p.z)) continue;
      throw InvalidInput(
          "break_lines has a vertex without height; a TIN that is no height field needs lines with heights.");
    }
  }
  return edges_along(tin, job.break_lines, in_plan, progress);
}

TinSimplified simplify(const Tin& tin, TinTolerance tolerance, const SimplifyTinJob& job,
                       const TinSimplifyOptions& options, SimplifyTinReport& report, Progress& progress) {
  if (tolerance.largest == 0 || (!report.vertical && is_below_all_voxels(tolerance, report))) {
    NothingContained nothing;
    progress.begin(1, 1);
    TinSimplified made = simplify_tin(tin, nothing, options, progress);
    if (report.vertical) made.largest_deviation_m = made.largest_ratio = 0;
    return made;
  }
  if (report.vertical) {
    MemoryBudget(job.memory_budget)
        .require(simplify_tin_memory(tin) + tin.faces.size() * HeightContainment::kBytesPerFace,
                 "Simplifying " + std::to_string(tin.faces.size()) + " faces", "Give a part of the TIN.");
    return simplify_height_field(tin, tolerance.metres, options, report, progress);
  }
  progress.begin(0.5, 1);
  GridContainment grid = grid_of(tin, tolerance, job, report, progress);
  BothWays both_ways(tin, tolerance.metres, grid);
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
  TinTolerance tolerance = tolerance_of(tin, job, metric);
  tell(tolerance, job, report);

  TinSimplifyOptions options;
  options.height_field = report.vertical;
  options.outline_tolerance_m = report.border_tolerance_m;
  options.break_lines = break_edges(tin, job, report.vertical, progress);
  options.break_tolerance_m = job.break_line_tolerance_m;
  options.keep = job.keep;
  options.target_faces = job.target.faces;
  Tin like;
  like.crs_wkt = horizontal_crs(tin.crs_wkt);
  if (report.vertical) like.face_attributes = {{"deviation", {}}};
  options.target_bytes = bytes_for(job.target, like);
  TinSimplified made = simplify(tin, std::move(tolerance), job, options, report, progress);
  progress.finish();
  report.faces_before = made.faces_before;
  report.faces_after = made.tin.faces.size();
  report.largest_deviation_m = made.largest_deviation_m;
  report.largest_ratio = made.largest_ratio;
  report.fixed_vertices = made.fixed_vertices;
  say_what_is_missed(job.target, options.target_bytes, made.tin, report.warnings);
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
