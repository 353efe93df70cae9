// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/vdb_block_columns.h"

#include <algorithm>
#include <array>

#include "volume/vdb_block.h"

namespace sightbound {

namespace {

constexpr int kLeaf = BlockColumns::kLayers, kSquare = kLeaf * BlockColumns::kAcross;

// The smallest low and high of every layer of a leaf, and the largest.
struct LeafLayers {
  std::array<std::int32_t, kLeaf> least, largest;
};

LeafLayers layers_of(const RatioLeaf& leaf) {
  std::array<std::int16_t, kLeaf> least_low, least_high, largest_low, largest_high;
  for (auto* least : {&least_low, &least_high}) least->fill(std::numeric_limits<std::int16_t>::max());
  for (auto* largest : {&largest_low, &largest_high}) largest->fill(std::numeric_limits<std::int16_t>::min());
  const std::int32_t* values = leaf.buffer().data();
  for (int column = 0; column < kLeaf * kLeaf; ++column, values += kLeaf) {
    for (std::size_t k = 0; k < kLeaf; ++k) {
      const auto low = static_cast<std::int16_t>(ordered_low(values[k]));
      const auto high = static_cast<std::int16_t>(ordered_high(values[k]));
      least_low[k] = std::min(least_low[k], low);
      least_high[k] = std::min(least_high[k], high);
      largest_low[k] = std::max(largest_low[k], low);
      largest_high[k] = std::max(largest_high[k], high);
    }
  }
  const auto packed = [](std::int16_t low, std::int16_t high) {
    return pack(static_cast<double>(from_ordered(low)), static_cast<double>(from_ordered(high)));
  };
  LeafLayers layers;
  for (std::size_t k = 0; k < kLeaf; ++k) {
    layers.least[k] = packed(least_low[k], least_high[k]);
    layers.largest[k] = packed(largest_low[k], largest_high[k]);
  }
  return layers;
}

LeafLayers layers_of(std::int32_t tile) {
  LeafLayers layers;
  layers.least.fill(tile);
  layers.largest.fill(tile);
  return layers;
}

}  // namespace

BlockColumns::BlockColumns(const RatioTree& tree, const Workers& workers) {
  std::vector<const RatioNode128*> nodes;
  tree.getNodes(nodes);
  find_layers(nodes, tree.background());
  mind_large_tiles(tree);
  lay_out();
  workers.for_each(static_cast<std::size_t>(rows_),
                   [&](std::size_t row) { fill_row(tree, static_cast<int>(row)); });
}

// From the lowest leaf of each square to its highest leaf or tile.
void BlockColumns::find_layers(const std::vector<const RatioNode128*>& nodes, std::int32_t background) {
  if (nodes.empty()) return;
  openvdb::CoordBBox plan;
  for (const RatioNode128* node : nodes) plan.expand(node->origin());
  first_i32_ = plan.min().x() / kSquare, first_j32_ = plan.min().y() / kSquare;
  cols_ = (plan.max().x() - plan.min().x()) / kSquare + kSquares;
  rows_ = (plan.max().y() - plan.min().y()) / kSquare + kSquares;
  const std::size_t count = static_cast<std::size_t>(cols_) * static_cast<std::size_t>(rows_);
  squares_.assign(count, Square{});

  std::vector<int> lowest(count, kIrregular), highest(count, kEmpty);
  for (const RatioNode128* node : nodes) {
    for (openvdb::Index n = 0; n < RatioNode128::NUM_VALUES; ++n) {
      const bool is_leaf = node->isChildMaskOn(n);
      if (!is_leaf && node->getTable()[n].getValue() == background) continue;
      const openvdb::Coord origin = node->offsetToGlobalCoord(n);
      const auto at = static_cast<std::size_t>(((origin.y() >> 5) - first_j32_) * cols_ +
                                               ((origin.x() >> 5) - first_i32_));
      if (is_leaf) lowest[at] = std::min(lowest[at], origin.z());
      highest[at] = std::max(highest[at], origin.z() + kLeaf);
    }
  }
  for (std::size_t n = 0; n < count; ++n) {
    if (highest[n] == kEmpty) continue;
    squares_[n].first = lowest[n];  // kIrregular where there are tiles alone
    if (lowest[n] != kIrregular) squares_[n].layers = highest[n] - lowest[n];
  }
}

// Tiles of 128 and 4096: below the leaves the tree is asked anyway.
void BlockColumns::mind_large_tiles(const RatioTree& tree) {
  auto tile = tree.cbeginValueAll();
  tile.setMaxDepth(1);
  for (; tile; ++tile) {
    if (*tile == tree.background()) continue;
    openvdb::CoordBBox box;
    tile.getBoundingBox(box);
    const int i0 = box.min().x() / kSquare - first_i32_, i1 = (box.max().x() + 1) / kSquare - first_i32_;
    const int j0 = box.min().y() / kSquare - first_j32_, j1 = (box.max().y() + 1) / kSquare - first_j32_;
    if (i0 < 0 || j0 < 0 || i1 > cols_ || j1 > rows_) beyond_.first = kIrregular;
    for (int j = std::max(j0, 0); j < std::min(j1, rows_); ++j) {
      for (int i = std::max(i0, 0); i < std::min(i1, cols_); ++i) {
        Square& square = squares_[static_cast<std::size_t>(j * cols_ + i)];
        if (square.first == kEmpty || square.end() <= box.max().z()) square = {kIrregular, 0, 0};
      }
    }
  }
}

void BlockColumns::lay_out() {
  std::size_t layers = 0;
  const int wide = cols_ / kSquares;
  ends_128_.assign(squares_.size() / (kSquares * kSquares), kEmpty);
  for (std::size_t n = 0; n < squares_.size(); ++n) {
    Square& square = squares_[n];
    square.offset = static_cast<std::uint32_t>(layers);
    layers += static_cast<std::size_t>(square.layers);
    const int i = static_cast<int>(n) % cols_, j = static_cast<int>(n) / cols_;
    int& end = ends_128_[static_cast<std::size_t>(j / kSquares * wide + i / kSquares)];
    end = std::max(end, square.end());
  }
  for (Grid<std::int32_t>* values : {&least_, &largest_})
    *values = Grid<std::int32_t>(static_cast<int>(layers), kColumns);
  leaves_ = Grid<const std::int32_t*>(static_cast<int>(layers) / kLayers, kColumns);
}

// One row of squares.
void BlockColumns::fill_row(const RatioTree& tree, int row) {
  const openvdb::tree::ValueAccessor<const RatioTree, false> access(tree);
  for (int col = 0; col < cols_; ++col) {
    const Square& square = squares_[static_cast<std::size_t>(row * cols_ + col)];
    for (int slot = 0; slot < kColumns; ++slot) {
      const int i = (first_i32_ + col) * kSquare + slot % kAcross * kLeaf,
                j = (first_j32_ + row) * kSquare + slot / kAcross * kLeaf;
      for (int k = square.first; k < square.end(); k += kLeaf) {
        const RatioLeaf* leaf = access.probeConstLeaf({i, j, k});
        const int row_of_leaf = (static_cast<int>(square.offset) + k - square.first) / kLayers;
        leaves_.at(row_of_leaf, slot) = leaf != nullptr ? leaf->buffer().data() : nullptr;
        const LeafLayers layers = leaf != nullptr ? layers_of(*leaf) : layers_of(access.getValue({i, j, k}));
        for (std::size_t n = 0; n < kLeaf; ++n) {
          const int at = static_cast<int>(square.offset) + k - square.first + static_cast<int>(n);
          least_.at(at, slot) = layers.least[n];
          largest_.at(at, slot) = layers.largest[n];
        }
      }
    }
  }
}

}  // namespace sightbound
