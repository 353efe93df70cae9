// SPDX-License-Identifier: GPL-3.0-or-later
// The error model of the user, brought onto a window of a DEM.
#pragma once

#include <string>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "earth/georeference.h"
#include "error_model/error_field.h"
#include "error_model/error_model.h"
#include "terrain/dem.h"

namespace sightbound {

// Everything FromDem filled in from the whole DEM; reads it only if something is. Pass what comes back to resolve_error.
ErrorModel complete_model(const ErrorModel&, const DemSource&, std::vector<std::string>& warnings, Progress&);

// `heights` are those of `window`. Where an error raster or polygon layer has no value although the DEM has a height, the
// ground counts as unknown: the height becomes NaN and a warning states the number of cells.
ErrorField resolve_error(const ErrorModel& completed, const DemSource&, const Georeference&, const Window& window,
                         Grid<float>& heights, std::vector<std::string>& warnings, const Workers&, Progress&);

}  // namespace sightbound
