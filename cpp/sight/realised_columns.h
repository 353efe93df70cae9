// SPDX-License-Identifier: GPL-3.0-or-later
// Terrains that could lie behind a DEM, column by column: each realisation a surface of its own, sixteen side
// by side.
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
};

// Lines of nodes are numbered by half cells: 2 n is at sample n. With `transposed` they are rows.
class RealisedColumns {
 public:
  RealisedColumns(const OpenTerrain&, bool transposed, std::uint32_t first_realisation);

  // Of the line `major`, nodes `from` to `to` (both included); valid until the next call. NaN where terrain
  // is not known.
  const Lanes* nodes(int major, int from, int to);
  // From now on the sixteen realisations from this one.
  void begin(std::uint32_t first_realisation);

  // Of a node that is no sample: the spread about the mean of the two that it lies between, metres.
  double between(int major, int minor) const;

  int majors() const { return 2 * samples_major_ - 1; }
  int minors() const { return 2 * samples_minor_ - 1; }

 private:
  struct Line {
    int major = -1, from = 0, to = -1;
    std::vector<Lanes> heights;
  };
  const Lanes* samples(Line&, int major, int from, int to);

  const OpenTerrain& terrain_;
  const bool transposed_;
  std::uint32_t first_;
  int samples_major_, samples_minor_;
  Line lines_[2];
  std::vector<Lanes> nodes_;
  std::vector<double> growth_;  // of each row: along it, down from it, along the diagonal; empty where it
                                // depends on the amplitude
};

}  // namespace sightbound
