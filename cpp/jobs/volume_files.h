// SPDX-License-Identifier: GPL-3.0-or-later
// An error volume at a confidence, as rasters.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "volume/error_volume.h"

namespace sightbound {

// Paths; empty = not wanted.
struct VolumeFiles {
  std::string lower, upper, thickness;        // GeoTIFF; volume/cover_rasters.h says what they hold
  std::vector<std::string> creation_options;  // KEY=VALUE, GDAL's for GTiff
};

// Rasters (metadata SIGHTBOUND_...) appear together when all are whole. Throws InvalidInput (no path, one
// path twice, a confidence beyond the band), IoError, Cancelled.
void write_volume(const ErrorVolume&, const VolumeFiles&, double confidence, int threads, Progress&);

}  // namespace sightbound
