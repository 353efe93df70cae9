// SPDX-License-Identifier: GPL-3.0-or-later
// A DEM as a regular TIN: samples at cell centres, every square of four split along its NW-SE diagonal.
//
// Inside the core heights are metres, NaN is nodata, and rows are ordered so that the NW-SE diagonal runs from
// sample (r, c) to (r + 1, c + 1). Outputs go back to the order of the user's raster at the boundary (`flipped`).
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
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

  // Heights of a window in metres, NaN where there are none. Several jobs may read one DEM at the same time.
  virtual Grid<float> read(const Window&, Progress&) const = 0;

  // What was assumed or converted on the way (vertical unit, missing CRS, suspicious values), for the report. Reading may
  // add to them: ask after it.
  std::vector<std::string> notes() const;

 protected:
  // `geotransform` is the user's; rows are flipped here when the diagonal asks for it.
  DemSource(int rows, int cols, const Geotransform& geotransform, std::string crs_wkt);
  // Returns the place of the note, for change_note().
  std::size_t add_note(std::string text) const;
  void change_note(std::size_t place, std::string text) const;

 private:
  int rows_, cols_;
  bool flipped_;
  Geotransform geotransform_;
  std::string crs_wkt_;
  mutable std::mutex notes_mutex_;
  mutable std::vector<std::string> notes_;
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
