// SPDX-License-Identifier: GPL-3.0-or-later
// The rasters of a result as GeoTIFFs that say how they were made.
//
// All files of one call appear together once every one is whole; a failure or cancellation leaves none of
// them, and keeps what stood under their names before.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/progress.h"
#include "jobs/error_surfaces_job.h"
#include "jobs/probable_viewshed_job.h"
#include "jobs/viewshed_job.h"

namespace sightbound {

// Paths; empty = not wanted.
struct ViewshedFiles {
  std::string confidence, verdict, count, lowest_visible_height, likely_visible_height;
  std::vector<std::string> creation_options;  // KEY=VALUE, GDAL's for GTiff; empty = tiled and compressed
};
struct ProbableFiles {
  std::string probability, standard_error, verdict;
  std::string at_heights;  // a band for each of the heights
  std::vector<std::string> creation_options;
};
struct ErrorSurfaceFiles {
  std::string sigma, lower, upper;
  std::vector<std::string> creation_options;
};

// `observers` and `options` are those the result was made with: they go into the metadata (SIGHTBOUND_...).
// Throws InvalidInput (no path, one path twice, heights that were not computed), IoError, Cancelled.
void write_viewshed(const ViewshedResult&, const std::vector<Observer>&, const ViewshedOptions&,
                    const ViewshedFiles&, Progress&);
void write_probable(const ProbableViewshed&, const std::vector<Observer>&, const ProbableOptions&,
                    const ProbableFiles&, Progress&);
void write_error_surfaces(const ErrorSurfaces&, const ErrorSurfacesOptions&, const ErrorSurfaceFiles&,
                          Progress&);

// The count raster of a single observer: 1 where visible, 0 elsewhere, kNoCount where nothing was asked.
Grid<std::uint32_t> count_of(const Grid<std::uint8_t>& verdict);

}  // namespace sightbound
