// SPDX-License-Identifier: GPL-3.0-or-later
// A whole job: any TIN to one of few triangles inside its error volume, or within a tolerance.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "error_model/error_model.h"
#include "jobs/tin_target.h"
#include "terrain/tin.h"

namespace sightbound {

struct SimplifyTinJob {
  // How far the surface may go: so many metres, the same everywhere or a value at each vertex (linear on each
  // face), or to the end of the error volume of `model` at a confidence. Vertically for height fields, else
  // by distance.
  std::optional<double> tolerance_m;
  std::vector<float> tolerances_m;  // instead
  ErrorModel model;
  double confidence = 0.95;
  // How far the outline may go: in plan for height fields, else in space. Empty: height fields with a
  // tolerance not at all, with a model by z(c) times its horizontal error; others by the least tolerance.
  std::optional<double> border_tolerance_m;
  // Polylines along which edges run, in metres from the Tin's origin, and still run in the result; z counts
  // where the TIN is no height field. How far they may move, measured as the outline's.
  std::vector<std::vector<Xyz>> break_lines;
  double break_line_tolerance_m = 0;
  std::vector<std::uint8_t> keep;  // vertices that stay where not 0; empty = none
  TinTarget target{};              // none = until nothing can be removed
  double voxel_m = 0;              // of the permission grid; 0 = chosen
  int threads = 0;                 // of building it; 0 = all cores
  std::size_t memory_budget = 0;   // bytes; 0 = three quarters of the machine's memory
};

struct SimplifyTinReport {
  std::size_t faces_before = 0, faces_after = 0;
  bool vertical = false;  // how the tolerance is measured
  double least_tolerance_m = 0, largest_tolerance_m = 0;
  // Of height fields: certified, nowhere more.
  std::optional<double> largest_deviation_m, largest_ratio;  // of deviation to tolerance
  double border_tolerance_m = 0;
  double voxel_m = 0;              // 0: no voxel is small enough for the tolerance
  std::size_t faces_not_held = 0;  // too steep or too well known for the voxels: little goes there
  std::size_t fixed_vertices = 0;  // where the surface is not manifold
  std::string error_model;         // JSON of what was used; empty with a tolerance
  std::vector<std::string> warnings;
};

struct SimplifiedAnyTin {
  Tin tin;
  SimplifyTinReport report;
};

// Every point of the result is within the tolerance of the original (simplify/simplify_tin.h). The Tin must
// be clean. Throws InvalidInput, OverBudget (naming the voxels that would fit), Cancelled.
SimplifiedAnyTin run_simplify_tin(const Tin&, const SimplifyTinJob&, Progress&);

}  // namespace sightbound
