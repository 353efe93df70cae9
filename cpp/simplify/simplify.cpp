// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/simplify.h"

#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/memory_budget.h"
#include "base/number_text.h"
#include "base/parallel.h"
#include "simplify/decimation.h"
#include "simplify/envelope.h"

namespace sightbound {

namespace {

constexpr std::size_t kBytesPerSample = 170;  // mesh 88, quadrics 40, states 12, tiles 8, and growth
constexpr std::size_t kBytesOfQueue = 170;    // more, with a target: all edges in one queue, stale ones too
constexpr std::size_t kMostSamples = std::size_t{1} << 28;  // eight corners each, numbered in 31 bits

void check(const DemTerrain& terrain, const SimplifyOptions& options) {
  const Grid<float>& z = terrain.heights;
  if (z.rows() < 2 || z.cols() < 2) {
    throw InvalidInput("The DEM has " + std::to_string(z.rows()) + " x " + std::to_string(z.cols()) +
                       " samples; a surface needs 2 x 2 at least.");
  }
  if (z.rows() > kMostCells || z.cols() > kMostCells) {
    throw InvalidInput("The DEM has " + std::to_string(z.rows()) + " x " + std::to_string(z.cols()) +
                       " samples, more than " + std::to_string(kMostCells) + " a side; give a part of it.");
  }
  if (z.size() >= kMostSamples) {
    throw InvalidInput("The DEM has " + std::to_string(z.size()) +
                       " samples, too many for one piece (2^28); give a part of it.");
  }
  for (const float height : z.values()) {
    if (std::isinf(height)) throw InvalidInput("A height of the DEM is infinite; make it nodata (NaN).");
  }
  const auto check_value = [](double tolerance) {
    if (!(tolerance >= 0) || !std::isfinite(tolerance)) {
      throw InvalidInput("tolerance is " + number_text(tolerance) + "; give metres, 0 or more.");
    }
  };
  const auto check_size = [&](int rows, int cols, const std::string& name) {
    if (rows == z.rows() && cols == z.cols()) return;
    throw InvalidInput(name + " has " + std::to_string(rows) + " x " + std::to_string(cols) +
                       " values, the DEM " + std::to_string(z.rows()) + " x " + std::to_string(z.cols()) +
                       "; give one for each sample.");
  };
  if (options.tolerance.empty()) {
    check_value(options.tolerance_m);
  } else {
    check_size(options.tolerance.rows(), options.tolerance.cols(), "tolerance");
    for (std::size_t i = 0; i < z.size(); ++i) {
      if (!std::isnan(z.values()[i])) check_value(options.tolerance.values()[i]);
    }
  }
  if (!options.keep.empty()) check_size(options.keep.rows(), options.keep.cols(), "keep");
  if (options.target_faces < 0) {
    throw InvalidInput("target_faces is " + std::to_string(options.target_faces) +
                       "; give 0 (no target) or more.");
  }
  if (!(options.least_gain >= 0 && options.least_gain <= 1)) {
    throw InvalidInput("least_gain is " + number_text(options.least_gain) + "; give a part, 0 to 1.");
  }
}

// Samples that have to stay.
void fix(PlanMesh& mesh, const SimplifyOptions& options) {
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(mesh.vertices()); ++v) {
    const int r = mesh.step_y(v) / kStepsPerCell, c = mesh.step_x(v) / kStepsPerCell;
    const bool kept = !options.keep.empty() && options.keep.at(r, c) != 0;
    if (kept || (options.keep_border && mesh.kind(v) != VertexKind::kInside))
      mesh.set_kind(v, VertexKind::kFixed);
  }
}

// Tiles wander, so that what lies at a seam in one pass lies inside a tile in another: after four passes
// nothing has always been at one. A target needs all of the plane to be one tile: only then the cheapest go
// first everywhere.
void decimate(PlanMesh& mesh, const Original& original, const SimplifyOptions& options,
              const Workers& workers, Progress& progress) {
  constexpr std::array<std::array<int, 2>, 4> kShifts{
      {{0, 0}, {2, 2}, {0, 2}, {2, 0}}};  // quarters of a tile
  constexpr std::size_t kLeastPasses = kShifts.size(), kMostPasses = 24;
  const auto target = static_cast<std::size_t>(options.target_faces);
  const Envelope envelope(original);
  Decimation decimation(mesh, envelope);
  std::size_t faces = mesh.count_faces();
  double left = 1;  // of the progress
  for (std::size_t n = 0; n < kMostPasses && faces > target; ++n) {
    PassPlan plan{.relax = n > 0, .share = n == 0 ? 0.6 : 0.3 * left};
    left -= plan.share;
    if (target > 0) {
      plan.tile = kMostCells;
      plan.most_faces = faces - target;
    } else {
      plan.shift_x = kShifts[n % kShifts.size()][0] * plan.tile / 4;
      plan.shift_y = kShifts[n % kShifts.size()][1] * plan.tile / 4;
    }
    const std::size_t gone = decimation.pass(plan, workers, progress);
    faces -= gone;
    const bool seams_seen = target > 0 || n + 1 >= kLeastPasses;
    if (seams_seen && static_cast<double>(gone) < options.least_gain * static_cast<double>(faces)) return;
  }
}

float rounded_up(double value) {
  const auto near = static_cast<float>(value);
  return near < value ? std::nextafter(near, std::numeric_limits<float>::infinity()) : near;
}

// What the mesh has become, with the largest deviation on each face.
void write(const PlanMesh& mesh, const DemTerrain& terrain, const Original& original, SimplifiedTin& result,
           Progress& progress) {
  Tin& tin = result.tin;
  const Geotransform& map = terrain.geotransform;
  tin.crs_wkt = terrain.crs_wkt;
  tin.metres_per_unit = terrain.metres_per_unit;
  const Xy middle = map.of_sample(terrain.heights.cols() / 2.0, terrain.heights.rows() / 2.0);
  tin.origin = {std::round(middle.x), std::round(middle.y), 0};
  std::vector<std::int32_t> number(mesh.vertices(), PlanMesh::kNone);
  const auto vertex_of = [&](std::int32_t v) {
    std::int32_t& n = number[static_cast<std::size_t>(mesh.twin_of(v))];
    if (n == PlanMesh::kNone) {
      n = static_cast<std::int32_t>(tin.vertices.size());
      const Point place = mesh.place(v);
      const Xy p = map.of_sample(place.x, place.y);
      tin.vertices.push_back(tin.from_crs({p.x, p.y, place.z}));
    }
    return n;
  };
  // Counterclockwise in rows that run down is clockwise on the ground, unless the raster is mirrored.
  const auto& g = map.coefficients();
  const bool mirrored = g[1] * g[5] - g[2] * g[4] > 0;
  TinAttribute deviation{"deviation", {}};
  tin.faces.reserve(mesh.count_faces());
  deviation.values.reserve(tin.faces.capacity());
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangles()); ++t) {
    if (t % 4096 == 0) progress.check();
    if (!mesh.alive(t)) continue;
    const std::int32_t a = mesh.vertex(4 * t), b = mesh.vertex(4 * t + 1), c = mesh.vertex(4 * t + 2);
    const std::int32_t first = vertex_of(a), second = vertex_of(b), third = vertex_of(c);
    tin.faces.push_back(mirrored ? Face{first, second, third} : Face{first, third, second});
    const Deviation off = deviation_of(original, mesh.place(a), mesh.place(b), mesh.place(c));
    SimplifyReport& report = result.report;
    report.largest_deviation_m = std::max(report.largest_deviation_m, off.metres);
    report.largest_ratio = std::max(report.largest_ratio, off.ratio);
    deviation.values.push_back(rounded_up(off.metres));
  }
  tin.face_attributes.push_back(std::move(deviation));
  result.report.faces_after = tin.faces.size();
}

}  // namespace

SimplifiedTin simplify_dem(const DemTerrain& terrain, const SimplifyOptions& options, Progress& progress) {
  check(terrain, options);
  MemoryBudget(options.memory_bytes)
      .require(terrain.heights.size() * (kBytesPerSample + (options.target_faces > 0 ? kBytesOfQueue : 0)),
               "Simplifying the DEM", "Give a part of it.");
  const Workers workers(options.threads);
  SimplifiedTin result;
  const Original original(terrain.heights, options.tolerance, options.tolerance_m);
  progress.check();
  PlanMesh mesh(terrain.heights);
  progress.check();
  result.report.faces_before = mesh.count_faces();
  result.report.kept_for_rounding_m = 2 * original.rounding();
  if (result.report.faces_before == 0)
    throw InvalidInput("The DEM has no three samples side by side that are not nodata: it makes no surface.");
  fix(mesh, options);
  decimate(mesh, original, options, workers, progress);
  write(mesh, terrain, original, result, progress);
  return result;
}

}  // namespace sightbound
