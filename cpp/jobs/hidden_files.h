// SPDX-License-Identifier: GPL-3.0-or-later
// A hidden volume as rasters and as a mesh, and the rasters of a single layer.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "jobs/volume_targets_job.h"
#include "volume/hidden_volume.h"

namespace sightbound {

// Paths; empty = not wanted.
struct HiddenFiles {
  std::string lowest_visible_height, thickness, core_thickness;  // GeoTIFF
  std::string top;                                               // mesh: .ply, .nc, .2dm, .obj, .gpkg
  std::string fog;  // its faces as polygons with p and thickness (means of the corners): .gpkg
  std::vector<std::string> creation_options;  // KEY=VALUE, GDAL's for GTiff
};

// Rasters (metadata SIGHTBOUND_...) appear together when all are whole, then the mesh, then the fog. Returns
// warnings: where nothing is hidden there is no top, and neither is written. Throws InvalidInput (no path,
// one path twice, a fog that is no .gpkg), IoError, Cancelled.
std::vector<std::string> write_hidden(const HiddenVolume&, const HiddenFiles&, int threads, Progress&);

// Paths; empty = not wanted.
struct LayerFiles {
  std::string confidence, verdict;            // GeoTIFF
  std::vector<std::string> creation_options;  // KEY=VALUE, GDAL's for GTiff
};
// Both appear when both are whole. Throws InvalidInput (no path, one path twice), IoError, Cancelled.
void write_layer(const LayerResult&, const LayerFiles&, int threads, Progress&);

}  // namespace sightbound
