// SPDX-License-Identifier: GPL-3.0-or-later
// What the user says of a DEM's error (paper section 3; design: docs/concepts/error_model.md).
//
//   sigma_s = sigma_v + sigma_h tan(slope)                 sampling error, Koppe
//   sigma_g(d) = (1 - P(d)) Delta / z(0.95)                 between samples, d = distance to the nearest
//   sample sigma = max(sigma_s + sigma_g, 1 mm)                    equation 3.5
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "error_model/tails.h"
#include "terrain/grid.h"

namespace sightbound {

inline constexpr double kLeastSigma = 1e-3;        // metres; keeps clearance ratios finite
inline constexpr double kLargestError = 1e4;       // metres; a larger sigma or Delta is taken for a slip
inline constexpr double kZ95 = 1.959963984540054;  // two_sided_quantile(0.95)

// A raster file, aligned to the DEM by its georeference when used.
struct RasterFile {
  std::string path;
  int band = 1;
};
// An array on the grid of the whole DEM, in the DEM's (core's) row order, metres; NaN = no value.
using SharedGrid = std::shared_ptr<const Grid<float>>;
// Learn it from the DEM.
struct FromDem {
  friend bool operator==(FromDem, FromDem) { return true; }
};
using Quantity = std::variant<FromDem, double, RasterFile, SharedGrid>;

enum class GeologicShape {
  kGaussian,  // P = exp(-f d^2 / 2), f = Delta^2, or 1 / range^2 when a range is given
  kStep,      // P = 1 below the range, else 0
  kGrowth,    // L the larger cell side, t = 2 d / L: 1 - P = (t (2 - t))^min(H, 1); t >= 1: error_field.cpp
};
std::string name_of(GeologicShape shape);                    // "gaussian", "step", "growth"
GeologicShape geologic_shape_from(const std::string& name);  // throws InvalidInput

// What a cell of the DEM holds: the height of its middle, or the mean over it.
enum class CellContent { kSamples, kMeans };
std::string name_of(CellContent content);                // "samples", "means"
CellContent cell_content_from(const std::string& name);  // throws InvalidInput

// Polygons that say what lies between the samples; the one under a sample counts, the largest value on
// overlap.
struct TerrainTypes {
  std::string path;                     // any OGR layer, any CRS
  std::string layer;                    // empty = first
  std::string field;                    // metres, or the name of a class
  std::map<std::string, double> table;  // class -> Delta in metres; empty = default_terrain_table()
};

// A model is complete when nothing is left to learn from the DEM: vertical_rmse is not FromDem, and a
// geologic_variation that is FromDem has its growth_exponent and typical_m. Such a FromDem means: the local
// map, made on each window.
struct ErrorModel {
  Quantity vertical_rmse = FromDem{};  // sigma_v, metres (one standard deviation)
  double horizontal_rmse = 0;  // sigma_h, metres (one standard deviation of the position along one axis)
  Quantity geologic_variation = FromDem{};  // Delta, metres: the largest rise between samples, at 95 %
  GeologicShape geologic_shape = GeologicShape::kGaussian;  // kGrowth when geologic_variation is FromDem
  std::optional<double> geologic_range;                     // metres; never with kGrowth
  std::optional<double> growth_exponent;                    // H, for kGrowth
  std::optional<double> typical_m;    // sd half a spacing from a sample, where the local map has no answer
  std::optional<double> local_scale;  // factor of the local map; unset = 1
  std::optional<TerrainTypes> terrain_types;
  std::optional<Tails> tails;     // of all errors in units of sigma; unset = normal
  double correlation_length = 0;  // metres: measurement errors d apart correlate by exp(-d / length); 0 = not
  double shared_bias = 0;         // metres, DEM minus truth, the same everywhere; moves absolute heights only
  std::optional<CellContent> samples_or_means;  // unset = samples
  std::optional<double> ridge_gain;  // how far the truth stands above the surface, in units of its curvature
  // Where the ground stands level, and where it steps (step_law.h): of the local map; unset = 1 ...
  std::optional<double> level_variance, step_variance;
  // ... and of what is drawn; unset = as `tails`.
  std::optional<double> level_tail, step_tail;

  // F and z of every claim.
  Tails tails_used() const { return tails.value_or(Tails::kNormal); }

  // Throws InvalidInput naming field, value and allowed range.
  void validate() const;
  // True when something is still to be learnt from the DEM (estimate.h).
  bool needs_estimate() const;

  // Rasters stay paths; arrays cannot be written (InvalidInput). from_json(to_json()) is the same model, to
  // the last bit. from_json throws InvalidInput for text that is not such a model, unknown names included; it
  // does not validate().
  std::string to_json() const;
  static ErrorModel from_json(const std::string& text);

  // to_json for reports and metadata: never throws; an array stands as {"array": [rows, cols]}, which
  // from_json refuses.
  std::string describe() const;
};

// Accuracy as people have it, converted once: RMSE as it is, LE90 / 1.6449, LE95 / 1.9600 (vertical, normal);
// CE90 / 2.1460, CE95 / 2.4477 (horizontal, radial: Rayleigh). `horizontal_rmse` is already along one axis.
enum class VerticalMeasure { kRmse, kLe90, kLe95 };
enum class HorizontalMeasure { kRmse, kCe90, kCe95 };
double vertical_sigma(double value_m, VerticalMeasure measure);
double horizontal_sigma(double value_m, HorizontalMeasure measure);

// Delta by class of terrain for samples a few metres apart (paper section 3.2: grassland 0.5 m, craggy 4 m).
const std::map<std::string, double>& default_terrain_table();

// Two-sided normal quantile: 0.95 -> 1.95996. Throws InvalidInput outside (0, 1).
double two_sided_quantile(double confidence);
// Probability that a standard normal variable is below k.
double normal_cdf(double k);

}  // namespace sightbound
