// SPDX-License-Identifier: GPL-3.0-or-later
// A terrain of the user, DEM or TIN, with its error, ready for an error volume.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "error_model/error_model.h"
#include "jobs/windows.h"
#include "terrain/dem.h"
#include "terrain/tin.h"
#include "volume/error_volume.h"

namespace sightbound {

struct VolumeTerrain {
  std::shared_ptr<const Surface> surface;
  std::string error_model;  // JSON of what was used
  Tails tails = Tails::kNormal;
  std::vector<std::string> warnings;
};

struct VolumeTerrainOptions {
  std::optional<Extent> extent;   // of a DEM, snapped outward to its grid; empty = the whole DEM
  int threads = 0;                // 0 = all cores
  std::size_t memory_budget = 0;  // bytes; 0 = three quarters of the machine's memory
};

// The model's shared_bias is taken off the heights.
//
// The error is measured vertically. Throws InvalidInput (degrees: reproject), IoError, OverBudget, Cancelled.
VolumeTerrain volume_terrain(const DemSource&, const ErrorModel&, const VolumeTerrainOptions&, Progress&);
// Vertically for height fields, else along the normal. Nothing can be learnt from a TIN: vertical_rmse
// (unless the TIN has its own) and geologic_variation must be numbers. Copies the Tin. Throws InvalidInput.
VolumeTerrain volume_terrain(const Tin&, const ErrorModel&);

// Need of the volume beside the terrain's own bytes; ErrorVolume::build() with the same terrain. `options` as
// there.
VolumeNeed need_of(const VolumeTerrain&, VolumeOptions);
ErrorVolume build_volume(const VolumeTerrain&, VolumeOptions, Progress&);

}  // namespace sightbound
