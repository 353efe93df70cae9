// SPDX-License-Identifier: GPL-3.0-or-later
// The probability that a cell is seen, over terrains that could lie behind the DEM.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/progress.h"
#include "jobs/viewshed_job.h"

namespace sightbound {

// What is drawn.
enum class Terrains {
  kConditional,  // terrains that agree with the DEM as far as it can be trusted, and rise and fall between
                 // its samples
  // The DEM with an error of sigma_s added to each sample (Fisher 1991), and straight between them: the
  // literature's. The DEM has its error once already, so that ground is drawn too rough at the samples, and
  // nothing hides between them.
  kPerturb
};

struct ProbableOptions {
  double confidence = 0.95;
  double refraction = 0.13;
  bool curvature = true;
  int realisations = 1000;  // at most
  // A cell is left when the interval of its probability is no wider than twice this, and its claim is clear
  // (early_stop.h); 0 = never.
  double precision = 0.03;
  Terrains method = Terrains::kConditional;
  int refinement = 1;           // 0: ground has nodes half a cell apart; 1: finer ones near eye and target
  std::vector<double> heights;  // of targets above ground, metres, besides the observers' own; at most 15
  std::uint64_t seed = 1;
  std::optional<Extent> extent;   // snapped outward to the DEM's grid; empty = the observers' reach
  int threads = 0;                // 0 = all cores
  std::size_t memory_budget = 0;  // bytes; 0 = three quarters of the machine's memory
};

struct ProbableReport {
  std::vector<ObserverReport> observers;  // heights on the DEM; areas of the whole are below
  int realisations = 0;                   // the most that a cell could have
  double largest_standard_error = 0;      // reached, of all cells
  double in_doubt_m2 = 0;                 // not the same in all terrains: what had to be drawn
  std::vector<double> heights;            // as asked for
  double visible_m2 = 0, uncertain_m2 = 0, hidden_m2 = 0;
  double expected_m2 = 0;  // visible area: the sum of all probabilities
  std::string error_model;
  std::vector<std::string> warnings;
};

// All grids in the user's row order, with `geotransform`.
struct ProbableViewshed {
  Grid<float> probability;           // that an observer sees the cell, 0..1; NaN = nodata or not asked
  Grid<float> standard_error;        // of that, from the number of realisations
  Grid<std::uint16_t> realisations;  // that it comes from
  // A claim at the confidence c: visible when the interval of 95 % for the probability (EarlyStop) is
  // (1 + c) / 2 or more, hidden when it is (1 - c) / 2 or less. What is the same in all terrains that could
  // be drawn is claimed whatever their number.
  Grid<std::uint8_t> verdict;
  // For each of the heights: the probability that a target of that height is seen, which is that the lowest
  // visible height is no more than this.
  std::vector<Grid<float>> at_heights;
  Geotransform geotransform;
  std::string crs_wkt;
  ProbableReport report;
};

// Eye and target stand on the ground of each realisation. A cell behind unknown ground (nodata) is seen in
// half of the realisations in which known ground leaves it seen: a hole makes no claim. The same bytes for
// any number of threads and any extent. Throws InvalidInput, IoError, OverBudget, Cancelled.
ProbableViewshed run_probable_viewshed(const DemSource&, const std::vector<Observer>&, const ErrorModel&,
                                       const ProbableOptions&, Progress&);

}  // namespace sightbound
