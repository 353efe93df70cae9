// SPDX-License-Identifier: GPL-3.0-or-later
// A raster in memory, and windows of one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>

#include "base/big_memory.h"

namespace sightbound {

// Half-open: columns [col, col + cols), rows [row, row + rows).
struct Window {
  int col = 0, row = 0, cols = 0, rows = 0;

  int col_end() const { return col + cols; }
  int row_end() const { return row + rows; }
  bool empty() const { return cols <= 0 || rows <= 0; }
  std::size_t cells() const {
    return empty() ? 0 : static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows);
  }
  bool contains(const Window& w) const {
    return w.col >= col && w.row >= row && w.col_end() <= col_end() && w.row_end() <= row_end();
  }
  friend bool operator==(const Window&, const Window&) = default;
};

inline Window intersection(const Window& a, const Window& b) {
  Window w;
  w.col = std::max(a.col, b.col);
  w.row = std::max(a.row, b.row);
  w.cols = std::max(0, std::min(a.col_end(), b.col_end()) - w.col);
  w.rows = std::max(0, std::min(a.row_end(), b.row_end()) - w.row);
  return w;
}

// Smallest window that holds both; an empty one counts for nothing.
inline Window bounding(const Window& a, const Window& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  Window w;
  w.col = std::min(a.col, b.col);
  w.row = std::min(a.row, b.row);
  w.cols = std::max(a.col_end(), b.col_end()) - w.col;
  w.rows = std::max(a.row_end(), b.row_end()) - w.row;
  return w;
}

// Row-major cells, owned; moved, never copied by accident. Values are not initialised unless a fill is given.
template <class T>
class Grid {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  Grid() = default;
  Grid(int rows, int cols)
      : rows_(rows), cols_(cols), data_(static_cast<T*>(allocate_big(size() * sizeof(T)))) {}
  Grid(int rows, int cols, T fill) : Grid(rows, cols) { std::fill_n(data_.get(), size(), fill); }

  // All 0. Costs nothing until cells are written (big_memory.h).
  static Grid zeros(int rows, int cols) {
    Grid grid;
    grid.rows_ = rows, grid.cols_ = cols;
    grid.data_.reset(static_cast<T*>(allocate_big_zeroed(grid.size() * sizeof(T))));
    return grid;
  }

  int rows() const { return rows_; }
  int cols() const { return cols_; }
  std::size_t size() const { return static_cast<std::size_t>(rows_) * static_cast<std::size_t>(cols_); }
  bool empty() const { return size() == 0; }

  T* row(int r) { return data_.get() + offset(r); }
  const T* row(int r) const { return data_.get() + offset(r); }
  T& at(int r, int c) { return row(r)[c]; }
  const T& at(int r, int c) const { return row(r)[c]; }
  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }
  std::span<T> values() { return {data_.get(), size()}; }
  std::span<const T> values() const { return {data_.get(), size()}; }

  // First row last. O(cells), in place.
  void flip_rows() {
    for (int top = 0, bottom = rows_ - 1; top < bottom; ++top, --bottom) {
      std::swap_ranges(row(top), row(top) + cols_, row(bottom));
    }
  }

 private:
  std::size_t offset(int r) const { return static_cast<std::size_t>(r) * static_cast<std::size_t>(cols_); }

  int rows_ = 0, cols_ = 0;
  struct Release {
    void operator()(T* data) const { release_big(data); }
  };
  std::unique_ptr<T[], Release> data_;
};

}  // namespace sightbound
