// SPDX-License-Identifier: GPL-3.0-or-later
// Terrains that could lie behind a DEM, column by column: each realisation a surface of its own, sixteen side
// by side.
//
// Known heights are drawn from what the measurements leave open (posterior.h). Half-way between samples
// terrain rises or falls by the between-sample error of the error model: a column line has nodes at every
// half cell, and so there are twice as many column lines. Between nodes terrain is linear.
//
// Where that error was learnt from the DEM, terrain is drawn as a self-affine surface (fractal_surface.h):
// first the centres of squares about their four samples, then the middles of cell sides about their two
// samples and with their share of the two centres beside (Fournier, Fussell and Carpenter 1982). Otherwise a
// node departs from the two samples beside it, at centres those of the NW-SE diagonal, by the error that the
// model gives for that distance, each by itself.
#pragma once

#include <cstdint>
#include <vector>

#include "error_model/error_field.h"
#include "error_model/posterior.h"
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
  const MiddleRises* rises = nullptr;  // with error.surface: of that
};

// Lines of nodes are numbered by half cells: 2 n is at sample n. With `transposed` they are rows.
class RealisedColumns {
 public:
  RealisedColumns(const OpenTerrain&, bool transposed, std::uint32_t first_realisation);

  // Of the line `major`, nodes `from` to `to` (both included); valid until the next call. NaN where terrain
  // is not known.
  const Lanes* nodes(int major, int from, int to);

  int majors() const { return 2 * samples_major_ - 1; }
  int minors() const { return 2 * samples_minor_ - 1; }

 private:
  struct Line {
    int major = -1, from = 0, to = -1;
    std::vector<Lanes> values;
    // True if it holds them all; else makes room for them.
    bool holds(int major, int from, int to);
    Lanes* at_zero() { return values.data() - from; }
  };
  // A sample or node: its place on the terrain's grid, in half cells.
  struct Place {
    int row, col;
  };
  Place place(int major, int minor) const { return transposed_ ? Place{major, minor} : Place{minor, major}; }
  DrawKey key(const Place& at) const;

  const Lanes* samples(int major, int from, int to);            // of a line of samples, by samples
  const Lanes* centre_departures(int major, int from, int to);  // of an odd line: at odd nodes
  float spread_of_model(const Place&) const;
  float spread_of_surface(const Place&) const;
  float rise(const Place&) const;

  void nodes_of_model(int major, int from, int to);
  void nodes_between(int major, int from, int to);  // an odd line of a learnt surface
  void nodes_along(int major, int from, int to);    // an even one

  const OpenTerrain& terrain_;
  const bool transposed_;
  const std::uint32_t first_;
  int samples_major_, samples_minor_;
  Line samples_[2], departures_[2], nodes_;
  std::vector<double> growth_;  // of each row: along it, down from it, along the diagonal; empty where it
                                // depends on the amplitude
  double row_edge_ = 0, col_edge_ = 0, centre_ = 0;  // spreads of a learnt surface over amplitude
};

}  // namespace sightbound
