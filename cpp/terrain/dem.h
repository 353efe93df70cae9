// SPDX-License-Identifier: GPL-3.0-or-later
// A DEM as a regular TIN: samples at cell centres, every square of four split along its NW-SE diagonal.
//
// Inside the core heights are metres, NaN is nodata, and rows are ordered so that the NW-SE diagonal runs from
// sample (r, c) to (r + 1, c + 1). Outputs go back to the order of the user's raster at the boundary (`flipped`).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/progress.h"
#include "terrain/geotransform.h"
#include "terrain/grid.h"

namespace sightbound {

// Where heights come from: an array or a file. Everything is in the core's row order.
class DemSource {
 public:
  virtual ~DemSource() = default;

  int rows() const { return rows_; }
  int cols() const { return cols_; }
  Window window() const { return {0, 0, cols_, rows_}; }
  const Geotransform& geotransform() const { return geotransform_; }
  const std::string& crs_wkt() const { return crs_wkt_; }
  // True when the core's rows run against the user's.
  bool flipped() const { return flipped_; }

  // Heights of a window in metres, NaN where there are none. Safe to call from one thread at a time.
  virtual Grid<float> read(const Window&, Progress&) const = 0;

  // What was assumed or converted on the way (vertical unit, missing CRS, suspicious values), for the report. Reading may
  // add to them: ask after it.
  const std::vector<std::string>& notes() const { return notes_; }

 protected:
  // `geotransform` is the user's; rows are flipped here when the diagonal asks for it.
  DemSource(int rows, int cols, const Geotransform& geotransform, std::string crs_wkt);
  mutable std::vector<std::string> notes_;

 private:
  int rows_, cols_;
  bool flipped_;
  Geotransform geotransform_;
  std::string crs_wkt_;
};

// Heights held by somebody else (a numpy array, kept alive by `owner`), in the user's row order.
class ArrayDem final : public DemSource {
 public:
  struct Heights {
    const float* data = nullptr;   // row-major, contiguous
    int rows = 0, cols = 0;
    double nodata;                 // NaN = none but NaN itself
    double metres_per_unit = 1;
    std::shared_ptr<const void> owner;
  };
  // Throws InvalidInput for fewer than 2 x 2 samples.
  ArrayDem(Heights heights, const Geotransform& geotransform, std::string crs_wkt);
  Grid<float> read(const Window&, Progress&) const override;

 private:
  Heights heights_;
};

}  // namespace sightbound
