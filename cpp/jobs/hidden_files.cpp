// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/hidden_files.h"

#include <charconv>
#include <map>

#include "base/error.h"
#include "base/version.h"
#include "io/raster_writer.h"
#include "io/tin_writer.h"
#include "volume/hidden_places.h"

namespace sightbound {

namespace {

std::string text(double value) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

std::map<std::string, std::string> items_of(const HiddenVolume& hidden) {
  std::string observers;
  for (const std::string& one : hidden.info().observers) observers += (observers.empty() ? "" : "\n") + one;
  return {{"SIGHTBOUND_VERSION", version()},
          {"SIGHTBOUND_CONFIDENCE", text(hidden.info().confidence)},
          {"SIGHTBOUND_ERROR_MODEL", hidden.info().error_model},
          {"SIGHTBOUND_OBSERVERS", observers},
          {"SIGHTBOUND_TARGET_SPACING", text(hidden.lattice().spacing_m)},
          {"SIGHTBOUND_TARGET_HEIGHT_SPACING", text(hidden.lattice().height_spacing_m)},
          {"SIGHTBOUND_TARGET_CEILING", text(hidden.lattice().ceiling_m)}};
}

bool has_hidden(const HiddenVolume& hidden) {
  const VerdictVolumes volumes = hidden.volumes();
  return volumes.hidden_m3 + volumes.uncertain_m3 > 0;
}

}  // namespace

std::vector<std::string> write_hidden(const HiddenVolume& hidden, const HiddenFiles& files, int threads,
                                      Progress& progress) {
  const HiddenRasters rasters = rasters_of(hidden);
  std::vector<RasterOutput> outputs;
  const auto add = [&](const std::string& path, const Grid<float>& grid, const std::string& quantity) {
    if (path.empty()) return;
    RasterMetadata metadata{quantity, "m", items_of(hidden), files.creation_options};
    metadata.items["SIGHTBOUND_QUANTITY"] = quantity;
    outputs.push_back({path, &grid, std::move(metadata)});
  };
  add(files.lowest_visible_height, rasters.lowest_visible_height,
      "lowest height above ground from which on targets are certainly visible");
  add(files.thickness, rasters.thickness, "thickness of the hidden layer (not certainly visible)");
  add(files.core_thickness, rasters.core_thickness, "thickness of the surely hidden core");
  if (outputs.empty() && files.top.empty())
    throw InvalidInput("There is nothing to write: name at least one output file.");
  std::vector<std::string> warnings;
  if (!outputs.empty())
    write_rasters(outputs, geotransform_of(hidden.lattice()), hidden.lattice().frame.crs_wkt, threads,
                  progress);
  if (!files.top.empty() && has_hidden(hidden)) {
    const Tin top = top_of(hidden);
    progress.begin(1, static_cast<double>(top.vertices.size() + top.faces.size()));
    warnings = write_tin(files.top, top, {}, progress);
  } else if (!files.top.empty()) {
    warnings.push_back("Nothing is hidden: the hidden volume has no top, and '" + files.top +
                       "' was not written.");
  }
  progress.finish();
  return warnings;
}

}  // namespace sightbound
