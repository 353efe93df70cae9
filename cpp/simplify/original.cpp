// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/original.h"

namespace sightbound {

namespace {

// Places where lines cross are rounded to some 2^-32 of a cell (columns below 2^20), those of vertices as
// written in a CRS to 2^-28 (coordinates below 2^24 cells from the CRS's origin).
constexpr double kPlaceRounding = 0x1p-26;  // cells
// A height is the sum of a dozen products, each rounded to 2^-53 of it.
constexpr double kHeightRounding = 0x1p-48;

}  // namespace

Original::Original(const Grid<float>& heights, const Grid<float>& tolerance, double constant,
                   const Window& window)
    : heights_(heights), tolerance_(tolerance), constant_(constant), window_(window) {
  double highest = 0, steepest = 0, loosest = constant;
  const auto rise = [&](double z, double beside) {
    if (!std::isnan(beside)) steepest = std::max(steepest, std::abs(z - beside));
  };
  for (int r = 0; r < heights.rows(); ++r) {
    for (int c = 0; c < heights.cols(); ++c) {
      const double z = heights.at(r, c);
      if (std::isnan(z)) continue;
      highest = std::max(highest, std::abs(z));
      if (c > 0) rise(z, heights.at(r, c - 1));
      if (r > 0) rise(z, heights.at(r - 1, c));
      if (!tolerance.empty()) loosest = std::max(loosest, static_cast<double>(tolerance.at(r, c)));
    }
  }
  // Along a diagonal it rises twice as much; the new surface, twice the tolerance more.
  rounding_ = kHeightRounding * (highest + loosest) + kPlaceRounding * 2 * (steepest + loosest);
}

}  // namespace sightbound
