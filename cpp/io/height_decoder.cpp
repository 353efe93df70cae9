// SPDX-License-Identifier: GPL-3.0-or-later
// One pass without branches over each row. Float32 goes straight through; everything else by way of double,
// which holds all integer types exactly as far as heights go.
#include "io/height_decoder.h"

#include <cmath>
#include <limits>

namespace sightbound {

namespace {

template <class Stored, bool kMasked>
DecodingCounts decode_row(const HeightDecoder& decoder, const Stored* stored, const std::uint8_t* mask,
                          std::size_t n, float* metres) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  // A value declared in double for a Float32 band is stored rounded: compare as stored. Larger ones are holes
  // anyway.
  const bool comparable = decoder.nodata && std::abs(*decoder.nodata) < kCertainlyMark;
  const Stored nodata =
      comparable ? static_cast<Stored>(*decoder.nodata) : std::numeric_limits<Stored>::quiet_NaN();
  const auto a = static_cast<Stored>(decoder.scale * decoder.metres_per_unit);
  const auto b = static_cast<Stored>(decoder.offset * decoder.metres_per_unit);
  std::size_t spikes = 0, usual_marks = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Stored value = stored[i];
    const Stored z = value * a + b;
    bool hole = value == nodata;
    if constexpr (kMasked) hole |= mask[i] == 0;
    const bool measurable = std::abs(z) <= static_cast<Stored>(kLargestHeight);  // false for NaN
    spikes += !hole & !measurable & (std::abs(value) < static_cast<Stored>(kCertainlyMark));
    usual_marks += !hole & (value == static_cast<Stored>(kUsualMark));
    metres[i] = hole | !measurable ? kNan : static_cast<float>(z);
  }
  return {spikes, decoder.nodata ? 0 : usual_marks};
}

template <class Stored>
DecodingCounts decode_row(const HeightDecoder& decoder, const Stored* stored, const std::uint8_t* mask,
                          std::size_t n, float* metres) {
  return mask != nullptr ? decode_row<Stored, true>(decoder, stored, mask, n, metres)
                         : decode_row<Stored, false>(decoder, stored, mask, n, metres);
}

}  // namespace

DecodingCounts HeightDecoder::decode(const void* stored, const std::uint8_t* mask, std::size_t n,
                                     float* metres, std::vector<double>& scratch) const {
  if (type == GDT_Float32) return decode_row(*this, static_cast<const float*>(stored), mask, n, metres);
  scratch.resize(n);
  GDALCopyWords64(stored, type, GDALGetDataTypeSizeBytes(type), scratch.data(), GDT_Float64, sizeof(double),
                  static_cast<GPtrDiff_t>(n));
  return decode_row(*this, scratch.data(), mask, n, metres);
}

}  // namespace sightbound
