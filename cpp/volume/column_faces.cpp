// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/column_faces.h"

#include <algorithm>

#include "base/error.h"
#include "volume/dem_surface.h"

namespace sightbound {

namespace {
constexpr double kMostColumns = 1 << 30;
constexpr double kTouch = 1e-9;  // voxels

int columns(double extent, double voxel) {
  const double count = std::ceil(extent / voxel);
  if (count > kMostColumns)
    throw InvalidInput("voxel_m is " + std::to_string(voxel) + ", too small for this terrain.");
  return std::max(static_cast<int>(count), 1);
}

std::size_t index(int i) { return static_cast<std::size_t>(i); }

// Counting sort of `numbers` into squares.
template <class Index, class ForEach>
void sort_into(std::size_t squares, std::vector<Index>& start, std::vector<std::uint32_t>& numbers,
               const ForEach& for_each) {
  start.assign(squares + 1, 0);
  for_each([&](std::size_t square, std::uint32_t) { ++start[square + 1]; });
  for (std::size_t s = 0; s < squares; ++s) start[s + 1] += start[s];
  numbers.resize(start[squares]);
  std::vector<Index> next(start.begin(), start.end() - 1);
  for_each([&](std::size_t square, std::uint32_t number) { numbers[next[square]++] = number; });
}
}  // namespace

ColumnFaces::ColumnFaces(const Surface& surface, double voxel_m)
    : surface_(surface),
      dem_(dynamic_cast<const DemSurface*>(&surface)),
      voxel_m_(voxel_m),
      cols_(columns(surface.bounds().high.x, voxel_m)),
      rows_(columns(surface.bounds().high.y, voxel_m)) {
  if (dem_ != nullptr) return;
  const std::size_t across = index(blocks_across()), down = index(blocks_down());
  sort_into(across * down, start_, numbers_, [&](const auto& visit) {
    for (std::size_t number = 0; number < surface_.face_count(); ++number) {
      const Range range = squares_of(*surface_.face(number), 128);
      for (int b = range.j0; b <= range.j1; ++b) {
        for (int a = range.i0; a <= range.i1; ++a)
          visit(index(b) * across + index(a), static_cast<std::uint32_t>(number));
      }
    }
  });
}

ColumnFaces::Range ColumnFaces::squares_of(const SurfaceFace& face, int side) const {
  const auto& p = face.corner;
  const auto square = [&](double place, int limit) {
    return std::clamp(static_cast<int>(std::floor(place / voxel_m_ / side)), 0, (limit - 1) / side);
  };
  const double touch = kTouch * voxel_m_;
  return {square(std::min({p[0].x, p[1].x, p[2].x}) - touch, cols_),
          square(std::max({p[0].x, p[1].x, p[2].x}) + touch, cols_),
          square(std::min({p[0].y, p[1].y, p[2].y}) - touch, rows_),
          square(std::max({p[0].y, p[1].y, p[2].y}) + touch, rows_)};
}

ColumnFaces::Block::Block(const ColumnFaces& faces, int a, int b) : faces_(faces), a_(a), b_(b) {
  if (faces.dem_ != nullptr) return;
  const std::size_t block = index(b) * index(faces.blocks_across()) + index(a);
  sort_into(256, start_, numbers_, [&](const auto& visit) {
    for (std::size_t n = faces_.start_[block]; n < faces_.start_[block + 1]; ++n) {
      const std::uint32_t number = faces_.numbers_[n];
      const Range range = faces_.squares_of(*faces_.surface_.face(number), 8);
      for (int i8 = std::max(range.i0, 16 * a_); i8 <= std::min(range.i1, 16 * a_ + 15); ++i8) {
        for (int j8 = std::max(range.j0, 16 * b_); j8 <= std::min(range.j1, 16 * b_ + 15); ++j8) {
          visit(index(16 * (i8 - 16 * a_) + j8 - 16 * b_), number);
        }
      }
    }
  });
}

void ColumnFaces::Block::near(int i8, int j8, std::vector<std::uint32_t>& numbers) const {
  numbers.clear();
  if (faces_.dem_ == nullptr) {
    const std::size_t square = index(16 * (i8 - 16 * a_) + j8 - 16 * b_);
    numbers.assign(numbers_.begin() + start_[square], numbers_.begin() + start_[square + 1]);
    return;
  }
  const double side = 8 * faces_.voxel_m_;
  const Window squares = faces_.dem_->squares_near(i8 * side, j8 * side, (i8 + 1) * side, (j8 + 1) * side);
  const std::size_t across = index(faces_.dem_->cols() - 1);
  for (int row = squares.row; row < squares.row_end(); ++row) {
    for (int col = squares.col; col < squares.col_end(); ++col) {
      const auto first = static_cast<std::uint32_t>(2 * (index(row) * across + index(col)));
      numbers.push_back(first);
      numbers.push_back(first + 1);
    }
  }
}

}  // namespace sightbound
