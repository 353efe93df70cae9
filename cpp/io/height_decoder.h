// SPDX-License-Identifier: GPL-3.0-or-later
// Stored values of a band -> metres, with every kind of hole made NaN. Internal to cpp/io.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <gdal.h>

namespace sightbound {

// Heights further than this from zero are no measurement of a planet's surface: the widest range known in the
// solar system is some 22 km (Olympus Mons on Mars; the Earth: -11 to 9 km). What lies beyond is an
// undeclared or second nodata value (-32768, -99999, 1e9) or a spike.
inline constexpr double kLargestHeight = 30000;
// Marks of nodata as large as this (+-3.4e38, the ends of the float range) are no spikes worth a note.
inline constexpr double kCertainlyMark = 1e30;
// What many programs write for "nothing" without declaring it.
inline constexpr double kUsualMark = -9999;

// What was met while decoding.
struct DecodingCounts {
  std::size_t spikes = 0;       // finite values beyond kLargestHeight, taken as holes
  std::size_t usual_marks = 0;  // values of exactly -9999 where no nodata is declared, kept as heights
  DecodingCounts& operator+=(const DecodingCounts& more) {
    spikes += more.spikes;
    usual_marks += more.usual_marks;
    return *this;
  }
};

// metres = (stored scale + offset) metres_per_unit.
struct HeightDecoder {
  GDALDataType type = GDT_Float32;
  std::optional<double> nodata;  // as stored
  double scale = 1, offset = 0;
  double metres_per_unit = 1;

  // Decodes n consecutive stored values; `scratch` is kept between calls. `mask`, if given, is 0 at holes.
  DecodingCounts decode(const void* stored, const std::uint8_t* mask, std::size_t n, float* metres,
                        std::vector<double>& scratch) const;
};

}  // namespace sightbound
