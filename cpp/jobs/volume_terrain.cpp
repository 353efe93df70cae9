// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/volume_terrain.h"

#include <utility>

#include "base/memory_budget.h"
#include "base/parallel.h"
#include "io/crs.h"
#include "io/tin_crs.h"
#include "jobs/resolve_error.h"
#include "volume/dem_surface.h"
#include "volume/tin_surface.h"

namespace sightbound {

VolumeTerrain volume_terrain(const DemSource& source, const ErrorModel& model,
                             const VolumeTerrainOptions& options, Progress& progress) {
  model.validate();
  const double metres_per_unit = metres_per_plan_unit(source.crs_wkt());
  const Window window = window_of(options.extent, source);
  const Georeference georeference = georeference_of(source);
  const Workers workers(options.threads);
  const ResolveMemory error = resolve_error_memory(model, window);
  MemoryBudget(options.memory_budget)
      .require(
          window.cells() * sizeof(float) + error.peak,
          "A terrain of " + std::to_string(window.cols) + " x " + std::to_string(window.rows) + " samples",
          "Give a smaller extent, or a larger memory budget.");

  VolumeTerrain terrain;
  progress.begin(0.1, 1);
  const ErrorModel completed = complete_model(model, source, terrain.warnings, progress);
  progress.begin(0.1, static_cast<double>(window.cells()));
  DemInput input;
  input.heights = source.read(window, progress);
  progress.begin(0.1, 1);
  input.error = resolve_error(completed, source, georeference, window, input.heights, terrain.warnings,
                              workers, progress);
  take_bias_off(completed, input.heights, workers);
  input.geotransform = source.geotransform().of_window(window);
  input.metres_per_unit = metres_per_unit;
  input.crs_wkt = horizontal_crs(source.crs_wkt());
  terrain.surface = std::make_shared<DemSurface>(std::move(input));
  terrain.error_model = completed.describe();
  terrain.tails = completed.tails_used();
  const std::vector<std::string> notes = source.notes();  // reading adds to them
  terrain.warnings.insert(terrain.warnings.begin(), notes.begin(), notes.end());
  return terrain;
}

VolumeTerrain volume_terrain(const Tin& tin, const ErrorModel& model) {
  const Metric metric = TinSurface::metric_of(tin);
  Tin truth = tin;
  for (Xyz& vertex : truth.vertices) vertex.z -= model.shared_bias;
  VolumeTerrain terrain;
  terrain.surface =
      std::make_shared<TinSurface>(std::move(truth), resolve_tin_error(tin, model, metric), metric);
  terrain.error_model = model.describe();
  terrain.tails = model.tails_used();
  terrain.warnings = tin.notes;
  return terrain;
}

VolumeNeed need_of(const VolumeTerrain& terrain, VolumeOptions options) {
  options.tails = terrain.tails;
  return estimate_need(*terrain.surface, options);
}

ErrorVolume build_volume(const VolumeTerrain& terrain, VolumeOptions options, Progress& progress) {
  options.tails = terrain.tails;
  options.error_model = terrain.error_model;
  return ErrorVolume::build(terrain.surface, options, progress);
}

}  // namespace sightbound
