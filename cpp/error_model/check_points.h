// SPDX-License-Identifier: GPL-3.0-or-later
// A DEM's error learnt from places where the truth is known.
//
// Which part of what is measured becomes what part of the model. At a check point between the samples the
// residual holds two errors: that of the measured heights, sigma_s = sigma_v + sigma_h tan(slope), and what
// the ground does between samples, sigma_g, which the model has already (from the DEM itself). Variances add,
// so the second is taken off before the first is fitted:
//
//   (a + b tan)^2 = max(0, (90 % quantile of |r - bias| / z(0.90))^2 - mean of sigma_g^2)    in bins of slope
//   vertical_rmse = a, horizontal_rmse = b
//
// At the samples themselves (a reference DEM) sigma_g is 0 and nothing is taken off.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "error_model/error_model.h"
#include "error_model/horizontal_shift.h"
#include "error_model/residual_statistics.h"
#include "error_model/variogram.h"

namespace sightbound {

inline constexpr std::size_t kFewestChecks = 10;

struct CheckedPlace {
  double x = 0, y = 0;   // metres in plan
  double error = 0;      // DEM minus truth, metres
  double slope = 0;      // tangent, as sigma_s takes it (sampling_error.h)
  double curvature = 0;  // how far the DEM's samples rise above the middle of their neighbours, metres
  double between = 0;    // sigma_g at the place, metres
};

// How large errors are where something else (slope, curvature) is so and so large.
struct Dependence {
  struct Bin {
    double value = 0;  // mean of slope or |curvature|
    double sigma = 0;  // scale of the residuals less the bias, sigma_g taken off, metres
    double places = 0;
  };
  std::vector<Bin> bins;  // of equally many places
  double explained = 0;   // share of the variance of |residual - bias| that lies between the bins
};

// What a DEM has too much, metres: along its rows, against them, and upwards. The DEM that is left without it
// is another, with a model of its own.
struct Correction {
  double x = 0, y = 0, z = 0;
};

struct ErrorCheck {
  ResidualStatistics statistics;
  Tails tails = Tails::kNormal;   // of the residuals in units of their own sigma
  std::vector<double> quantiles;  // of |residual - bias| / sigma, at kShownConfidences
  double at_flat = 0;             // a, metres
  double per_slope = 0;           // b, metres
  double between = 0;             // rms of sigma_g at the places: what was taken off, metres
  double ridge_bias = 0;          // truth minus DEM per metre of curvature, least squares
  Dependence slope, curvature;
  Variogram variogram;
  std::optional<HorizontalShift> shift;
  Correction correction;        // the shift; the bias alone where none could be told
  bool corrected = false;       // the residuals are those of the DEM without it
  std::size_t left_out = 0;     // places with a height of one of the two only
  std::size_t equal_level = 0;  // level in both and exactly equal: water or filling, left out
  std::vector<std::string> warnings;
};
inline constexpr double kShownConfidences[] = {0.5, 0.6827, 0.8, 0.9, 0.95, 0.98, 0.99, 0.995, 0.999};

// Fills in all but the variogram and what was found before (shift, places left out). Throws InvalidInput for
// fewer than kFewestChecks places.
void judge(std::span<const CheckedPlace>, ErrorCheck&);

// The model with what was learnt: only what nobody has said (vertical_rmse from the DEM, 0 for the others)
// is changed. `check` is judged and has its variogram.
ErrorModel with_check(ErrorModel, const ErrorCheck& check);

}  // namespace sightbound
