// SPDX-License-Identifier: GPL-3.0-or-later
// Method. Rows are walked in bands, each keeping five rows of heights and three of box sums:
//
//   m = e_row^2 + e_col^2 + w e_diagonal^2      doubled residuals, w = ResidualScale::diagonal
//   b = m(c-1) + m(c) + m(c+1)                  row sums, then three rows of them: 27 weighted squares
//
// NaN runs through this unhindered; only cells that come out NaN are looked at again, residual by residual.
// Every sum has a fixed order, so that no value depends on where a band or a window begins.
#include "error_model/local_variation.h"

#include <cmath>

#include "error_model/fractal_surface.h"
#include "error_model/row_bands.h"

namespace sightbound {

namespace {

constexpr int kReach = Surroundings::kReach;

struct Weights {
  float diagonal;  // w
  float whole;     // factor for sqrt(sum of all 27)
  ResidualScale scale;
  float typical;
};

void residual_squares(const float* up, const float* z, const float* down, int n, float w, float* m) {
  for (int i = 1; i < n - 1; ++i) {
    const float row =
        (z[i] - z[i - 1]) + (z[i] - z[i + 1]);  // differences first: exact for neighbouring heights
    const float col = (z[i] - up[i]) + (z[i] - down[i]);
    const float diagonal = (z[i] - up[i - 1]) + (z[i] - down[i + 1]);
    m[i] = row * row + col * col + w * (diagonal * diagonal);
  }
}

void row_sums(const float* m, int n, float* b) {
  for (int i = kReach; i < n - kReach; ++i) b[i] = m[i - 1] + m[i] + m[i + 1];
}

void roots(const float* b0, const float* b1, const float* b2, int cols, float factor, float* out) {
  for (int c = 0; c < cols; ++c) {
    const int i = c + kReach;
    out[c] = factor * std::sqrt(b0[i] + b1[i] + b2[i]);
  }
}

bool any_nan(const float* values, int n) {
  int found = 0;
  for (int i = 0; i < n; ++i) found |= values[i] != values[i];
  return found != 0;
}

// The same rms from those residuals that exist.
float from_what_is_there(RowRing& heights, int row, int i, const Weights& weights) {
  double sum = 0;
  int count = 0;
  const auto add = [&](float z, float before, float after, double weight) {
    const double e = 0.5 * ((static_cast<double>(z) - before) + (static_cast<double>(z) - after));
    if (std::isnan(e)) return;
    sum += weight * e * e;
    ++count;
  };
  for (int r = row - 1; r <= row + 1; ++r) {
    const float *up = heights.row(r - 1), *z = heights.row(r), *down = heights.row(r + 1);
    for (int k = i - 1; k <= i + 1; ++k) {
      add(z[k], z[k - 1], z[k + 1], 1);
      add(z[k], up[k], down[k], 1);
      add(z[k], up[k - 1], down[k + 1], weights.scale.diagonal);
    }
  }
  return count > 0 ? static_cast<float>(weights.scale.to_half_spacing * std::sqrt(sum / count))
                   : weights.typical;
}

void repair(RowRing& heights, int row, const Weights& weights, int cols, float* out) {
  const float* z = heights.row(row) + kReach;
  for (int c = 0; c < cols; ++c) {
    if (!std::isnan(out[c])) continue;
    out[c] = std::isnan(z[c]) ? weights.typical : from_what_is_there(heights, row, c + kReach, weights);
  }
}

}  // namespace

ResidualScale residual_scale(double growth_exponent, CellContent content, double local_scale) {
  return {local_scale * fractal_surface(growth_exponent, content).per_residual,
          std::exp2(-apparent_exponent(growth_exponent, content))};
}

Grid<float> local_variation(const Surroundings& heights, const ResidualScale& scale, double typical_m,
                            const Workers& workers, Progress& progress) {
  const Weights weights{static_cast<float>(scale.diagonal),
                        static_cast<float>(scale.to_half_spacing * 0.5 / std::sqrt(27.0)), scale,
                        static_cast<float>(typical_m)};
  const int cols = heights.cols(), padded = heights.padded_cols();
  Grid<float> out(heights.rows(), cols);
  for_each_band(heights.rows(), workers, progress, [&](int first, int end) {
    RowRing z(5, padded), sums(3, padded), squares(1, padded);
    const auto take_heights = [&](int r) { heights.copy_row(r, z.row(r)); };
    const auto take_sums = [&](int r) {
      residual_squares(z.row(r - 1), z.row(r), z.row(r + 1), padded, weights.diagonal, squares.row(0));
      row_sums(squares.row(0), padded, sums.row(r));
    };
    for (int r = first - 2; r < first + 2; ++r) take_heights(r);
    for (int r = first - 1; r < first + 1; ++r) take_sums(r);
    for (int r = first; r < end; ++r) {
      take_heights(r + 2);
      take_sums(r + 1);
      roots(sums.row(r - 1), sums.row(r), sums.row(r + 1), cols, weights.whole, out.row(r));
      if (any_nan(out.row(r), cols)) repair(z, r, weights, cols, out.row(r));
    }
  });
  return out;
}

}  // namespace sightbound
