// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a window of a band as metres, on all cores where the format bears it. Internal to cpp/io.
#pragma once

#include <string>

#include "base/progress.h"
#include "io/gdal_support.h"
#include "io/height_decoder.h"
#include "terrain/grid.h"

namespace sightbound {

// A band of an open file and how its values are to be taken.
struct Band {
  std::string path, what;  // `what` begins error messages: "The DEM"
  GDALDataset* dataset = nullptr;
  int number = 1;
  HeightDecoder decoder;
  bool masked = false;      // has a mask band or alpha of its own
  bool by_blocks = false;   // may be read past GDAL's block cache
  bool concurrent = false;  // may be read through several handles at once
};

// Looks at the band: type, nodata, scale, offset, mask, and what the format bears. Throws InvalidInput.
Band inspect_band(GDALDataset&, int number, const std::string& path, const std::string& what);

struct BandValues {
  Grid<float> values;
  DecodingCounts counts;
};
// `window` is in the file's row order, and so is the result unless `flip`. progress.check() at least every
// few milliseconds of decoding; on Cancelled all threads have ended. Throws IoError when the file is damaged.
BandValues read_band(const Band&, const Window&, bool flip, Progress&);

}  // namespace sightbound
