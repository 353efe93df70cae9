// SPDX-License-Identifier: GPL-3.0-or-later
// A whole job: a DEM to the smallest TIN that stays within its error, or within a tolerance; or to several,
// each made from the one before.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "error_model/error_model.h"
#include "jobs/tin_target.h"
#include "jobs/windows.h"
#include "simplify/simplify.h"
#include "terrain/dem.h"

namespace sightbound {

// What an error model means for the surface: it stays within z(confidence) sigma_s, or sigma_s is the
// tolerance itself.
enum class ErrorMeans { kConfidence, kTolerance };

struct DemToTinOptions {
  ErrorMeans error_means = ErrorMeans::kConfidence;
  // Confidences, or with kTolerance multiples of the tolerance beginning with 1: a TIN for each. They ascend.
  // Empty: one TIN, at 0.95 or within the tolerance.
  std::vector<double> levels;
  std::optional<Extent> extent;  // snapped outward to the DEM's grid; empty = the whole DEM
  SharedGrid
      keep;  // on the grid of the whole DEM: samples that stay vertices at their own height where above 0
  bool keep_border = false;       // all samples of the outline and of holes stay: neighbouring tiles fit
  double border_tolerance_m = 0;  // by which the outline may move in plan
  // Polylines in the DEM's CRS that the TIN carries as edges, each within a tolerance in plan of the samples
  // that follow the line; empty: of a cell's longer side.
  std::vector<std::vector<Xy>> break_lines;
  std::optional<double> break_line_tolerance_m;
  TinTarget target{};             // none = until nothing can be removed
  int threads = 0;                // 0 = all cores
  std::size_t memory_budget = 0;  // bytes; 0 = three quarters of the machine's memory
};

struct DemToTin {
  std::vector<SimplifiedTin> levels;
  double least_tolerance_m = 0, largest_tolerance_m = 0;  // of the first level, at the samples
  std::vector<double> factors;                            // by which those of each level are larger
  std::string error_model;                                // JSON of what was used
  std::vector<std::string> warnings;
};

// Between the samples sigma is never below sigma_s there: what lies within E(c) of sigma_s lies within the
// error volume. Throws InvalidInput (degrees: reproject), IoError, OverBudget, Cancelled.
DemToTin run_dem_to_tin(const DemSource&, const ErrorModel&, const DemToTinOptions&, Progress&);

}  // namespace sightbound
