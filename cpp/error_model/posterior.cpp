// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_model/posterior.h"

#include <cmath>
#include <utility>

namespace sightbound {

Posterior posterior(const Grid<float>& heights, const ErrorField& error, const Workers& workers,
                    Progress& progress) {
  Posterior result;
  if (error.sampling.is_constant() && error.sampling.constant() == 0) return result;
  const int rows = heights.rows(), cols = heights.cols();
  result.mean = Grid<float>(rows, cols);
  Grid<float> spread(rows, cols);
  workers.for_each(static_cast<std::size_t>(rows), [&](std::size_t n) {
    progress.check();
    const int r = static_cast<int>(n);
    const bool inside = r > 0 && r + 1 < rows;
    for (int c = 0; c < cols; ++c) {
      const double z = heights.at(r, c), sigma = error.sampling.at(r, c);
      result.mean.at(r, c) = static_cast<float>(z);
      spread.at(r, c) = static_cast<float>(sigma);
      if (!inside || c == 0 || c + 1 == cols || sigma == 0) continue;
      const double around = 0.25 * (static_cast<double>(heights.at(r - 1, c)) + heights.at(r + 1, c) +
                                    heights.at(r, c - 1) + heights.at(r, c + 1));
      if (std::isnan(around)) continue;
      const double amplitude = error.amplitude.at(r, c);
      const double p = amplitude * error.profile(error.larger_side_m, amplitude);
      const double s2 = sigma * sigma, q2 = p * p + s2 / 4;
      result.mean.at(r, c) = static_cast<float>(z + (around - z) * s2 / (s2 + q2));
      spread.at(r, c) = static_cast<float>(sigma * std::sqrt(q2 / (s2 + q2)));
    }
  });
  result.spread = SampleField(std::move(spread));
  return result;
}

}  // namespace sightbound
