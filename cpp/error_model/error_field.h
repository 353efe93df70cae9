// SPDX-License-Identifier: GPL-3.0-or-later
// The error model resolved on one window of a DEM: what sight and the error surfaces compute with.
//
// Both parts of sigma are linear on each triangle between the values at the samples; the geologic part is
// scaled by a function of the distance to the nearest sample. Values are finite and >= 0 everywhere, nodata
// samples included.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "earth/georeference.h"
#include "error_model/correlated_noise.h"
#include "error_model/error_model.h"
#include "error_model/fractal_surface.h"
#include "error_model/step_law.h"
#include "terrain/grid.h"

namespace sightbound {

// How the between-sample error grows with the distance d (metres) to the nearest sample: 0 at a sample.
struct GrowthProfile {
  GeologicShape shape = GeologicShape::kGaussian;
  double range_m = 0;         // 0 = the paper's f(Delta) = Delta^2
  double exponent = 1;        // kGrowth
  double half_spacing_m = 1;  // kGrowth: L / 2

  // 1 - P(d), by definition: other implementations are tested against this one. Never falls as d grows.
  // `amplitude` = Delta / z(0.95) at the place, metres (used by the paper's f(Delta) only).
  double operator()(double d, double amplitude) const;
};

// A value at each sample, or one for all.
class SampleField {
 public:
  SampleField() = default;
  explicit SampleField(float constant) : constant_(constant) {}
  explicit SampleField(Grid<float> values) : values_(std::move(values)) {}

  bool is_constant() const { return values_.empty(); }
  float constant() const { return constant_; }
  const Grid<float>& values() const { return values_; }
  float at(int row, int col) const { return is_constant() ? constant_ : values_.at(row, col); }
  Grid<float> release() { return std::exchange(values_, {}); }  // leaves the constant behind

 private:
  float constant_ = 0;
  Grid<float> values_;
};

struct ErrorField {
  SampleField sampling;   // sigma_s, metres
  SampleField amplitude;  // Delta / z(0.95), metres; multiply by profile(d)
  GrowthProfile profile;
  std::vector<CellSize> cell_sizes;  // one per row, at the DEM's middle column (so that windows agree)
  std::vector<double> farthest;  // one per row: the largest distance to the sample within its cell, metres
  double larger_side_m = 0;      // L
  Tails tails = Tails::kNormal;  // of the error in units of sigma
  CorrelatedNoise noise;         // of the measurements' part of the sampling error

  // Learnt from the DEM: what the terrain does between its samples, with amplitude + node share of it for
  // the unit. Of DEMs of means the sampling error holds what a mean leaves open at its own place.
  std::optional<FractalSurface> surface;
  double ridge_gain = 0;  // of the edges of `surface`
  StepLaw steps;          // of what `surface` does between samples

  // The unit of `surface`, metres.
  double plain_per_amplitude() const { return surface ? 1 / (1 - surface->node) : 1; }
  // Of the sampling error the part that is no measurement's.
  double sampling_per_amplitude() const { return surface ? surface->node / (1 - surface->node) : 0; }

  // Largest profile value anywhere in a cell of `row` with that amplitude.
  double largest_profile(int row, double amplitude_there) const {
    return profile(farthest[static_cast<std::size_t>(row)], amplitude_there);
  }
};

}  // namespace sightbound
