// SPDX-License-Identifier: GPL-3.0-or-later
// What lies in each column of 8 x 8 voxels, layer by layer, in a few bytes: most leaves that a line passes
// need not be read. Private to cpp/volume.
//
// Memory: 16 bytes a column, 8 a layer that has leaves (a leaf has 2 KiB). Cost: one pass over the leaves.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "base/parallel.h"
#include "volume/vdb.h"

namespace sightbound {

class BlockColumns {
 public:
  static constexpr int kAcross32 = 4, kAcross128 = 16;  // columns of 8 in one of 32, of 128

  struct Column {
    int first = kEmpty;  // lowest layer told of, in voxels; below it the tree must be asked
    int layers = 0;      // above them all is background
    std::uint32_t offset = 0;
    int end() const { return first + layers; }
    bool is_told(int from) const { return from >= first; }
  };
  static constexpr int kEmpty = std::numeric_limits<int>::min() / 2;      // nothing but background
  static constexpr int kIrregular = std::numeric_limits<int>::max() / 2;  // always ask the tree

  BlockColumns(const RatioTree&, const Workers&);

  // Column (i8, j8) of 8 x 8 voxels.
  const Column& of(int i8, int j8) const {
    const int i = i8 - first_i8_, j = j8 - first_j8_;
    if (i < 0 || j < 0 || i >= cols_ || j >= rows_) return beyond_;
    return columns_[static_cast<std::size_t>(j) * static_cast<std::size_t>(cols_) +
                    static_cast<std::size_t>(i)];
  }
  // pack(smallest low, smallest high) of the 64 voxels of layer `first` + n.
  const std::int32_t* layers(const Column& column) const { return layers_.data() + column.offset; }
  // pack(largest low, largest high).
  const std::int32_t* largest(const Column& column) const { return largest_.data() + column.offset; }
  // Above this layer there is nothing but background in the column of 32 x 32, of 128 x 128.
  int end_32(int i32, int j32) const { return end_of<kAcross32>(ends_32_, i32, j32); }
  int end_128(int i128, int j128) const { return end_of<kAcross128>(ends_128_, i128, j128); }

 private:
  Column& at(int i8, int j8) {
    return columns_[static_cast<std::size_t>(j8 - first_j8_) * static_cast<std::size_t>(cols_) +
                    static_cast<std::size_t>(i8 - first_i8_)];
  }
  template <int kAcross>
  int end_of(const std::vector<int>& ends, int i_large, int j_large) const {
    const int i = i_large - first_i8_ / kAcross, j = j_large - first_j8_ / kAcross;
    if (i < 0 || j < 0 || i >= cols_ / kAcross || j >= rows_ / kAcross) return beyond_.end();
    return ends[static_cast<std::size_t>(j) * static_cast<std::size_t>(cols_ / kAcross) +
                static_cast<std::size_t>(i)];
  }
  std::vector<int> ends_of(int across) const;
  void find_layers(const std::vector<const RatioNode128*>& nodes, std::int32_t background);
  void mind_large_tiles(const RatioTree&);
  void lay_out(std::int32_t background);
  void fill(const RatioNode128& node, std::int32_t background);

  int first_i8_ = 0, first_j8_ = 0, cols_ = 0, rows_ = 0;
  Column beyond_;  // of all columns without nodes
  std::vector<Column> columns_;
  std::vector<std::int32_t> layers_, largest_;
  std::vector<int> ends_32_, ends_128_;
};

}  // namespace sightbound
