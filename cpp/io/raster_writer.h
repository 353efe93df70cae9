// SPDX-License-Identifier: GPL-3.0-or-later
// Result rasters, written beside the target and renamed when whole.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "base/progress.h"
#include "terrain/geotransform.h"
#include "terrain/grid.h"

namespace sightbound {

struct RasterMetadata {
  std::string description;                    // of the band
  std::string unit;                           // of the band, e.g. "m"
  std::map<std::string, std::string> items;   // dataset metadata, keys SIGHTBOUND_...
  std::vector<std::string> creation_options;  // KEY=VALUE of the GTiff driver; they win over ours (tiled,
                                              // compressed, BigTIFF when needed)
  std::vector<std::string> band_descriptions = {};  // where there are several
};

// GeoTIFF (.tif or .tiff, or no extension); nodata NaN / 255 / 4294967295. The file appears under its name
// only when whole; a failure (no space, no folder, cancelled) leaves nothing and keeps what stood there
// before. Only the horizontal part of the CRS is written: the values are no heights of its vertical datum.
// `threads` compress (0 = all cores). `progress` is advanced by 1 per cell. Grids are in the order of
// `geotransform`. Throws IoError, InvalidInput (extension, creation options), Cancelled.
void write_raster(const std::string& path, const Grid<float>&, const Geotransform&,
                  const std::string& crs_wkt, const RasterMetadata&, int threads, Progress&);
void write_raster(const std::string& path, const Grid<std::uint8_t>&, const Geotransform&,
                  const std::string& crs_wkt, const RasterMetadata&, int threads, Progress&);
void write_raster(const std::string& path, const Grid<std::uint32_t>&, const Geotransform&,
                  const std::string& crs_wkt, const RasterMetadata&, int threads, Progress&);

struct RasterOutput {
  std::string path;
  std::variant<const Grid<float>*, const Grid<std::uint8_t>*, const Grid<std::uint32_t>*,
               const std::vector<Grid<float>>*>  // a band each, of one size
      grid;
  RasterMetadata metadata;
};
// All files appear together once the last is whole; a failure leaves none of them. Begins `progress` for the
// whole. Throws as write_raster does, and InvalidInput for two outputs of one path.
void write_rasters(const std::vector<RasterOutput>&, const Geotransform&, const std::string& crs_wkt,
                   int threads, Progress&);

}  // namespace sightbound
