// SPDX-License-Identifier: GPL-3.0-or-later
// Blocks of a GeoTIFF of Float32 heights packed with COMPRESS=DEFLATE, PREDICTOR=3 (TIFF Technical Note 3),
// as DEMs often are. libtiff takes the predictor back byte by byte through memory, which costs twice the time
// of the decompression; here both cost less than the decompression alone there (measured: 1.9 times as many
// blocks a second in all). Whatever is stored otherwise is GDAL's. Internal to cpp/io.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "io/gdal_support.h"

namespace sightbound {

class FloatTiles {
 public:
  // Null when the band is stored otherwise. Keeps a pointer to the band; for one thread.
  static std::unique_ptr<FloatTiles> of(GDALRasterBand* band, const std::string& path);

  // The whole block, row by row; or nothing: when it is absent or the last strip is cut short, GDAL can tell
  // what it holds. GDAL does not tell of every damage.
  enum class Found { kValues, kAskGdal, kDamage };
  Found read(int block_col, int block_row, float* values);

 private:
  struct CloseFile {
    void operator()(VSILFILE* file) const { VSIFCloseL(file); }
  };
  using File = std::unique_ptr<VSILFILE, CloseFile>;

  FloatTiles(GDALRasterBand* band, File file);
  std::int64_t number(const std::string& key) const;  // of the block; -1 where there is none

  GDALRasterBand* band_;
  File file_;
  int cols_ = 0, rows_ = 0;
  std::vector<std::uint8_t> packed_, bytes_;
};

// One row of n floats whose bytes are stored as differences, all first bytes before all second ones and so
// on, most significant first. `bytes` (4 n) is overwritten.
void undo_float_predictor(std::uint8_t* bytes, std::size_t n, float* values);

}  // namespace sightbound
