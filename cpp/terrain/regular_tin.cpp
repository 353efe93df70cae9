// SPDX-License-Identifier: GPL-3.0-or-later
#include "terrain/regular_tin.h"

#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"

namespace sightbound {

namespace {

constexpr std::size_t kBytesPerSample = 72;  // vertex 24, two faces 24, height 4, number 4, and growth
constexpr std::int32_t kUnused = -1;

// Squares of which a triangle is whole, and the samples these use.
struct Corners {
  bool nw, ne, sw, se;
  bool lower() const { return nw && sw && se; }  // NW, SW, SE
  bool upper() const { return nw && se && ne; }
};

Corners corners_at(const Grid<float>& z, int r, int c) {
  const auto there = [&](int row, int col) { return !std::isnan(z.at(row, col)); };
  return {there(r, c), there(r, c + 1), there(r + 1, c), there(r + 1, c + 1)};
}

}  // namespace

RegularTin regular_tin(const DemSource& dem, double metres_per_unit, const MemoryBudget& budget,
                       Progress& progress) {
  const std::size_t samples = dem.window().cells();
  if (samples >= static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()) / 2) {
    throw InvalidInput("The DEM has " + std::to_string(samples) +
                       " samples, too many for one TIN (2^30); give a part of it, or a coarser one.");
  }
  budget.require(samples * kBytesPerSample, "The TIN of the DEM", "Give a part of it, or a coarser one.");
  const Grid<float> z = dem.read(dem.window(), progress);
  const int rows = dem.rows(), cols = dem.cols();
  const auto at = [&](int r, int c) {
    return static_cast<std::size_t>(r) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(c);
  };

  std::vector<std::int32_t> number(samples, kUnused);
  std::size_t faces = 0;
  for (int r = 0; r + 1 < rows; ++r) {
    for (int c = 0; c + 1 < cols; ++c) {
      const Corners square = corners_at(z, r, c);
      const bool lower = square.lower(), upper = square.upper();
      faces += static_cast<std::size_t>(lower) + static_cast<std::size_t>(upper);
      if (lower || upper) number[at(r, c)] = number[at(r + 1, c + 1)] = 0;
      if (lower) number[at(r + 1, c)] = 0;
      if (upper) number[at(r, c + 1)] = 0;
    }
  }
  if (faces == 0)
    throw InvalidInput("The DEM has no three samples side by side that are not nodata: it makes no surface.");

  RegularTin made;
  Tin& tin = made.tin;
  tin.crs_wkt = dem.crs_wkt();
  tin.metres_per_unit = metres_per_unit;
  const Xyz middle = [&] {
    const Xy p = dem.geotransform().of_sample(cols / 2.0, rows / 2.0);
    return Xyz{std::round(p.x), std::round(p.y), 0};
  }();
  tin.origin = middle;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) {
      std::int32_t& n = number[at(r, c)];
      if (n == kUnused) continue;
      n = static_cast<std::int32_t>(tin.vertices.size());
      const Xy p = dem.geotransform().of_sample(c, r);
      tin.vertices.push_back(tin.from_crs({p.x, p.y, z.at(r, c)}));
      made.samples.push_back(static_cast<std::int32_t>(at(r, c)));
    }
  }
  if (tin.vertices.size() == samples) made.samples = {};

  // Corners go counterclockwise where columns run east and rows south; the other way round in a mirrored
  // raster.
  const auto& g = dem.geotransform().coefficients();
  const bool mirrored = g[1] * g[5] - g[2] * g[4] > 0;
  const auto add = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
    tin.faces.push_back(mirrored ? Face{a, c, b} : Face{a, b, c});
  };
  tin.faces.reserve(faces);
  for (int r = 0; r + 1 < rows; ++r) {
    for (int c = 0; c + 1 < cols; ++c) {
      const Corners square = corners_at(z, r, c);
      const std::int32_t nw = number[at(r, c)], ne = number[at(r, c + 1)];
      const std::int32_t sw = number[at(r + 1, c)], se = number[at(r + 1, c + 1)];
      if (square.lower()) add(nw, sw, se);
      if (square.upper()) add(nw, se, ne);
    }
    progress.advance(1);
  }
  tin.notes = dem.notes();
  return made;
}

}  // namespace sightbound
