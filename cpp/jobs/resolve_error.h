// SPDX-License-Identifier: GPL-3.0-or-later
// The error model of the user, brought onto a window of a DEM.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "earth/georeference.h"
#include "error_model/error_field.h"
#include "error_model/error_model.h"
#include "terrain/dem.h"

namespace sightbound {

// Everything FromDem filled in from the whole DEM; reads it only if something is. Pass what comes back to
// resolve_error. Validates the model. Appends what the estimate has to say to `warnings`.
ErrorModel complete_model(const ErrorModel&, const DemSource&, std::vector<std::string>& warnings, Progress&);

// sigma_s and amplitude at each sample of `window`, whose heights are `heights` (as the source gives them).
// What depends on neighbours reads the two rows and columns around the window, so that windows of one DEM
// agree to the last bit. Where an error raster or array has no value although the DEM has a height, the
// ground counts as unknown: the height becomes NaN and a warning states the number of cells. Outside all
// terrain types geologic_variation holds. `georeference` is the whole DEM's. Throws InvalidInput for an
// incomplete model, IoError. Only checks `progress`.
ErrorField resolve_error(const ErrorModel& completed, const DemSource&, const Georeference& georeference,
                         const Window& window, Grid<float>& heights, std::vector<std::string>& warnings,
                         const Workers&, Progress&);

// What all samples share, taken off: the heights become those of the ground itself. For sight and for
// surfaces in absolute heights; what simplifies keeps the DEM's own.
void take_bias_off(const ErrorModel&, Grid<float>& heights, const Workers&);

// Memory that resolve_error takes beyond `heights`: while at work, and by its result.
struct ResolveMemory {
  std::size_t peak = 0, kept = 0;  // bytes
};
ResolveMemory resolve_error_memory(const ErrorModel&, const Window&);

}  // namespace sightbound
