// SPDX-License-Identifier: GPL-3.0-or-later
// The probability that a cell is seen, over terrains that could lie behind the DEM.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/progress.h"
#include "jobs/viewshed_job.h"

namespace sightbound {

struct ProbableOptions {
  double confidence = 0.95;
  double refraction = 0.13;
  bool curvature = true;
  int realisations = 1000;
  std::uint64_t seed = 1;
  std::optional<Extent> extent;   // snapped outward to the DEM's grid; empty = the observers' reach
  int threads = 0;                // 0 = all cores
  std::size_t memory_budget = 0;  // bytes; 0 = three quarters of the machine's memory
};

struct ProbableReport {
  std::vector<ObserverReport> observers;  // heights on the DEM; areas of the whole are below
  int realisations = 0;
  double visible_m2 = 0, uncertain_m2 = 0, hidden_m2 = 0;
  double expected_m2 = 0;  // visible area: the sum of all probabilities
  std::string error_model;
  std::vector<std::string> warnings;
};

// All grids in the user's row order, with `geotransform`.
struct ProbableViewshed {
  Grid<float> probability;     // that an observer sees the cell, 0..1; NaN = nodata or not asked
  Grid<float> standard_error;  // of that, from the number of realisations
  // A claim at the confidence c: visible when the lower end of the interval of 95 % for the probability
  // (Wilson 1927) is (1 + c) / 2 or more, hidden when its upper end is (1 - c) / 2 or less.
  Grid<std::uint8_t> verdict;
  Geotransform geotransform;
  std::string crs_wkt;
  ProbableReport report;
};

// Eye and target stand on the ground of each realisation. A cell behind unknown ground (nodata) counts as not
// seen. The same bytes for any number of threads and any extent. Throws InvalidInput, IoError, OverBudget,
// Cancelled.
ProbableViewshed run_probable_viewshed(const DemSource&, const std::vector<Observer>&, const ErrorModel&,
                                       const ProbableOptions&, Progress&);

}  // namespace sightbound
