// SPDX-License-Identifier: GPL-3.0-or-later
#include "terrain/max_pyramid.h"

#include <atomic>
#include <cmath>
#include <limits>

namespace sightbound {

namespace {

constexpr float kLowest = std::numeric_limits<float>::lowest();

// Largest of the samples a finest node covers; NaN is told apart because it fails every comparison.
bool finest_row(int rows, int cols, const MaxPyramid::RowSource& source, int node_row, Grid<float>& max,
                Grid<std::uint8_t>& holes) {
  constexpr int kSide = 1 << MaxPyramid::kFinest;
  const int top = node_row * kSide, bottom = std::min(top + kSide, rows - 1);
  std::vector<float> column(static_cast<std::size_t>(cols), kLowest), buffer(static_cast<std::size_t>(cols));
  std::vector<std::uint8_t> nan(static_cast<std::size_t>(cols), 0);
  bool any_hole = false;
  for (int r = top; r <= bottom; ++r) {
    const float* z = source(r, buffer.data());
    for (int c = 0; c < cols; ++c) {
      const auto at = static_cast<std::size_t>(c);
      column[at] = z[c] > column[at] ? z[c] : column[at];
      nan[at] = static_cast<std::uint8_t>(nan[at] | (z[c] != z[c]));
    }
  }
  for (int node = 0; node < max.cols(); ++node) {
    float best = kLowest;
    std::uint8_t hole = 0;
    for (int c = node * kSide; c <= std::min(node * kSide + kSide, cols - 1); ++c) {
      best = std::max(best, column[static_cast<std::size_t>(c)]);
      hole = static_cast<std::uint8_t>(hole | nan[static_cast<std::size_t>(c)]);
    }
    max.at(node_row, node) = best;
    holes.at(node_row, node) = hole;
    any_hole = any_hole || hole != 0;
  }
  return any_hole;
}

template <class T>
Grid<T> halved(const Grid<T>& fine) {
  Grid<T> coarse((fine.rows() + 1) / 2, (fine.cols() + 1) / 2);
  for (int r = 0; r < coarse.rows(); ++r) {
    for (int c = 0; c < coarse.cols(); ++c) {
      const int r1 = std::min(2 * r + 1, fine.rows() - 1), c1 = std::min(2 * c + 1, fine.cols() - 1);
      coarse.at(r, c) = std::max(std::max(fine.at(2 * r, 2 * c), fine.at(2 * r, c1)),
                                 std::max(fine.at(r1, 2 * c), fine.at(r1, c1)));
    }
  }
  return coarse;
}

}  // namespace

MaxPyramid::MaxPyramid(int sample_rows, int sample_cols, const RowSource& source, const Workers& workers,
                       Progress& progress) {
  constexpr int kSide = 1 << kFinest;
  const int rows = std::max(1, (sample_rows - 1 + kSide - 1) / kSide);
  const int cols = std::max(1, (sample_cols - 1 + kSide - 1) / kSide);
  max_.emplace_back(rows, cols);
  holes_.emplace_back(rows, cols);
  std::atomic<bool> any_hole{false};
  workers.for_each(static_cast<std::size_t>(rows), [&](std::size_t r) {
    progress.check();
    if (finest_row(sample_rows, sample_cols, source, static_cast<int>(r), max_[0], holes_[0]))
      any_hole = true;
  });
  while (max_.back().rows() > 1 || max_.back().cols() > 1) {
    max_.push_back(halved(max_.back()));
    if (any_hole) holes_.push_back(halved(holes_.back()));
  }
  if (!any_hole) holes_.clear();
}

}  // namespace sightbound
