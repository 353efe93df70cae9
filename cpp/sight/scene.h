// SPDX-License-Identifier: GPL-3.0-or-later
// What every sight line of a job shares: terrain, error, and how they are judged. Read-only, one for all
// threads.
#pragma once

#include "base/parallel.h"
#include "base/progress.h"
#include "error_model/error_field.h"
#include "terrain/grid.h"
#include "terrain/max_pyramid.h"

namespace sightbound {

struct SceneOptions {
  double confidence = 0.95;
  double refraction = 0.13;
  bool curvature = true;
  bool ends_move = false;  // stand = ground: eye and target move with the unknown ground under them
  bool see_across_nodata = false;
};

struct Scene {
  // `heights` and `error` are kept by reference.
  Scene(const Grid<float>& heights, const ErrorField& error, const SceneOptions&, const Workers&,
        Progress&);  // only checks the progress

  const Grid<float>& heights;
  const ErrorField& error;
  double quantile;       // z(c)
  double largest_ratio;  // K, certain_ratio() or z(c) when larger: k* is settled within +-K
  double bend;           // share of D^2 / 2R by which a line bulges against the ground: 1 - refraction, or 0
  bool ends_move, see_across_nodata;
  double end_zone_m;   // metres
  bool uniform;        // sigma_s the same everywhere and no between-sample error
  MaxPyramid highest;  // of heights
  MaxPyramid widest;   // of sigma_bound; empty when uniform
  double least_sigma;  // nowhere outside the end zones is sigma smaller

  // Upper bounds of sigma in terms of sample values: on every triangle sigma is at most the linear
  // interpolation of these.
  double sigma_bound(int row, int col) const {
    return std::max(error.sampling.at(row, col) + between_bound(row, col), kLeastSigma);
  }
  double between_bound(int row, int col) const { return error.amplitude.at(row, col) * largest_profile_; }
  double largest_profile() const { return largest_profile_; }
  // No sigma within the end zones is larger, but for what moving ends add.
  double most_between() const { return most_between_; }

 private:
  double largest_profile_ = 0, most_between_ = 0;
};

}  // namespace sightbound
