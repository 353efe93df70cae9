// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/realised_columns.h"

#include <algorithm>
#include <cmath>

namespace sightbound {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// Half of the way from a sample to its neighbour along the row, the column, the diagonal; metres.
enum Way { kAlongRow, kAlongColumn, kAlongDiagonal };
double half_way(const CellSize& cell, Way way) {
  if (way == kAlongRow) return cell.col_m / 2;
  return way == kAlongColumn ? cell.row_m / 2 : std::hypot(cell.col_m, cell.row_m) / 2;
}

}  // namespace

RealisedColumns::RealisedColumns(const OpenTerrain& terrain, bool transposed)
    : terrain_(terrain),
      transposed_(transposed),
      samples_major_(transposed ? terrain.mean.rows() : terrain.mean.cols()),
      samples_minor_(transposed ? terrain.mean.cols() : terrain.mean.rows()) {
  const GrowthProfile& profile = terrain.error.profile;
  const bool by_amplitude = profile.shape == GeologicShape::kGaussian && profile.range_m == 0;
  if (by_amplitude) return;
  for (const CellSize& cell : terrain.error.cell_sizes) {
    for (const Way way : {kAlongRow, kAlongColumn, kAlongDiagonal})
      growth_.push_back(profile(half_way(cell, way), 0));
  }
}

// The spread at a node that is no sample: of the error between the two that it lies between.
double RealisedColumns::between(int major, int minor) const {
  const int row = transposed_ ? major : minor, col = transposed_ ? minor : major;
  const int r = row / 2, c = col / 2, r1 = (row + 1) / 2, c1 = (col + 1) / 2;
  const Way way = row % 2 == 0 ? kAlongRow : (col % 2 == 0 ? kAlongColumn : kAlongDiagonal);
  const double amplitude =
      0.5 * (static_cast<double>(terrain_.error.amplitude.at(r, c)) + terrain_.error.amplitude.at(r1, c1));
  if (amplitude == 0) return 0;
  if (!growth_.empty()) return amplitude * growth_[3 * at(r) + at(way)];
  return amplitude * terrain_.error.profile(half_way(terrain_.error.cell_sizes[at(r)], way), amplitude);
}

SampleDraw RealisedColumns::sample(int major, int minor) const {
  const int row = transposed_ ? major : minor, col = transposed_ ? minor : major;
  return {draw_key(terrain_.seed, 2 * (terrain_.row + row), 2 * (terrain_.col + col)),
          terrain_.mean.at(row, col), terrain_.spread.at(row, col)};
}

NodeDraw RealisedColumns::node(int major, int minor) const {
  const int row = transposed_ ? major : minor, col = transposed_ ? minor : major;
  return {draw_key(terrain_.seed, 2 * terrain_.row + row, 2 * terrain_.col + col),
          static_cast<float>(between(major, minor))};
}

// At a sample.
HeightRange RealisedColumns::range(int major, int minor) const {
  const int row = transposed_ ? major : minor, col = transposed_ ? minor : major;
  const float mean = terrain_.mean.at(row, col), most = terrain_.largest_draw * terrain_.spread.at(row, col);
  return {mean - most, mean + most};
}

void RealisedColumns::ranges(int major, int from, int to, std::vector<HeightRange>& out) const {
  out.resize(at(to - from + 1));
  const int m = major / 2, next = (major + 1) / 2;
  HeightRange a = range(m, from / 2), b = a;
  for (int n = from; n <= to; ++n) {
    const bool is_sample = n % 2 == 0 && m == next;
    if (n % 2 == 0) {
      a = m == next && n > from ? b : range(m, n / 2);
      b = m == next ? a : range(next, n / 2);
    } else {
      b = range(next, (n + 1) / 2);
    }
    const float most = is_sample ? 0 : terrain_.largest_draw * static_cast<float>(between(major, n));
    out[at(n - from)] = {0.5f * (a.low + b.low) - most, 0.5f * (a.high + b.high) + most};
  }
}

}  // namespace sightbound
