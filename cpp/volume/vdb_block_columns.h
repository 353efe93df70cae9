// SPDX-License-Identifier: GPL-3.0-or-later
// What lies in each column of 8 x 8 voxels, layer by layer, in a few bytes: most leaves that a line passes
// need not be read. Private to cpp/volume.
//
// Columns are kept in squares of 4 x 4. The 16 numbers of a square's layer lie side by side: what a line that
// is not steep passes within the square is one or two lines of the cache. So do the leaves' places: the way
// down the tree would be three waits for memory each. Memory: 12 bytes a square, 144 a layer between its
// lowest and its highest leaf (a leaf has 2 KiB). Cost: one pass over the leaves. The tree must stay as it
// is.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "base/parallel.h"
#include "terrain/grid.h"
#include "volume/vdb.h"

namespace sightbound {

class BlockColumns {
 public:
  static constexpr int kAcross = 4;                   // columns of 8 in a square
  static constexpr int kColumns = kAcross * kAcross;  // of a square
  static constexpr int kSquares = 4;                  // across a column of 128
  static constexpr int kLayers = 8;                   // of a leaf

  static constexpr int kEmpty = std::numeric_limits<int>::min() / 2;      // nothing but background
  static constexpr int kIrregular = std::numeric_limits<int>::max() / 2;  // always ask the tree

  struct Square {
    int first = kEmpty;  // lowest layer told of, in voxels; below it the tree must be asked
    int layers = 0;      // above them all is background
    std::uint32_t offset = 0;
    int end() const { return first + layers; }
    bool is_told(int from) const { return from >= first; }
    bool tells(int layer) const { return layer >= first && layer < end(); }  // and there are leaves
    bool is_irregular() const { return first == kIrregular; }
  };
  BlockColumns(const RatioTree&, const Workers&);

  // Square (i32, j32) of 32 x 32 voxels.
  const Square& square(int i32, int j32) const {
    const int i = i32 - first_i32_, j = j32 - first_j32_;
    if (i < 0 || j < 0 || i >= cols_ || j >= rows_) return beyond_;
    return squares_[static_cast<std::size_t>(j) * static_cast<std::size_t>(cols_) +
                    static_cast<std::size_t>(i)];
  }
  // Where column (i8, j8) stands in its square.
  static int slot(int i8, int j8) { return (j8 & (kAcross - 1)) * kAcross + (i8 & (kAcross - 1)); }
  // pack(smallest low, smallest high) of the voxels of a layer that is told of, for each column of the
  // square; the next layer's follow.
  const std::int32_t* least(const Square& square, int layer) const { return of(least_, square, layer); }
  // pack(largest low, largest high).
  const std::int32_t* largest(const Square& square, int layer) const { return of(largest_, square, layer); }
  // The values of the leaf that holds a layer that is told of, in the tree's order, for each column of the
  // square; null = a tile, of which least() is the value.
  const std::int32_t* const* leaf(const Square& square, int layer) const {
    return leaves_.row((static_cast<int>(square.offset) + layer - square.first) / kLayers);
  }
  // To be read soon.
  void prefetch(const Square& square, int layer) const {
#if defined(__GNUC__)
    if (layer >= square.first && layer < square.end()) {
      __builtin_prefetch(least(square, layer));
      __builtin_prefetch(leaf(square, layer));
      __builtin_prefetch(leaf(square, layer) + kColumns / 2);
    }
#endif
  }
  // Above this layer there is nothing but background in the column of 128 x 128.
  int end_128(int i128, int j128) const {
    const int i = i128 - first_i32_ / kSquares, j = j128 - first_j32_ / kSquares;
    if (i < 0 || j < 0 || i >= cols_ / kSquares || j >= rows_ / kSquares) return beyond_.end();
    return ends_128_[static_cast<std::size_t>(j) * static_cast<std::size_t>(cols_ / kSquares) +
                     static_cast<std::size_t>(i)];
  }

 private:
  static const std::int32_t* of(const Grid<std::int32_t>& values, const Square& square, int layer) {
    return values.row(static_cast<int>(square.offset) + layer - square.first);
  }
  void find_layers(const std::vector<const RatioNode128*>& nodes, std::int32_t background);
  void mind_large_tiles(const RatioTree&);
  void lay_out();
  void fill_row(const RatioTree&, int row);

  int first_i32_ = 0, first_j32_ = 0, cols_ = 0, rows_ = 0;
  Square beyond_;  // of all columns without nodes
  std::vector<Square> squares_;
  Grid<std::int32_t> least_, largest_;  // a row each layer of each square
  Grid<const std::int32_t*> leaves_;    // a row every eight
  std::vector<int> ends_128_;
};

}  // namespace sightbound
