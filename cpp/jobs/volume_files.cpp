// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/volume_files.h"

#include <utility>

#include "base/error.h"
#include "base/number_text.h"
#include "base/version.h"
#include "io/raster_writer.h"
#include "volume/cover_rasters.h"

namespace sightbound {

void write_volume(const ErrorVolume& volume, const VolumeFiles& files, double confidence, int threads,
                  Progress& progress) {
  if (files.lower.empty() && files.upper.empty() && files.thickness.empty())
    throw InvalidInput("There is nothing to write: name at least one output file.");
  const CoverRasters rasters = rasters_of(volume, confidence);
  std::vector<RasterOutput> outputs;
  const auto add = [&](const std::string& path, const Grid<float>& grid, const std::string& quantity) {
    if (path.empty()) return;
    RasterMetadata metadata{quantity,
                            "m",
                            {{"SIGHTBOUND_VERSION", version()},
                             {"SIGHTBOUND_QUANTITY", quantity},
                             {"SIGHTBOUND_CONFIDENCE", number_text(confidence)},
                             {"SIGHTBOUND_ERROR_MODEL", volume.error_model()},
                             {"SIGHTBOUND_VOXEL", number_text(volume.voxel_m())},
                             {"SIGHTBOUND_VOXEL_HEIGHT", number_text(volume.voxel_height_m())}},
                            files.creation_options};
    outputs.push_back({path, &grid, std::move(metadata)});
  };
  add(files.lower, rasters.lower, "lowest place of the error volume");
  add(files.upper, rasters.upper, "highest place of the error volume");
  add(files.thickness, rasters.thickness, "thickness of the error volume");
  write_rasters(outputs, rasters.geotransform, volume.surface().frame().crs_wkt, threads, progress);
  progress.finish();
}

}  // namespace sightbound
