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

// The middle of a side from a to b, with the departures c and d of the centres beside.
struct Side {
  float rise, share, spread;
};
SIGHTBOUND_VECTOR
void draw_side(const DrawKey& key, std::uint32_t first, const Lanes& a, const Lanes& b, const Lanes& c,
               const Lanes& d, const Side& side, Lanes& out) {
  for (int l = 0; l < kLanes; ++l) {
    const float middle = 0.5f * (a.v[l] + b.v[l]) + side.rise + side.share * (c.v[l] + d.v[l]);
    out.v[l] = middle + side.spread * normal_from(draw_bits(key, first + static_cast<std::uint32_t>(l)));
  }
}

SIGHTBOUND_VECTOR
void add_centre(const Lanes& a, const Lanes& b, const Lanes& c, const Lanes& d, float rise,
                const Lanes& departure, Lanes& out) {
  for (int l = 0; l < kLanes; ++l)
    out.v[l] = 0.25f * ((a.v[l] + b.v[l]) + (c.v[l] + d.v[l])) + rise + departure.v[l];
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
  if (const auto& surface = terrain.error.surface; surface && terrain.rises) {
    const double unit = terrain.error.plain_per_amplitude() * surface->points;
    row_edge_ = unit * surface->row_edge.spread;
    col_edge_ = unit * surface->col_edge.spread;
    centre_ = unit * surface->centre.spread;
    return;
  }
  const GrowthProfile& profile = terrain.error.profile;
  const bool by_amplitude = profile.shape == GeologicShape::kGaussian && profile.range_m == 0;
  if (by_amplitude) return;
  for (const CellSize& cell : terrain.error.cell_sizes) {
    for (const Way way : {kAlongRow, kAlongColumn, kAlongDiagonal})
      growth_.push_back(profile(half_way(cell, way), 0));
  }
}

bool RealisedColumns::Line::holds(int of_major, int first, int last) {
  if (major == of_major && from <= first && last <= to) return true;
  major = of_major;
  from = first;
  to = last;
  values.resize(std::max(values.size(), at(last - first + 1)));
  return false;
}

DrawKey RealisedColumns::key(const Place& at) const {
  return draw_key(terrain_.seed, 2 * terrain_.row + at.row, 2 * terrain_.col + at.col);
}

const Lanes* RealisedColumns::samples(int major, int from, int to) {
  // The line of the lower number is kept in its own place, so that neighbouring majors find it again.
  Line& line = samples_[major % 2];
  if (line.holds(major, from, to)) return line.at_zero();
  for (int n = from; n <= to; ++n) {
    const Place node = place(2 * major, 2 * n);
    const float spread = terrain_.spread.at(node.row / 2, node.col / 2),
                mean = terrain_.mean.at(node.row / 2, node.col / 2);
    Lanes& out = line.at_zero()[n];
    if (spread == 0) {
      std::fill_n(out.v, kLanes, mean);
    } else {
      draw(key(node), first_, mean, spread, out);
    }
  }
  return line.at_zero();
}

// What is drawn of the centres of squares; beyond the rim too, so that sides there have two beside them.
const Lanes* RealisedColumns::centre_departures(int major, int from, int to) {
  Line& line = departures_[at((major + 1) / 2 % 2)];
  if (line.holds(major, from, to)) return line.at_zero();
  for (int n = from; n <= to; ++n) {
    if (n % 2 == 0) continue;
    const Place node = place(major, n);
    draw(key(node), first_, 0, spread_of_surface(node), line.at_zero()[n]);
  }
  return line.at_zero();
}

// The spread at a node that is no sample: of the error between the two that it lies between.
float RealisedColumns::spread_of_model(const Place& node) const {
  const int r = node.row / 2, c = node.col / 2, r1 = (node.row + 1) / 2, c1 = (node.col + 1) / 2;
  const Way way = node.row % 2 == 0 ? kAlongRow : (node.col % 2 == 0 ? kAlongColumn : kAlongDiagonal);
  const double amplitude =
      0.5 * (static_cast<double>(terrain_.error.amplitude.at(r, c)) + terrain_.error.amplitude.at(r1, c1));
  if (amplitude == 0) return 0;
  const double growth =
      growth_.empty() ? terrain_.error.profile(half_way(terrain_.error.cell_sizes[at(r)], way), amplitude)
                      : growth_[3 * at(r) + at(way)];
  return static_cast<float>(amplitude * growth);
}

