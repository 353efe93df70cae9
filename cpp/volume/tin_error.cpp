// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/tin_error.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"

namespace sightbound {

namespace {

std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }

// sigma_v of each vertex.
std::vector<double> vertical_errors(const Tin& tin, const ErrorModel& model) {
  const double* everywhere = std::get_if<double>(&model.vertical_rmse);
  std::vector<double> sigma(tin.vertices.size());
  for (std::size_t v = 0; v < sigma.size(); ++v) {
    const bool own = !tin.sigma_v.empty() && !std::isnan(tin.sigma_v[v]);
    if (!own && everywhere == nullptr) {
      throw InvalidInput("vertical_rmse is not a number, and vertex " + std::to_string(v) +
                         " has no vertical error of its own. A TIN's error cannot be learnt from it or read "
                         "from a raster: give vertical_rmse in metres.");
    }
    sigma[v] = own ? static_cast<double>(tin.sigma_v[v]) : *everywhere;
    if (!(sigma[v] >= 0 && sigma[v] <= kLargestError)) {
      throw InvalidInput("The vertical error of vertex " + std::to_string(v) + " is " +
                         std::to_string(sigma[v]) + " m; it must lie between 0 and 10000 m.");
    }
  }
  return sigma;
}

}  // namespace

TinError resolve_tin_error(const Tin& tin, const ErrorModel& model, Metric metric) {
  model.validate();
  if (model.terrain_types)
    throw InvalidInput("terrain_types needs a DEM; give geologic_variation in metres for a TIN.");
  const double* variation = std::get_if<double>(&model.geologic_variation);
  if (variation == nullptr) {
    throw InvalidInput(
        "geologic_variation is not a number. It cannot be learnt from a TIN or read from a raster: give it "
        "in metres (0 = none).");
  }
  const std::vector<double> sigma_v = vertical_errors(tin, model);
  TinError error;
  error.sampling.assign(tin.vertices.size(), 0);
  for (const Face& face : tin.faces) {
    const Xyz normal = normal_of(tin, face);
    const double flat = std::hypot(normal.x, normal.y), up = std::abs(normal.z), size = length(normal);
    for (const std::int32_t v : face) {
      const double sigma = metric == Metric::kVertical
                               ? sigma_v[index(v)] + model.horizontal_rmse * flat / up
                               : (sigma_v[index(v)] * up + model.horizontal_rmse * flat) / size;
      error.sampling[index(v)] =
          std::max(error.sampling[index(v)], static_cast<float>(std::min(sigma, kLargestError)));
    }
  }
  error.spacing_m = median_edge(tin);
  error.profile.shape = model.geologic_shape;
  error.profile.range_m = model.geologic_range.value_or(0);
  error.profile.exponent = model.growth_exponent.value_or(1);
  error.profile.half_spacing_m = error.spacing_m / 2;
  if (*variation > 0) error.amplitude.assign(tin.vertices.size(), static_cast<float>(*variation / kZ95));
  return error;
}

}  // namespace sightbound
