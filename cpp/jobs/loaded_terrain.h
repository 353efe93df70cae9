// SPDX-License-Identifier: GPL-3.0-or-later
// A window of the DEM in memory with its error resolved, ready for sight. What the model says all heights
// share (shared_bias) is taken off them, and off the ground raster, which is taken to share it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "earth/georeference.h"
#include "jobs/ground_raster.h"
#include "jobs/resolve_error.h"
#include "jobs/viewshed_job.h"
#include "sight/scene.h"

namespace sightbound {

class LoadedTerrain {
 public:
  // `model` must be complete. Appends to `warnings`.
  LoadedTerrain(const DemSource&, const Georeference&, const Window&, const ErrorModel& model,
                const ViewshedOptions&, std::vector<std::string>& warnings, const Workers&, Progress&);
  LoadedTerrain(const LoadedTerrain&) = delete;
  LoadedTerrain& operator=(const LoadedTerrain&) = delete;

  const Window& window() const { return window_; }  // in the whole raster
  const Scene& scene() const { return *scene_; }
  // Heights that heights above ground refer to: those of the ground raster, or the DEM's own.
  const Grid<float>& ground() const { return ground_.empty() ? heights_ : ground_; }
  const std::vector<double>& cell_areas() const { return cell_areas_; }  // square metres, one per row

  // Bytes at its largest while loading such a window, and afterwards.
  static ResolveMemory memory(const Window&, const ErrorModel&, const ViewshedOptions&);

 private:
  Window window_;
  Grid<float> heights_, ground_;
  ErrorField error_;
  std::unique_ptr<Scene> scene_;
  std::vector<double> cell_areas_;
};

// Area of a cell in each row, square metres.
std::vector<double> cell_areas(const std::vector<CellSize>&, const Geotransform&);

}  // namespace sightbound
