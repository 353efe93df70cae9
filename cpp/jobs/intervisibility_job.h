// SPDX-License-Identifier: GPL-3.0-or-later
// Who sees whom: lines of sight between many points, all with all.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "jobs/line_of_sight_job.h"

namespace sightbound {

enum class PairStatus : std::uint8_t {
  kJudged,
  kOutside,  // an end lies outside the DEM
  kNodata,   // an end stands where the DEM or the ground has no height
};
std::string name_of(PairStatus);  // "ok", "outside", "nodata"

struct StationOptions {
  double max_distance = kUnlimited;  // metres on the ground; pairs farther apart are left out
};

// `from` and `to` count within their lists, from 0. Of pairs that were not judged the sight is empty.
struct JudgedPair {
  std::size_t from = 0, to = 0;
  PairStatus status = PairStatus::kJudged;
  LineOfSight sight;  // without profile, needed heights and texts
};

struct Intervisibility {
  std::vector<JudgedPair> pairs;           // by `from`, then `to`
  std::size_t points_a = 0, points_b = 0;  // how many; 0 of the second: within one list
  std::size_t too_far = 0;                 // pairs left out
  std::string error_model;
  std::vector<std::string> warnings;
};

struct Station {
  double x = 0, y = 0;  // in the DEM's CRS
  double height = 1.7;  // metres, above ground or absolute
};

// Each of `a` with each of `b`; with an empty `b` each two of `a` once, the earlier first (both ways are the
// same). Two points in one place are no pair. Reads the window around all lines. The same bytes for any
// number of threads. Throws InvalidInput, IoError, OverBudget, Cancelled.
Intervisibility run_intervisibility(const DemSource&, const std::vector<Station>& a,
                                    const std::vector<Station>& b, const ErrorModel&, const ViewshedOptions&,
                                    const LineExtras&, const StationOptions&, Progress&);

}  // namespace sightbound
