// SPDX-License-Identifier: GPL-3.0-or-later
// Method. Six triangles meet at sample s; each has one edge along a row and one along a column:
//
//      nw--n         slopes of edges along rows     a above (nw-n), m1 (w-s), m2 (s-e), b below (s'-se)
//       |\ | \       and along columns              l left (nw-w), u (n-s), d (s-s'), r right (e-se)
//       w--s--e      triangles                      (a,u) (m1,l) (m2,u) (m1,d) (m2,r) (b,d)
//        \ | \|      tan^2 = sum of the two squares
//          s'-se
//
// A triangle with a nodata corner has NaN for tan^2, which never replaces the largest so far.
#include "error_model/sampling_error.h"

#include <cmath>
#include <utility>

#include "error_model/row_bands.h"

namespace sightbound {

namespace {

constexpr int kReach = Surroundings::kReach;

struct Row {
  const float *up, *z, *down;  // padded rows of heights
  float per_col_m, per_row_m;  // 1 / ground length of a step
  float sigma_h;
};

inline float square(float x) { return x * x; }
inline float larger(float x, float largest) { return x > largest ? x : largest; }

void steepest(const Row& row, int cols, float* tan_times_sigma_h) {
  const float *up = row.up + kReach, *z = row.z + kReach, *down = row.down + kReach;
  for (int c = 0; c < cols; ++c) {
    const float a = square((up[c] - up[c - 1]) * row.per_col_m),
                b = square((down[c + 1] - down[c]) * row.per_col_m);
    const float m1 = square((z[c] - z[c - 1]) * row.per_col_m),
                m2 = square((z[c + 1] - z[c]) * row.per_col_m);
    const float l = square((z[c - 1] - up[c - 1]) * row.per_row_m),
                r = square((down[c + 1] - z[c + 1]) * row.per_row_m);
    const float u = square((z[c] - up[c]) * row.per_row_m), d = square((down[c] - z[c]) * row.per_row_m);
    float largest = 0;
    largest = larger(a + u, largest);
    largest = larger(m1 + l, largest);
    largest = larger(m2 + u, largest);
    largest = larger(m1 + d, largest);
    largest = larger(m2 + r, largest);
    largest = larger(b + d, largest);
    tan_times_sigma_h[c] = row.sigma_h * std::sqrt(largest);
  }
}

}  // namespace

SampleField sampling_error(SampleField sigma_v, double sigma_h, const Surroundings& heights,
                           std::span<const CellSize> cell_sizes, const Workers& workers, Progress& progress) {
  if (sigma_h == 0) return sigma_v;
  const bool constant = sigma_v.is_constant();
  const float everywhere = sigma_v.constant();
  const int cols = heights.cols(), padded = heights.padded_cols();
  Grid<float> out = constant ? Grid<float>(heights.rows(), cols) : sigma_v.release();
  for_each_band(heights.rows(), workers, progress, [&](int first, int end) {
    RowRing z(3, padded), slope(1, cols);
    for (int r = first - 1; r < first + 1; ++r) heights.copy_row(r, z.row(r));
    for (int r = first; r < end; ++r) {
      heights.copy_row(r + 1, z.row(r + 1));
      const CellSize& cell = cell_sizes[static_cast<std::size_t>(r)];
      const Row row{z.row(r - 1),
                    z.row(r),
                    z.row(r + 1),
                    static_cast<float>(1 / cell.col_m),
                    static_cast<float>(1 / cell.row_m),
                    static_cast<float>(sigma_h)};
      float* koppe = slope.row(0);
      steepest(row, cols, koppe);
      float* to = out.row(r);
      if (constant) {
        for (int c = 0; c < cols; ++c) to[c] = everywhere + koppe[c];
      } else {
        for (int c = 0; c < cols; ++c) to[c] += koppe[c];
      }
    }
  });
  return SampleField(std::move(out));
}

}  // namespace sightbound
