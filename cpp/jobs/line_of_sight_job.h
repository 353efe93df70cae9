// SPDX-License-Identifier: GPL-3.0-or-later
// One observer, one target: is the line clear, with what confidence, and where is it decided?
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "jobs/early_stop.h"
#include "jobs/viewshed_job.h"

namespace sightbound {

struct LineOfSightTarget {
  double x = 0, y = 0;  // in the DEM's CRS
};

// What may be asked of a line beside p.
struct WholeLineOptions {
  int realisations = 1000;
  std::uint64_t seed = 1;
  Stand stand = Stand::kGround;  // absolute heights never move
};
struct RadioOptions {
  double frequency_mhz = 0;
  double zone_share = 0.6;  // of the first Fresnel zone's radius, to be kept clear
};
struct LineExtras {
  std::optional<WholeLineOptions> whole_line;
  std::optional<RadioOptions> radio;
};
void validate(const LineExtras&);  // throws InvalidInput

// Places in order of distance; all arrays of one length.
struct SightProfile {
  std::vector<double> distance;  // metres on the ground from the observer
  std::vector<double> x, y;      // in the DEM's CRS
  std::vector<double> ground;    // height of the terrain, metres; NaN = unknown
  std::vector<double> sigma;     // metres; what the place was judged with
  std::vector<double>
      line;  // height of the line of sight above the datum, the Earth's curve and refraction included
  std::vector<double> clearance;  // (line - ground) / sigma
  std::vector<double> zone;       // radius of the first Fresnel zone, metres; empty without a frequency
};

// Over terrains that could lie behind the DEM (sight/probable_line.h). NaN: no such place.
struct WholeLine {
  int realisations = 0;
  std::uint64_t seed = 0;
  double probability = 0, standard_error = 0;  // that the line is clear
  ShareInterval interval{0, 1};                // Wilson's, 95 %
  std::uint8_t verdict = kNoVerdict;           // needs the nearer end of the interval to hold
  double blocked_bound = 1;  // the probability of being blocked is no larger (sight/line_bound.h)
  double blocked_x = 0, blocked_y = 0, blocked_distance = 0, blocked_share = 0;  // where most are blocked
  double zone_probability = 0;  // that the share of the Fresnel zone is clear too; NaN without a frequency
  std::vector<double> distance, x, y, blocked;  // shares of the realisations, at all places compared
};

// The first Fresnel zone along the line.
struct FresnelClearance {
  double middle_radius = 0;           // metres, half-way
  double clear = 0;                   // least clearance of the DEM, in radii there
  double x = 0, y = 0, distance = 0;  // where, and metres from the observer
  double radius = 0;                  // metres, there
  double k = 0, p = 0;                // as of LineOfSight, for the share of the zone asked for
  std::uint8_t verdict = kNoVerdict;
};

struct LineOfSight {
  double p = 0, k = 0;
  std::uint8_t verdict = kNoVerdict;
  double distance = 0, azimuth = 0;  // metres; degrees from true north at the observer
  double critical_x = 0, critical_y = 0, critical_distance = 0;  // NaN when nothing is judged (too near)
  double critical_clearance = 0;                                 // metres, of the line above the ground there
  double observer_ground = 0, eye_height = 0, target_ground = 0, target_top = 0;  // metres, absolute
  double required_height = 0, likely_height = 0;  // lowest visible height above ground: certain, likely
  std::optional<WholeLine> whole_line;
  std::optional<FresnelClearance> fresnel;
  SightProfile profile;
  std::string error_model;
  std::vector<std::string> warnings;
};

// Of `observer` only position, height and target_height count. Reads only the window around the line.
LineOfSight run_line_of_sight(const DemSource&, const Observer&, const LineOfSightTarget&, const ErrorModel&,
                              const ViewshedOptions&, const LineExtras&, Progress&);

// Many lines with one completed model; the same answers as one by one.
std::vector<LineOfSight> run_lines_of_sight(const DemSource&, const std::vector<Observer>&,
                                            const std::vector<LineOfSightTarget>&, const ErrorModel&,
                                            const ViewshedOptions&, const LineExtras&, Progress&);

}  // namespace sightbound
