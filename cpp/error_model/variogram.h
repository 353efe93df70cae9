// SPDX-License-Identifier: GPL-3.0-or-later
// How far errors of neighbouring places are alike.
//
//   gamma(h) = half the mean square difference of residuals a distance h apart
//            = nugget + sill (1 - exp(-h / length))                   fitted
//
// The nugget is what places have on their own, the sill what neighbours share. Semivariances are the robust
// ones of Cressie & Hawkins (1980): the fourth power of the mean root of the differences.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "earth/georeference.h"
#include "terrain/grid.h"

namespace sightbound {

struct LagBin {
  double distance = 0;      // mean of its pairs, metres
  double semivariance = 0;  // m^2
  double pairs = 0;
};

struct Variogram {
  std::vector<LagBin> bins;        // by distance
  double nugget = 0, sill = 0;     // m^2
  double length = 0;               // metres; 0 = no correlation to be seen, sill is 0 then
  bool length_is_largest = false;  // errors are alike as far as looked: a trend, or a longer correlation

  double at(double distance) const;
  // The one length whose exp(-d / length) holds as much correlation, summed over the plane, as nugget and
  // sill together: length sqrt(sill / (nugget + sill)). `other` (m^2) is taken off the nugget first: what
  // else is in it.
  double correlation_length(double other = 0) const;
};

// Sums differences of residuals in rasters along rows and columns, at distances growing by the root of 2 up
// to half a side. Pass the parts of a larger raster one after the other.
class GridVariogram {
 public:
  // NaN = none. All parts have one cell size.
  void add(const Grid<float>& errors, const CellSize& cell);
  std::vector<LagBin> bins() const;  // those with pairs enough
  std::size_t places() const { return places_; }

 private:
  struct Sum {
    double distance = 0, roots = 0, pairs = 0;
  };
  std::vector<Sum> along_rows_, along_columns_;  // by the number of the lag
  std::size_t places_ = 0;
};

struct PlacedError {
  double x = 0, y = 0;  // metres in plan
  double error = 0;     // metres
};
// From all pairs of at most kMostPaired places (evenly chosen of more), from `nearest` metres up to half the
// extent.
inline constexpr std::size_t kMostPaired = 3000;
std::vector<LagBin> variogram_of_places(std::span<const PlacedError>, double nearest);

// Weighted least squares (Cressie 1985). `places` = how many residuals the bins come from: they tell whether
// the growth with distance is more than chance, else the errors count as independent.
Variogram fit_variogram(std::vector<LagBin> bins, std::size_t places);

}  // namespace sightbound
