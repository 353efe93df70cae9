// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/hidden_files.h"

#include <charconv>
#include <map>
#include <utility>

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

using Items = std::map<std::string, std::string>;

Items items_of(const HiddenVolumeInfo& info) {
  std::string observers;
  for (const std::string& one : info.observers) observers += (observers.empty() ? "" : "\n") + one;
  return {{"SIGHTBOUND_VERSION", version()},
          {"SIGHTBOUND_CONFIDENCE", text(info.confidence)},
          {"SIGHTBOUND_ERROR_MODEL", info.error_model},
          {"SIGHTBOUND_OBSERVERS", observers}};
}

Items items_of(const HiddenVolume& hidden) {
  Items items = items_of(hidden.info());
  items["SIGHTBOUND_TARGET_SPACING"] = text(hidden.lattice().spacing_m);
  items["SIGHTBOUND_TARGET_HEIGHT_SPACING"] = text(hidden.lattice().height_spacing_m);
  items["SIGHTBOUND_TARGET_CEILING"] = text(hidden.lattice().ceiling_m);
  return items;
}

RasterMetadata band_of(const std::string& quantity, const std::string& unit, Items items,
                       const std::vector<std::string>& creation_options) {
  items["SIGHTBOUND_QUANTITY"] = quantity;
  return {quantity, unit, std::move(items), creation_options};
}

bool has_hidden(const HiddenVolume& hidden) {
  const VerdictVolumes volumes = hidden.volumes();
  return volumes.hidden_m3 + volumes.uncertain_m3 > 0;
}

// What the corners hold, as means on the faces: all that polygons can hold.
Tin with_values_on_faces(Tin tin) {
  for (const TinAttribute& of_corners : tin.vertex_attributes) {
    TinAttribute of_faces{of_corners.name, {}};
    of_faces.values.reserve(tin.faces.size());
    for (const Face& face : tin.faces) {
      float sum = 0;
      for (const std::int32_t corner : face) sum += of_corners.values[static_cast<std::size_t>(corner)];
      of_faces.values.push_back(sum / 3);
    }
    tin.face_attributes.push_back(std::move(of_faces));
  }
  tin.vertex_attributes.clear();
  return tin;
}

std::vector<std::string> write_meshes(const HiddenVolume& hidden, const HiddenFiles& files,
                                      Progress& progress) {
  std::vector<std::string> warnings;
  if (!has_hidden(hidden)) {
    for (const std::string& path : {files.top, files.fog}) {
      if (path.empty()) continue;
      warnings.push_back("Nothing is hidden: the hidden volume has no top, and '" + path +
                         "' was not written.");
    }
    return warnings;
  }
  Tin top = top_of(hidden);
  const int meshes = !files.top.empty() + !files.fog.empty();
  progress.begin(1,
                 static_cast<double>(meshes) * static_cast<double>(top.vertices.size() + top.faces.size()));
  if (!files.top.empty()) warnings = write_tin(files.top, top, {}, progress);
  if (!files.fog.empty()) write_tin(files.fog, with_values_on_faces(std::move(top)), {}, progress);
  return warnings;
}

}  // namespace

std::vector<std::string> write_hidden(const HiddenVolume& hidden, const HiddenFiles& files, int threads,
                                      Progress& progress) {
  const HiddenRasters rasters = rasters_of(hidden);
  std::vector<RasterOutput> outputs;
  const auto add = [&](const std::string& path, const Grid<float>& grid, const std::string& quantity) {
    if (path.empty()) return;
    outputs.push_back({path, &grid, band_of(quantity, "m", items_of(hidden), files.creation_options)});
  };
  add(files.lowest_visible_height, rasters.lowest_visible_height,
      "lowest height above ground from which on targets are certainly visible");
  add(files.thickness, rasters.thickness, "thickness of the hidden layer (not certainly visible)");
  add(files.core_thickness, rasters.core_thickness, "thickness of the surely hidden core");
  const bool meshes = !files.top.empty() || !files.fog.empty();
  if (outputs.empty() && !meshes)
    throw InvalidInput("There is nothing to write: name at least one output file.");
  if (!files.fog.empty() && !files.fog.ends_with(".gpkg"))
    throw InvalidInput("fog is '" + files.fog + "'; its polygons go into a GeoPackage, .gpkg.");
  if (meshes && files.top == files.fog)
    throw InvalidInput("top and fog are both '" + files.top + "'; give each a file of its own.");
  std::vector<std::string> warnings;
  if (!outputs.empty())
    write_rasters(outputs, geotransform_of(hidden.lattice()), hidden.lattice().frame.crs_wkt, threads,
                  progress);
  if (meshes) warnings = write_meshes(hidden, files, progress);
  progress.finish();
  return warnings;
}

void write_layer(const LayerResult& layer, const LayerFiles& files, int threads, Progress& progress) {
  Items items = items_of(layer.info);
  items["SIGHTBOUND_TARGET_HEIGHT"] = text(layer.height_m);
  items["SIGHTBOUND_TARGET_SPACING"] = text(layer.spacing_m);
  std::vector<RasterOutput> outputs;
  const auto add = [&](const std::string& path, auto* grid, const std::string& quantity) {
    if (!path.empty()) outputs.push_back({path, grid, band_of(quantity, "", items, files.creation_options)});
  };
  add(files.confidence, &layer.confidence, "proven pointwise confidence of visibility");
  add(files.verdict, &layer.verdict, "verdict: 0 hidden, 1 uncertain, 2 visible");
  if (outputs.empty()) throw InvalidInput("There is nothing to write: name at least one output file.");
  write_rasters(outputs, layer.geotransform, layer.crs_wkt, threads, progress);
  progress.finish();
}

}  // namespace sightbound
