// SPDX-License-Identifier: GPL-3.0-or-later
// How far a simplified terrain may be from a DEM, sample by sample, so that given observers see from it what
// they see from the DEM.
//
// Claims are those of a viewshed with stand = ground: they leave z(c) times the ends' sigma_s to spare at
// least. So every sample keeps to half of z(c) times the least sigma_s of all, but for dead ground: where all
// squares of samples around one are so for all observers, however high it rises within the tolerance, nobody
// sees it and it hides nothing that something nearer does not hide. Such samples have the whole tolerance.
// The proof is in docs/algorithms/simplify.md.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "error_model/error_model.h"
#include "jobs/viewshed_job.h"
#include "terrain/dem.h"

namespace sightbound {

struct VisibilityTolerance {
  Grid<float> tolerance;    // of each sample of the DEM, metres, in the user's row order
  double free_share = 0;    // of the samples: those with the whole tolerance
  std::string error_model;  // JSON of what was used
  std::vector<std::string> warnings;
};

// `tolerance_m` where nothing is at stake. Of the observers places, heights (targets 0 or more) and names
// count, of the options confidence, refraction, curvature, threads and the budget. Cost: a sweep for each
// observer, without settling anything. Throws as run_viewshed(), and InvalidInput for a DEM in degrees, which
// no TIN can be made of.
VisibilityTolerance run_visibility_tolerance(const DemSource&, const std::vector<Observer>&,
                                             const ErrorModel&, double tolerance_m, const ViewshedOptions&,
                                             Progress&);

}  // namespace sightbound
