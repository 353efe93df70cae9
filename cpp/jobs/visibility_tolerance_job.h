// SPDX-License-Identifier: GPL-3.0-or-later
// How far a simplified terrain may be from a DEM, sample by sample, so that given observers see from it what
// they see from the DEM.
//
// Claims are those of a viewshed with stand = ground: they leave z(c) times the ends' sigma_s to spare at
// least. So every sample keeps to half of z(c) times the least sigma_s of all. Samples that are hidden from
// all observers even when they rise by the whole tolerance, and whose neighbours are, neither are seen nor
// hide anything that something nearer does not hide: they have the whole tolerance. Not proven between
// samples: through a notch in a wall near the eye a place may be seen although the samples around it are not.
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
// count, of the options confidence, refraction, curvature, threads and the budget. Cost: one viewshed for
// each observer; where sigma_s varies the DEM is read once more. Throws as run_viewshed().
VisibilityTolerance run_visibility_tolerance(const DemSource&, const std::vector<Observer>&,
                                             const ErrorModel&, double tolerance_m, const ViewshedOptions&,
                                             Progress&);

}  // namespace sightbound
