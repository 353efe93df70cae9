// SPDX-License-Identifier: GPL-3.0-or-later
// How a DEM's residuals grow from one spacing to the next, and what that says of its cells.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "error_model/error_model.h"
#include "terrain/grid.h"

namespace sightbound {

// e_q = z - (z q cells before + z q cells after) / 2 along rows and columns, for spacings 2q of 2, 4, 8 and
// 16 cells, all at the same places.
class ResidualGrowth {
 public:
  static constexpr int kSpacings = 4, kTwists = 2;

  void add(const Grid<float>& block);

  std::size_t places() const { return places_; }
  // Root mean square of e_q, metres.
  double rms(int spacing) const;
  // log2 of rms(octave + 1) / rms(octave), tile by tile, averaged.
  double exponent(int octave) const;
  // H below the spacing that exponent(octave) begins with: exponents of real ground grow towards shorter
  // spacings, and half of the change seen last is taken to go on, 0.2 at most. `exponent`: the terrain's own
  // there, of `content`, whose own change does not count.
  double continued(double exponent, int octave, CellContent content) const;
  // 0: what short spacings show goes on as samples would have it, 1: as means over the cells would, which
  // level out what is short, in a way that follows from H (fractal_surface.h). Two witnesses: how the
  // exponent changes (where H itself changes with the spacing the next octave tells how much of that to leave
  // out), and, with three times the weight, how twists change in units of residuals: a change of H by 0.1
  // looks like half of the means' effect to the first, like a third to the second. Between 0.5 and 0.8 it is
  // not clear.
  double means_score() const;

  // Of the truth above the middle of two samples over what that stands above the middle of the next two, by
  // least squares at spacing 2; within 0 and 0.25.
  double ridge_gain() const;

 private:
  double change_of_twists() const;

  std::size_t places_ = 0;
  std::array<double, kSpacings> squares_{};
  struct Tile {
    std::size_t places;
    std::array<double, kSpacings> squares;
    std::array<double, kTwists> twists;
  };
  void add_tile(const Grid<float>& block, int top, int left, Tile& tile);
  std::vector<Tile> tiles_;
  double guide_squares_ = 0, guide_products_ = 0;
};

}  // namespace sightbound