float RealisedColumns::spread_of_surface(const Place& node) const {
  const SampleField& amplitude = terrain_.error.amplitude;
  const int rows = terrain_.mean.rows(), cols = terrain_.mean.cols();
  const int r = std::max(node.row, 0) / 2, c = std::max(node.col, 0) / 2;
  const int r1 = std::min((node.row + 1) / 2, rows - 1), c1 = std::min((node.col + 1) / 2, cols - 1);
  if (node.row % 2 == 0)
    return static_cast<float>(row_edge_ * 0.5) * (amplitude.at(r, c) + amplitude.at(r, c1));
  if (node.col % 2 == 0)
    return static_cast<float>(col_edge_ * 0.5) * (amplitude.at(r, c) + amplitude.at(r1, c));
  return static_cast<float>(centre_ * 0.25) *
         ((amplitude.at(r, c) + amplitude.at(r, c1)) + (amplitude.at(r1, c) + amplitude.at(r1, c1)));
}

float RealisedColumns::rise(const Place& node) const {
  const MiddleRises& rises = *terrain_.rises;
  const int r = node.row / 2, c = node.col / 2;
  if (node.row % 2 == 0) return rises.row_edge.at(r, c);
  return node.col % 2 == 0 ? rises.col_edge.at(r, c) : rises.centre.at(r, c);
}

const Lanes* RealisedColumns::nodes(int major, int from, int to) {
  nodes_.major = -1;
  nodes_.holds(major, from, to);
  if (centre_ == 0) {
    nodes_of_model(major, from, to);
  } else if (major % 2 != 0) {
    nodes_between(major, from, to);
  } else {
    nodes_along(major, from, to);
  }
  return nodes_.at_zero();
}

void RealisedColumns::nodes_of_model(int major, int from, int to) {
  const int low = from / 2, high = (to + 1) / 2, m = major / 2, next = (major + 1) / 2;
  const Lanes* here = samples(m, low, high);
  const Lanes* there = next == m ? here : samples(next, low, high);
  for (int n = from; n <= to; ++n) {
    const int k = n / 2, k1 = (n + 1) / 2;
    Lanes& out = nodes_.at_zero()[n];
    if (k == k1 && m == next) {
      out = here[k];
    } else {
      const Place node = place(major, n);
      draw_between(key(node), first_, here[k], there[k1], spread_of_model(node), out);
    }
  }
}

void RealisedColumns::nodes_between(int major, int from, int to) {
  const int low = from / 2, high = (to + 1) / 2;
  const Lanes *here = samples(major / 2, low, high), *there = samples(major / 2 + 1, low, high);
  const Lanes* departures = centre_departures(major, from - 1, to + 1);
  const auto share = static_cast<float>(terrain_.error.surface->from_centres / 2);
  for (int n = from; n <= to; ++n) {
    const int k = n / 2;
    const Place node = place(major, n);
    Lanes& out = nodes_.at_zero()[n];
    if (n % 2 != 0) {
      add_centre(here[k], here[k + 1], there[k], there[k + 1], rise(node), departures[n], out);
    } else {
      draw_side(key(node), first_, here[k], there[k], departures[n - 1], departures[n + 1],
                {rise(node), share, spread_of_surface(node)}, out);
    }
  }
}

void RealisedColumns::nodes_along(int major, int from, int to) {
  const Lanes* here = samples(major / 2, from / 2, (to + 1) / 2);
  const Lanes* before = centre_departures(major - 1, from - 1, to + 1);
  const Lanes* behind = centre_departures(major + 1, from - 1, to + 1);
  const auto share = static_cast<float>(terrain_.error.surface->from_centres / 2);
  for (int n = from; n <= to; ++n) {
    Lanes& out = nodes_.at_zero()[n];
    if (n % 2 == 0) {
      out = here[n / 2];
    } else {
      const Place node = place(major, n);
      draw_side(key(node), first_, here[n / 2], here[n / 2 + 1], before[n], behind[n],
                {rise(node), share, spread_of_surface(node)}, out);
    }
  }
}

}  // namespace sightbound
