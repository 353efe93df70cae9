// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/realised_columns.h"

#include <algorithm>
#include <cmath>

namespace sightbound {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

SIGHTBOUND_VECTOR
void draw(const DrawKey& key, std::uint32_t first, float mean, float spread, Lanes& out) {
  for (int l = 0; l < kLanes; ++l)
    out.v[l] = mean + spread * normal_from(draw_bits(key, first + static_cast<std::uint32_t>(l)));
}

SIGHTBOUND_VECTOR
void draw_between(const DrawKey& key, std::uint32_t first, const Lanes& a, const Lanes& b, float spread,
                  Lanes& out) {
  for (int l = 0; l < kLanes; ++l) {
    const float middle = 0.5f * (a.v[l] + b.v[l]);
    out.v[l] = middle + spread * normal_from(draw_bits(key, first + static_cast<std::uint32_t>(l)));
  }
}

// Half of the way from a sample to its neighbour along the row, the column, the diagonal; metres.
enum Way { kAlongRow, kAlongColumn, kAlongDiagonal };
double half_way(const CellSize& cell, Way way) {
  if (way == kAlongRow) return cell.col_m / 2;
  return way == kAlongColumn ? cell.row_m / 2 : std::hypot(cell.col_m, cell.row_m) / 2;
}

}  // namespace

RealisedColumns::RealisedColumns(const OpenTerrain& terrain, bool transposed, std::uint32_t first_realisation)
    : terrain_(terrain),
      transposed_(transposed),
      first_(first_realisation),
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

void RealisedColumns::begin(std::uint32_t first_realisation) {
  first_ = first_realisation;
  for (Line& line : lines_) line.major = -1;
}

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

const Lanes* RealisedColumns::samples(Line& line, int major, int from, int to) {
  if (line.major == major && line.from <= from && to <= line.to) return line.heights.data() - line.from;
  line.major = major;
  line.from = from;
  line.to = to;
  line.heights.resize(std::max(line.heights.size(), at(to - from + 1)));
  for (int n = from; n <= to; ++n) {
    const int row = transposed_ ? major : n, col = transposed_ ? n : major;
    const float spread = terrain_.spread.at(row, col), mean = terrain_.mean.at(row, col);
    Lanes& out = line.heights[at(n - from)];
    if (spread == 0) {
      std::fill_n(out.v, kLanes, mean);
    } else {
      draw(draw_key(terrain_.seed, 2 * (terrain_.row + row), 2 * (terrain_.col + col)), first_, mean, spread,
           out);
    }
  }
  return line.heights.data() - line.from;
}

const Lanes* RealisedColumns::nodes(int major, int from, int to) {
  nodes_.resize(std::max(nodes_.size(), at(to - from + 1)));
  const int low = from / 2, high = (to + 1) / 2;
  const int m = major / 2, next = (major + 1) / 2;
  // The line of the lower number is kept in its own place, so that neighbouring majors find it again.
  const Lanes* here = samples(lines_[m % 2], m, low, high);
  const Lanes* there = next == m ? here : samples(lines_[next % 2], next, low, high);
  for (int n = from; n <= to; ++n) {
    const int k = n / 2, k1 = (n + 1) / 2;
    Lanes& out = nodes_[at(n - from)];
    if (k == k1 && m == next) {
      out = here[k];
      continue;
    }
    const int row = transposed_ ? major : n, col = transposed_ ? n : major;
    draw_between(draw_key(terrain_.seed, 2 * terrain_.row + row, 2 * terrain_.col + col), first_, here[k],
                 there[k1], static_cast<float>(between(major, n)), out);
  }
  return nodes_.data() - from;
}

}  // namespace sightbound
