// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_model/error_model.h"

#include <cmath>
#include <sstream>

#include "base/error.h"
#include "error_model/step_law.h"

namespace sightbound {

namespace {

constexpr double kLargestRange = 1e6;  // metres
constexpr double kLeastExponent = 0.1, kLargestExponent = 2;
constexpr double kLargestLength = 1e6;  // metres
constexpr double kLargestRidgeGain = 2;
constexpr double kLargestVariance = 10;  // of level_variance and step_variance

std::string text(double value) {
  std::ostringstream out;
  out.precision(10);
  out << value;
  return out.str();
}

void require_between(const std::string& field, double value, double least, double largest,
                     const std::string& unit) {
  if (std::isfinite(value) && value >= least && value <= largest) return;
  throw InvalidInput(field + " is " + text(value) + "; allowed are " + text(least) + " to " + text(largest) +
                     unit + ".");
}

void require_error(const std::string& field, double metres) {
  require_between(field, metres, 0, kLargestError, " m");
}

void validate_quantity(const std::string& field, const Quantity& quantity) {
  if (const auto* number = std::get_if<double>(&quantity)) require_error(field, *number);
  if (const auto* raster = std::get_if<RasterFile>(&quantity)) {
    if (raster->path.empty()) throw InvalidInput(field + " is a raster without a path; name the file.");
    if (raster->band < 1) {
      throw InvalidInput(field + " names band " + std::to_string(raster->band) + "; bands count from 1.");
    }
  }
  if (const auto* array = std::get_if<SharedGrid>(&quantity)) {
    if (!*array || (*array)->empty())
      throw InvalidInput(field + " is an empty array; give one value per DEM cell.");
  }
}

void validate_shape(const ErrorModel& model) {
  const bool from_dem = std::holds_alternative<FromDem>(model.geologic_variation);
  if (model.geologic_range) {
    const double range = *model.geologic_range;
    if (!(range > 0)) {
      throw InvalidInput("geologic_range is " + text(range) + "; allowed are values above 0 up to " +
                         text(kLargestRange) + " m. Leave it out for the paper's own f(Delta) = Delta^2.");
    }
    require_between("geologic_range", range, 0, kLargestRange, " m");
    if (from_dem) {
      throw InvalidInput(
          "geologic_range is " + text(range) +
          ", but geologic_variation is left to be estimated, and the estimate measures its own growth with "
          "distance. Give geologic_variation too, or leave geologic_range out.");
    }
    if (model.geologic_shape == GeologicShape::kGrowth) {
      throw InvalidInput(
          "geologic_range is " + text(range) +
          ", but the geologic model 'growth' has none; leave it out, or choose 'gaussian' or 'step'.");
    }
  }
  if (model.geologic_shape == GeologicShape::kStep) {
    if (from_dem) {
      throw InvalidInput(
          "The geologic model 'step' needs a geologic_variation; without one the estimate measures its own "
          "growth with distance. Give geologic_variation, or choose 'gaussian'.");
    }
    if (!model.geologic_range) {
      throw InvalidInput(
          "The geologic model 'step' needs a geologic_range: the distance in metres from a sample up to "
          "which the surface is trusted.");
    }
  }
  if (model.growth_exponent) {
    require_between("growth_exponent", *model.growth_exponent, kLeastExponent, kLargestExponent, "");
    if (!from_dem && model.geologic_shape != GeologicShape::kGrowth) {
      throw InvalidInput("growth_exponent is given, but the geologic model is '" +
                         name_of(model.geologic_shape) + "'; choose 'growth', or leave it out.");
    }
  } else if (!from_dem && model.geologic_shape == GeologicShape::kGrowth) {
    throw InvalidInput("The geologic model 'growth' needs a growth_exponent between " + text(kLeastExponent) +
                       " and " + text(kLargestExponent) +
                       " (bare earth: about 1), or no geologic_variation, to estimate both.");
  }
  if (model.typical_m) require_error("typical_m", *model.typical_m);
  if (model.local_scale) require_between("local_scale", *model.local_scale, 0.01, 100, "");
}

void validate_types(const TerrainTypes& types) {
  if (types.path.empty()) throw InvalidInput("terrain_types has no path; name a file of polygons.");
  if (types.field.empty()) {
    throw InvalidInput(
        "terrain_field is missing; name the attribute of terrain_types that holds metres or a class.");
  }
  for (const auto& [name, metres] : types.table) require_error("terrain_table['" + name + "']", metres);
}

}  // namespace

std::string name_of(GeologicShape shape) {
  switch (shape) {
    case GeologicShape::kGaussian:
      return "gaussian";
    case GeologicShape::kStep:
      return "step";
    case GeologicShape::kGrowth:
      return "growth";
  }
  throw BrokenGuarantee("unknown GeologicShape");
}

GeologicShape geologic_shape_from(const std::string& name) {
  for (const auto shape : {GeologicShape::kGaussian, GeologicShape::kStep, GeologicShape::kGrowth}) {
    if (name == name_of(shape)) return shape;
  }
  throw InvalidInput("geologic_model is '" + name + "'; allowed are 'gaussian', 'step' and 'growth'.");
}

std::string name_of(CellContent content) { return content == CellContent::kMeans ? "means" : "samples"; }

CellContent cell_content_from(const std::string& name) {
  for (const auto content : {CellContent::kSamples, CellContent::kMeans}) {
    if (name == name_of(content)) return content;
  }
  throw InvalidInput("samples_or_means is '" + name + "'; allowed are 'samples' and 'means'.");
}

void ErrorModel::validate() const {
  validate_quantity("vertical_rmse", vertical_rmse);
  require_error("horizontal_rmse", horizontal_rmse);
  validate_quantity("geologic_variation", geologic_variation);
  validate_shape(*this);
  if (terrain_types) validate_types(*terrain_types);
  require_between("correlation_length", correlation_length, 0, kLargestLength, " m");
  require_between("shared_bias", shared_bias, -kLargestError, kLargestError, " m");
  if (level_variance) require_between("level_variance", *level_variance, 0, kLargestVariance, "");
  if (step_variance) require_between("step_variance", *step_variance, 0, kLargestVariance, "");
  if (level_tail.has_value() != step_tail.has_value())
    throw InvalidInput("level_tail and step_tail belong together: give both or none.");
  if (level_tail) require_between("level_tail", *level_tail, 0, StepLaw::kLargestTail, "");
  if (step_tail) require_between("step_tail", *step_tail, 0, StepLaw::kLargestTail, "");
  if (ridge_gain) require_between("ridge_gain", *ridge_gain, -kLargestRidgeGain, kLargestRidgeGain, "");
}

bool ErrorModel::needs_estimate() const {
  const bool geologic =
      std::holds_alternative<FromDem>(geologic_variation) && !(growth_exponent && typical_m);
  return geologic || std::holds_alternative<FromDem>(vertical_rmse);
}

const std::map<std::string, double>& default_terrain_table() {
  // Ends: paper section 3.2. Between: our reading, in steps a user can tell apart on the ground.
  static const std::map<std::string, double> table = {
      {"grassland", 0.5}, {"farmland", 0.7}, {"shrubland", 1.0}, {"woodland", 1.5},
      {"hilly", 2.0},     {"rocky", 3.0},    {"craggy", 4.0},
  };
  return table;
}

}  // namespace sightbound
