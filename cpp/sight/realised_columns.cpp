// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/realised_columns.h"

#include <algorithm>
#include <array>
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

float mean_amplitude(const OpenTerrain& terrain, int r, int c, int r1, int c1) {
  const SampleField& amplitude = terrain.error.amplitude;
  return 0.25f * ((amplitude.at(r, c) + amplitude.at(r1, c1)) + (amplitude.at(r, c1) + amplitude.at(r1, c)));
}

// Half the range of the samples around (NaN: not all are known), and the sd of what lies between them,
// metres.
struct Around {
  double half_range, sigma;
};
Around around(const OpenTerrain& terrain, int r, int c, int r1, int c1) {
  const Grid<float>& z = terrain.mean;
  const std::array corners{z.at(r, c), z.at(r, c1), z.at(r1, c), z.at(r1, c1)};
  const bool known = std::ranges::none_of(corners, [](float height) { return std::isnan(height); });
  const auto [low, high] = std::ranges::minmax_element(corners);
  return {known ? 0.5 * (*high - *low) : NAN,
          mean_amplitude(terrain, r, c, r1, c1) * terrain.error.plain_per_amplitude()};
}

}  // namespace

bool is_normal(const ErrorField& error) {
  return error.tails == Tails::kNormal && (!error.steps.has_tails || error.steps.is_normal());
}

double factor_between(const OpenTerrain& terrain, int r, int c, int r1, int c1) {
  if (terrain.error.steps.has_one_variance()) return 1;
  const Around at = around(terrain, r, c, r1, c1);
  return terrain.error.steps.factor(at.half_range, at.sigma);
}

DrawnTails tails_between(const OpenTerrain& terrain, int r, int c, int r1, int c1) {
  const StepLaw& steps = terrain.error.steps;
  if (!is_learnt(terrain) || !steps.has_tails) return drawn_tails(terrain.error.tails);
  if (steps.has_one_tail()) return {static_cast<float>(steps.level.tail)};
  const Around at = around(terrain, r, c, r1, c1);
  return {static_cast<float>(steps.tail(at.half_range, at.sigma))};
}

float amplitude_between(const OpenTerrain& terrain, int r, int c, int r1, int c1) {
  return mean_amplitude(terrain, r, c, r1, c1) * static_cast<float>(factor_between(terrain, r, c, r1, c1));
}

SIGHTBOUND_VECTOR
void add_shared(const SharedDraw& draw, std::uint32_t first, Lanes& out) {
  constexpr std::uint64_t kSharedDraws = 0x73686172;
  const OpenTerrain& terrain = *draw.terrain;
  const CorrelatedNoise& noise = terrain.error.noise;
  const std::int64_t row = terrain.row + draw.row, col = terrain.col + draw.col;
  Lanes sum{};
  const auto add = [&](const DrawKey& key, double weight) {
    const auto w = static_cast<float>(weight);
    for (int l = 0; l < kLanes; ++l)
      sum.v[l] += w * normal_from(draw_bits(key, first + static_cast<std::uint32_t>(l)));
  };
  std::uint64_t seed = terrain.seed ^ kSharedDraws;
  add(draw_key(seed, row, col), noise.own);
  for (const CorrelatedNoise::Lattice& lattice : noise.lattices) {
    seed = mixed(seed);
    const double v = static_cast<double>(row) / lattice.rows, u = static_cast<double>(col) / lattice.cols;
    const double v0 = std::floor(v), u0 = std::floor(u), v1 = v - v0, u1 = u - u0;
    const double size = std::hypot(v1, 1 - v1) * std::hypot(u1, 1 - u1);
    for (const int i : {0, 1}) {
      for (const int j : {0, 1}) {
        const double part = (i ? v1 : 1 - v1) * (j ? u1 : 1 - u1);
        if (part != 0)
          add(draw_key(seed, static_cast<std::int64_t>(v0) + i, static_cast<std::int64_t>(u0) + j),
              lattice.weight * part / size);
      }
    }
  }
  for (int l = 0; l < kLanes; ++l) {
    const float least = sum.v[l] > -kLargestDraw ? sum.v[l] : -kLargestDraw;
    out.v[l] += draw.spread * (least < kLargestDraw ? least : kLargestDraw);
  }
}

RealisedColumns::RealisedColumns(const OpenTerrain& terrain, bool transposed)
    : terrain_(terrain),
      transposed_(transposed),
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

DrawKey RealisedColumns::key(const Place& at) const {
  return draw_key(terrain_.seed, 2 * terrain_.row + at.row, 2 * terrain_.col + at.col);
}

DrawKey RealisedColumns::scale(const Place& at) const {
  return tile_key(terrain_.seed, 2 * terrain_.row + at.row, 2 * terrain_.col + at.col);
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
  const int rows = terrain_.mean.rows(), cols = terrain_.mean.cols();
  const int r = std::max(node.row, 0) / 2, c = std::max(node.col, 0) / 2;
  const int r1 = std::min((node.row + 1) / 2, rows - 1), c1 = std::min((node.col + 1) / 2, cols - 1);
  const double spread = node.row % 2 == 0 ? row_edge_ : (node.col % 2 == 0 ? col_edge_ : centre_);
  return static_cast<float>(spread) * amplitude_between(terrain_, r, c, r1, c1);
}

