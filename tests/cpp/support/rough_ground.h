// SPDX-License-Identifier: GPL-3.0-or-later
// Random terrain with its error, cells of 10 m.
#pragma once

#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "error_model/error_field.h"
#include "terrain/grid.h"

namespace sightbound::testing {

struct RoughGround {
  Grid<float> heights;
  ErrorField error;
};

inline RoughGround rough_ground(int rows, int cols, float sigma, bool holes) {
  std::mt19937 random(11);
  std::normal_distribution<float> step(0, 2);
  RoughGround ground{Grid<float>(rows, cols), {}};
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) {
      const float before = c > 0 ? ground.heights.at(r, c - 1) : 100,
                  above = r > 0 ? ground.heights.at(r - 1, c) : 100;
      ground.heights.at(r, c) = (before + above) / 2 + step(random);
    }
  }
  if (holes) ground.heights.at(rows / 3, cols / 4) = std::numeric_limits<float>::quiet_NaN();
  ground.error.sampling = SampleField(sigma);
  ground.error.amplitude = SampleField(0.0f);
  ground.error.cell_sizes.assign(static_cast<std::size_t>(rows), {10, 10});
  ground.error.farthest.assign(static_cast<std::size_t>(rows), 10 / std::sqrt(2.0));
  ground.error.larger_side_m = 10;
  return ground;
}

// Error in patches, some ten times that of others: a search that takes one place's sigma for another's is
// found out.
inline void vary_error(RoughGround& ground) {
  constexpr int kPatch = 9;
  std::mt19937 random(12);
  std::exponential_distribution<float> peaked(2);
  const int rows = ground.heights.rows(), cols = ground.heights.cols();
  Grid<float> patches(rows / kPatch + 1, cols / kPatch + 1), sampling(rows, cols), amplitude(rows, cols);
  for (float& p : patches.values()) p = peaked(random);
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) {
      amplitude.at(r, c) = patches.at(r / kPatch, c / kPatch);
      sampling.at(r, c) = 0.02f + 0.1f * amplitude.at(r, c);
    }
  }
  ground.error.sampling = SampleField(std::move(sampling));
  ground.error.amplitude = SampleField(std::move(amplitude));
  ground.error.profile = {GeologicShape::kGrowth, 0, 0.7, 5};
}

}  // namespace sightbound::testing
