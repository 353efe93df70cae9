// SPDX-License-Identifier: GPL-3.0-or-later
// Terrains that could lie behind a DEM: what each node of their surfaces is drawn from, and the heights that
// no draw leaves.
//
// Known heights are drawn from what the measurements leave open (posterior.h). Half-way between samples,
// along rows, columns and NW-SE diagonals, terrain rises or falls by the between-sample error of the error
// model: a column line has nodes at every half cell, and so there are twice as many column lines. Between
// nodes terrain is linear.
#pragma once

#include <cstdint>
#include <vector>

#include "error_model/error_field.h"
#include "sight/draws.h"
#include "terrain/grid.h"

namespace sightbound {

// What realisations are drawn from; all on one grid.
struct OpenTerrain {
  const Grid<float>& mean;        // metres, NaN = nodata
  const SampleField& spread;      // of the heights at the samples, metres (standard deviation)
  const ErrorField& error;        // between them
  std::int64_t row = 0, col = 0;  // of the grid's first sample in the whole raster
  std::uint64_t seed = 0;
  float largest_draw = kLargestDraw;  // in standard deviations; a larger one only costs time
};

// Of all realisations, metres; NaN where terrain is not known.
struct HeightRange {
  float low, high;
};

// The height at a sample.
struct SampleDraw {
  DrawKey key;
  float mean, spread;
};

// The height half-way between two samples, given theirs.
struct NodeDraw {
  DrawKey key;
  float spread;
};

// Lines of nodes are numbered by half cells: 2 n is at sample n. With `transposed` they are rows.
class RealisedColumns {
 public:
  RealisedColumns(const OpenTerrain&, bool transposed);

  SampleDraw sample(int major, int minor) const;  // numbered by samples
  NodeDraw node(int major, int minor) const;      // between the samples at halves rounded down and up
  // Of the line `major`, nodes `from` to `to` (both included).
  void ranges(int major, int from, int to, std::vector<HeightRange>&) const;

  int majors() const { return 2 * samples_major_ - 1; }
  int minors() const { return 2 * samples_minor_ - 1; }

 private:
  double between(int major, int minor) const;
  HeightRange range(int major, int minor) const;

  const OpenTerrain& terrain_;
  const bool transposed_;
  int samples_major_, samples_minor_;
  std::vector<double> growth_;  // of each row: along it, down from it, along the diagonal; empty where it
                                // depends on the amplitude
};

SIGHTBOUND_INLINE void draw(const SampleDraw& sample, std::uint32_t first, Lanes& out) {
  if (sample.spread == 0) {
    for (float& height : out.v) height = sample.mean;
    return;
  }
  for (int l = 0; l < kLanes; ++l) {
    const std::uint32_t bits = draw_bits(sample.key, first + static_cast<std::uint32_t>(l));
    out.v[l] = sample.mean + sample.spread * normal_from(bits);
  }
}

SIGHTBOUND_INLINE void draw_between(const NodeDraw& node, std::uint32_t first, const Lanes& a, const Lanes& b,
                                    Lanes& out) {
  if (node.spread == 0) {
    for (int l = 0; l < kLanes; ++l) out.v[l] = 0.5f * (a.v[l] + b.v[l]);
    return;
  }
  for (int l = 0; l < kLanes; ++l) {
    const std::uint32_t bits = draw_bits(node.key, first + static_cast<std::uint32_t>(l));
    out.v[l] = 0.5f * (a.v[l] + b.v[l]) + node.spread * normal_from(bits);
  }
}

}  // namespace sightbound