DrawnTails RealisedColumns::tails(const Place& node) const {
  const int rows = terrain_.mean.rows(), cols = terrain_.mean.cols();
  return tails_between(terrain_, std::max(node.row, 0) / 2, std::max(node.col, 0) / 2,
                       std::min((node.row + 1) / 2, rows - 1), std::min((node.col + 1) / 2, cols - 1));
}

float RealisedColumns::rise(const Place& node) const {
  const MiddleRises& rises = *terrain_.rises;
  const int r = node.row / 2, c = node.col / 2;
  if (node.row % 2 == 0) return rises.row_edge.at(r, c);
  return node.col % 2 == 0 ? rises.col_edge.at(r, c) : rises.centre.at(r, c);
}

SampleDraw RealisedColumns::sample(int major, int minor) const {
  const Place at = place(2 * major, 2 * minor);
  const int row = at.row / 2, col = at.col / 2;
  SampleDraw draw{{key(at), scale(at), terrain_.spread.at(row, col), drawn_tails(terrain_.error.tails)},
                  terrain_.mean.at(row, col)};
  if (terrain_.shared) draw.shared = {&terrain_, row, col, terrain_.shared->at(row, col)};
  return draw;
}

SampleDraw RealisedColumns::centre(int major, int minor) const {
  const Place at = place(major, minor);
  return {{key(at), scale(at), spread_of_surface(at), tails(at)}, 0};
}

NodeDraw RealisedColumns::node(int major, int minor) const {
  const Place at = place(major, minor);
  if (!is_learnt(terrain_))
    return {NodeDraw::Kind::kBetween, {key(at), scale(at), spread_of_model(at), tails(at)}, 0, 0};
  if (major % 2 != 0 && minor % 2 != 0) {
    // Beside a hole the triangle that is known goes as far as the diagonal.
    if (!is_whole(major / 2, minor / 2))
      return {NodeDraw::Kind::kBetween, {key(at), scale(at), spread_of_surface(at), tails(at)}, 0, 0};
    return {NodeDraw::Kind::kCentre, {key(at), scale(at), 0, tails(at)}, rise(at), 0};
  }
  const auto share = static_cast<float>(terrain_.error.surface->from_centres / 2);
  return {NodeDraw::Kind::kSide, {key(at), scale(at), spread_of_surface(at), tails(at)}, rise(at), share};
}

bool RealisedColumns::is_whole(int major, int minor) const {
  const Place c = place(major, minor + 1), d = place(major + 1, minor);
  return !std::isnan(terrain_.mean.at(c.row, c.col)) && !std::isnan(terrain_.mean.at(d.row, d.col));
}

Lanes RealisedColumns::heights(int major, int minor, std::uint32_t first) const {
  const auto drawn = [&](const SampleDraw& sample) {
    Lanes lanes;
    draw(sample, first, lanes);
    return lanes;
  };
  const auto of = node_of(
      major, minor, [&](int m, int n) { return drawn(sample(m, n)); },
      [&](int m, int n) { return drawn(centre(m, n)); });
  if (of.is_sample) return of.a;
  Lanes out;
  draw(of.draw, first, {of.a, of.b, of.c, of.d, of.e, of.f}, out);
  return out;
}

// At a sample.
HeightRange RealisedColumns::range(int major, int minor) const {
  const Place at = place(major, minor);
  const float mean = terrain_.mean.at(at.row, at.col),
              shared = terrain_.shared ? terrain_.shared->at(at.row, at.col) : 0,
              most = terrain_.largest_draw * terrain_.spread.at(at.row, at.col) + kLargestDraw * shared;
  return {mean - most, mean + most};
}

// What all draws of a node that is no sample come to at most, in standard deviations' sizes.
float RealisedColumns::most(int major, int minor) const {
  const Place at = place(major, minor);
  if (!is_learnt(terrain_)) return spread_of_model(at);
  if (major % 2 != 0 && minor % 2 != 0) return spread_of_surface(at);
  const int i = major % 2 == 0 ? 1 : 0, j = 1 - i;  // to the centres on either side
  const auto share = static_cast<float>(std::abs(terrain_.error.surface->from_centres) / 2);
  return spread_of_surface(at) + share * (spread_of_surface(place(major - i, minor - j)) +
                                          spread_of_surface(place(major + i, minor + j)));
}

void RealisedColumns::ranges(int major, int from, int to, std::vector<HeightRange>& out) const {
  out.resize(at(to - from + 1));
  const int m = major / 2, next = (major + 1) / 2;
  for (int n = from; n <= to; ++n) {
    const int k = n / 2, k1 = (n + 1) / 2;
    const HeightRange a = range(m, k);
    HeightRange& here = out[at(n - from)];
    if (m == next && k == k1) {
      here = a;
      continue;
    }
    const HeightRange b = range(next, k1);
    const float room = terrain_.largest_draw * most(major, n);
    here = {0.5f * (a.low + b.low), 0.5f * (a.high + b.high)};
    if (is_learnt(terrain_)) {
      if (m != next && k != k1 && is_whole(m, k)) {
        const HeightRange c = range(m, k1), d = range(next, k);
        here = {0.5f * here.low + 0.25f * (c.low + d.low), 0.5f * here.high + 0.25f * (c.high + d.high)};
      }
      const float up = rise(place(major, n));
      here = {here.low + up, here.high + up};
    }
    here = {here.low - room, here.high + room};
  }
}

}  // namespace sightbound
