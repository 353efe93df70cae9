// SPDX-License-Identifier: GPL-3.0-or-later
// One observer, one target: is the line clear, with what confidence, and where is it decided?
#pragma once

#include <string>
#include <vector>

#include "jobs/viewshed_job.h"

namespace sightbound {

struct LineOfSightTarget {
  double x = 0, y = 0;  // in the DEM's CRS
};

// Places in order of distance; all arrays of one length.
struct SightProfile {
  std::vector<double> distance;  // metres on the ground from the observer
  std::vector<double> x, y;      // in the DEM's CRS
  std::vector<double> ground;    // height of the terrain, metres; NaN = unknown
  std::vector<double> sigma;     // metres; what the place was judged with
  std::vector<double>
      line;  // height of the line of sight above the datum, the Earth's curve and refraction included
  std::vector<double> clearance;  // (line - ground) / sigma
};

struct LineOfSight {
  double p = 0, k = 0;
  std::uint8_t verdict = kNoVerdict;
  double distance = 0, azimuth = 0;  // metres; degrees from true north at the observer
  double critical_x = 0, critical_y = 0, critical_distance = 0;  // NaN when nothing is judged (too near)
  double observer_ground = 0, eye_height = 0, target_ground = 0, target_top = 0;  // metres, absolute
  double required_height = 0, likely_height = 0;  // lowest visible height above ground: certain, likely
  SightProfile profile;
  std::string error_model;
  std::vector<std::string> warnings;
};

// Of `observer` only position, height and target_height count. Reads only the window around the line.
LineOfSight run_line_of_sight(const DemSource&, const Observer&, const LineOfSightTarget&, const ErrorModel&,
                              const ViewshedOptions&, Progress&);

// Many lines with one completed model; the same answers as one by one.
std::vector<LineOfSight> run_lines_of_sight(const DemSource&, const std::vector<Observer>&,
                                            const std::vector<LineOfSightTarget>&, const ErrorModel&,
                                            const ViewshedOptions&, Progress&);

}  // namespace sightbound
