// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_model/posterior.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sightbound {

namespace {

constexpr double kLeastGain = 0.05;  // of an edge: below, centres get the same as edges

// The mean of the four neighbours; NaN at the rim and beside a hole.
double around(const Grid<float>& heights, int r, int c) {
  if (r == 0 || c == 0 || r + 1 == heights.rows() || c + 1 == heights.cols()) return NAN;
  return 0.25 * (static_cast<double>(heights.at(r - 1, c)) + heights.at(r + 1, c) + heights.at(r, c - 1) +
                 heights.at(r, c + 1));
}

// `row`(r) for all rows, side by side.
template <class Row>
void for_rows(int rows, const Workers& workers, Progress& progress, const Row& row) {
  workers.for_each(static_cast<std::size_t>(rows), [&](std::size_t n) {
    progress.check();
    row(static_cast<int>(n));
  });
}

// Of errors at a sample and at one beside it.
double neighbours_correlation(const CorrelatedNoise& noise) {
  return 0.5 * (noise.correlation(0, 1) + noise.correlation(1, 0));
}

// Of the four errors around with each other, each with itself too.
double four_correlation(const CorrelatedNoise& noise) {
  return 0.25 + 0.125 * (noise.correlation(0, 2) + noise.correlation(2, 0)) + 0.5 * noise.correlation(1, 1);
}

void weigh_neighbours(const Grid<float>& heights, const ErrorField& error, const Workers& workers,
                      Progress& progress, Posterior& result) {
  const int rows = heights.rows(), cols = heights.cols();
  const double along = neighbours_correlation(error.noise), among = four_correlation(error.noise);
  result.mean = Grid<float>(rows, cols);
  Grid<float> spread(rows, cols);
  for_rows(rows, workers, progress, [&](int r) {
    for (int c = 0; c < cols; ++c) {
      const double z = heights.at(r, c), amplitude = error.amplitude.at(r, c);
      const double sigma =
          std::max(error.sampling.at(r, c) - error.sampling_per_amplitude() * amplitude, 0.0);
      const double m = around(heights, r, c);
      result.mean.at(r, c) = static_cast<float>(z);
      spread.at(r, c) = static_cast<float>(sigma);
      if (std::isnan(m) || sigma == 0) continue;
      const double p = amplitude * error.profile(error.larger_side_m, amplitude);
      const double s2 = sigma * sigma, gain = s2 * (1 - along) / (p * p + s2 * (1 - 2 * along + among));
      result.mean.at(r, c) = static_cast<float>(z + (m - z) * gain);
      spread.at(r, c) = static_cast<float>(sigma * std::sqrt(1 - (1 - along) * gain));
    }
  });
  (error.noise.is_independent() ? result.spread : result.shared) = SampleField(std::move(spread));
}

// From means to the terrain at their middles.
void sharpen(const Grid<float>& heights, const ErrorField& error, const Workers& workers, Progress& progress,
             Posterior& result) {
  const FractalSurface::Middle& sample = error.surface->sample;
  const double own = sample.spread * error.plain_per_amplitude();
  const Grid<float> weighed = std::exchange(result.mean, {});
  const Grid<float>& means = weighed.empty() ? heights : weighed;
  const SampleField before = std::move(result.spread);
  const int rows = means.rows(), cols = means.cols();
  result.mean = Grid<float>(rows, cols);
  Grid<float> spread(rows, cols);
  for_rows(rows, workers, progress, [&](int r) {
    for (int c = 0; c < cols; ++c) {
      const double z = means.at(r, c), m = around(means, r, c);
      result.mean.at(r, c) = static_cast<float>(std::isnan(m) ? z : z + sample.gain * (z - m));
      spread.at(r, c) = static_cast<float>(
          std::hypot(static_cast<double>(before.at(r, c)), own * error.amplitude.at(r, c)));
    }
  });
  result.spread = SampleField(std::move(spread));
}

// What is drawn of `gain` (near - far); nothing where one of them is not known.
float rise(double gain, double near, double far) {
  const double rise = gain * (near - far);
  return std::isnan(rise) ? 0.0f : static_cast<float>(rise);
}

MiddleRises rises_of(const Grid<float>& z, const ErrorField& error, const Workers& workers,
                     Progress& progress) {
  const FractalSurface& surface = *error.surface;
  const int rows = z.rows(), cols = z.cols();
  const double of_edges = error.ridge_gain, edge = 0.5 * (surface.row_edge.gain + surface.col_edge.gain);
  const double of_centres = edge > kLeastGain ? of_edges * surface.centre.gain / edge : of_edges;
  MiddleRises out{Grid<float>::zeros(rows, cols), Grid<float>::zeros(rows, cols),
                  Grid<float>::zeros(rows, cols)};
  const auto at = [&](int r, int c) {
    return r < 0 || c < 0 || r >= rows || c >= cols ? NAN : static_cast<double>(z.at(r, c));
  };
  for_rows(rows, workers, progress, [&](int r) {
    for (int c = 0; c < cols; ++c) {
      out.row_edge.at(r, c) =
          rise(of_edges, 0.5 * (at(r, c) + at(r, c + 1)), 0.5 * (at(r, c - 1) + at(r, c + 2)));
      out.col_edge.at(r, c) =
          rise(of_edges, 0.5 * (at(r, c) + at(r + 1, c)), 0.5 * (at(r - 1, c) + at(r + 2, c)));
      double near = 0, far = 0;
      for (const int i : {0, 1}) {
        for (const int j : {0, 1}) near += 0.25 * at(r + i, c + j);
        for (const int j : {-1, 2}) far += 0.125 * (at(r + i, c + j) + at(r + j, c + i));
      }
      out.centre.at(r, c) = rise(of_centres, near, far);
    }
  });
  return out;
}

}  // namespace

Posterior posterior(const Grid<float>& heights, const ErrorField& error, const Workers& workers,
                    Progress& progress) {
  Posterior result;
  const bool exact = error.sampling.is_constant() && error.sampling.constant() == 0;
  if (!exact) weigh_neighbours(heights, error, workers, progress, result);
  if (!error.surface) return result;
  if (error.surface->node > 0) sharpen(heights, error, workers, progress, result);
  result.rises = rises_of(result.mean.empty() ? heights : result.mean, error, workers, progress);
  return result;
}

}  // namespace sightbound
