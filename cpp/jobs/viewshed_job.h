// SPDX-License-Identifier: GPL-3.0-or-later
// A whole viewshed: which windows to read, the error field, one sweep per observer, the results put together.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "error_model/error_model.h"
#include "jobs/windows.h"
#include "sight/confidence.h"
#include "terrain/dem.h"

namespace sightbound {

inline constexpr double kUnlimited = std::numeric_limits<double>::infinity();

enum class Stand {
  kModel,
  kGround
};  // are eye and target exact positions, or do they move with the unknown ground
enum class HeightReference { kGround, kAbsolute };
enum class Combine { kBest, kWorst };

struct Observer {
  double x = 0, y = 0;       // in the DEM's CRS
  double height = 1.7;       // metres, above ground or absolute
  double target_height = 0;  // metres, above ground or absolute
  double min_distance = 0;   // metres on the ground
  double max_distance = kUnlimited;
  double azimuth_from = 0, azimuth_to = 360;  // degrees clockwise from true north
  double angle_from = -90, angle_to = 90;     // degrees above the observer's horizontal
  std::string name;                           // for messages; empty = its number
  std::size_t number = 0;                     // counted from 1; 0 = its place in the list
};

struct ViewshedOptions {
  double confidence = 0.95;
  double refraction = 0.13;
  bool curvature = true;
  Stand stand = Stand::kModel;
  Combine combine = Combine::kBest;
  HeightReference height_reference = HeightReference::kGround;
  std::shared_ptr<const DemSource> ground;  // places heights above ground; empty = the DEM itself
  bool see_across_nodata = false;
  std::optional<Extent> extent;   // snapped outward to the DEM's grid; empty = the observers' reach
  bool heights = false;           // lowest visible heights too
  int threads = 0;                // 0 = all cores
  std::size_t memory_budget = 0;  // bytes; 0 = three quarters of the machine's memory
};

struct ObserverReport {
  double x = 0, y = 0;
  double ground_height = 0, eye_height = 0;  // metres, absolute
  double visible_m2 = 0, uncertain_m2 = 0, hidden_m2 = 0;
  std::string name, status;  // "ok", or why nothing is seen
};

struct ViewshedReport {
  std::vector<ObserverReport> observers;
  double visible_m2 = 0, uncertain_m2 = 0, hidden_m2 = 0;  // of the combined verdict
  double hole_doubt_m2 = 0;      // in doubt only because sight would cross a hole, summed over the observers
  std::size_t memory_bytes = 0;  // planned peak
  std::uint64_t cells_settled = 0;  // cells that needed an exact line, over all observers
  std::string error_model;          // JSON of what was used
  std::vector<std::string> warnings;
};

// All grids in the user's row order, with `geotransform`.
struct ViewshedResult {
  Grid<float> confidence;  // p in 0..1, NaN = nodata or not asked
  Grid<std::uint8_t> verdict;
  Grid<std::uint32_t>
      count;  // observers that claim visible; empty for a single observer (derive: verdict == 2)
  Grid<float> lowest_visible_height, likely_visible_height;  // metres above ground; empty unless asked
  Geotransform geotransform;
  std::string crs_wkt;
  ViewshedReport report;
};

// Throws InvalidInput, IoError, OverBudget, Cancelled.
ViewshedResult run_viewshed(const DemSource&, const std::vector<Observer>&, const ErrorModel&,
                            const ViewshedOptions&, Progress&);

}  // namespace sightbound
