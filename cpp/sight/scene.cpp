// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sight/line_ends.h"

namespace sightbound {

namespace {

double most_growth(const ErrorField& error) {
  // The paper's f(Delta) makes the profile depend on the amplitude; 1 bounds it and keeps the bound linear.
  if (error.profile.shape == GeologicShape::kGaussian && error.profile.range_m <= 0) return 1;
  double largest = 0;
  for (int row = 0; row < static_cast<int>(error.cell_sizes.size()); ++row) {
    largest = std::max(largest, error.largest_profile(row, 0));
  }
  return largest;
}

double most_amplitude(const SampleField& amplitude) {
  if (amplitude.is_constant()) return amplitude.constant();
  float most = 0;
  for (const float a : amplitude.values().values()) most = a > most ? a : most;
  return most;
}

double least_sampling(const SampleField& sampling) {
  if (sampling.is_constant()) return sampling.constant();
  float least = std::numeric_limits<float>::max();
  for (const float s : sampling.values().values()) least = s < least ? s : least;
  return least;
}

}  // namespace

Scene::Scene(const Grid<float>& heights_in, const ErrorField& error_in, const SceneOptions& options,
             const Workers& workers, Progress& progress)
    : heights(heights_in),
      error(error_in),
      quantile(two_sided_quantile(options.confidence, error_in.tails)),
      largest_ratio(std::max(certain_ratio(error_in.tails), quantile)),
      bend(options.curvature ? 1 - options.refraction : 0),
      ends_move(options.ends_move),
      see_across_nodata(options.see_across_nodata),
      end_zone_m(kEndZoneCells * error_in.larger_side_m),
      uniform(error_in.sampling.is_constant() && error_in.amplitude.is_constant() &&
              error_in.amplitude.constant() == 0),
      highest(
          heights_in.rows(), heights_in.cols(), [&](int r, float*) { return heights_in.row(r); }, workers,
          progress),
      least_sigma(std::max(least_sampling(error_in.sampling), kLeastSigma)),
      largest_profile_(most_growth(error_in)),
      most_between_(
          std::max(most_amplitude(error_in.amplitude) * largest_profile_ * (1 + 1e-6), kLeastSigma)) {
  if (uniform) return;
  widest = MaxPyramid(
      heights.rows(), heights.cols(),
      [&](int r, float* buffer) {
        for (int c = 0; c < heights.cols(); ++c) {
          buffer[c] =
              std::nextafter(static_cast<float>(sigma_bound(r, c)), std::numeric_limits<float>::max());
        }
        return buffer;
      },
      workers, progress);
}

}  // namespace sightbound
