// SPDX-License-Identifier: GPL-3.0-or-later
//   u    2^-53, a rounding
//   A    largest of the terms of a coordinate, in units of the CRS
// A coordinate g0 + c g1 + r g2 takes four roundings (of A each, at most), windows and flipped rows six
// before that; it loses two on the way to the TIN's own origin, and two on the way back.
#include "simplify/place_rounding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/error.h"
#include "base/number_text.h"
#include "simplify/plan_mesh.h"
#include "terrain/tin_cleaning.h"

namespace sightbound {

namespace {

constexpr double kRoundings = 0x1p-49;  // 16 u, more than 14
// A face is 1/64 cell high in plan (placement.h): two of its corners may come towards each other by an eighth
// of that.
constexpr double kMostShift = 0x1p-9;  // cells

// The largest power of two that a number is a multiple of; infinite for 0.
double unit_of(double value) {
  if (value == 0) return std::numeric_limits<double>::infinity();
  int exponent = 0;
  const auto digits = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), 53));
  return std::ldexp(static_cast<double>(digits & -digits), exponent - 53);
}

// One of a place's two coordinates: corner + column * of_col + row * of_row.
struct Coordinate {
  double corner, of_col, of_row, lost;

  double largest(int rows, int cols) const {
    return std::abs(corner) + cols * std::abs(of_col) + rows * std::abs(of_row);
  }
  // Is no place on the lattice rounded?
  bool exact(int rows, int cols) const {
    const double step = std::min(unit_of(of_col), unit_of(of_row)) / kStepsPerCell;
    return lost == 0 && largest(rows, cols) < 0x1p51 * std::min({unit_of(corner), step, 1.0});
  }
};

}  // namespace

double place_rounding(const DemPlace& place, int rows, int cols) {
  const auto& g = place.geotransform.coefficients();
  const Xy& lost = place.geotransform.lost();
  const Coordinate x{g[0], g[1], g[2], lost.x}, y{g[3], g[4], g[5], lost.y};
  const double far = std::max(x.largest(rows, cols), y.largest(rows, cols));
  if (far > kLargestCoordinate) {
    throw InvalidInput("The DEM reaches to coordinates of " + number_text(far) +
                       "; they must be within 1e9. Check its geotransform.");
  }
  if (place.metres_per_unit == 1 && x.exact(rows, cols) && y.exact(rows, cols)) return 0;
  const double dx = kRoundings * x.largest(rows, cols), dy = kRoundings * y.largest(rows, cols);
  const double cell = std::abs(g[1] * g[5] - g[2] * g[4]);  // its area
  const double shift =
      (dx * (std::abs(g[5]) + std::abs(g[4])) + dy * (std::abs(g[1]) + std::abs(g[2]))) / cell;
  if (shift > kMostShift) {
    throw InvalidInput("The DEM's cells are too small for coordinates of " + number_text(far) +
                       ": numbers of that size tell places apart by " + number_text(shift) +
                       " of a cell only. Take off an offset.");
  }
  return shift;
}

}  // namespace sightbound
