// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/vdb_block_columns.h"

#include <algorithm>
#include <array>

#include "volume/vdb_block.h"

namespace sightbound {

namespace {

constexpr int kLeaf = 8;

// The smallest low and the smallest high of every layer of a leaf.
std::array<std::int32_t, kLeaf> least_of_layers(const RatioLeaf& leaf) {
  std::array<std::int16_t, kLeaf> low, high;
  low.fill(std::numeric_limits<std::int16_t>::max());
  high.fill(std::numeric_limits<std::int16_t>::max());
  const std::int32_t* values = leaf.buffer().data();
  for (int column = 0; column < kLeaf * kLeaf; ++column, values += kLeaf) {
    for (std::size_t k = 0; k < kLeaf; ++k) {
      low[k] = std::min(low[k], static_cast<std::int16_t>(ordered_low(values[k])));
      high[k] = std::min(high[k], static_cast<std::int16_t>(ordered_high(values[k])));
    }
  }
  std::array<std::int32_t, kLeaf> least;
  for (std::size_t k = 0; k < kLeaf; ++k) {
    least[k] = pack(static_cast<double>(from_ordered(low[k])), static_cast<double>(from_ordered(high[k])));
  }
  return least;
}

}  // namespace

BlockColumns::BlockColumns(const RatioTree& tree, const Workers& workers) {
  std::vector<const RatioNode128*> nodes;
  tree.getNodes(nodes);
  find_layers(nodes, tree.background());
  mind_large_tiles(tree);
  lay_out(tree.background());
  workers.for_each(nodes.size(), [&](std::size_t n) { fill(*nodes[n], tree.background()); });
}

// From the lowest leaf of each column to its highest leaf or tile.
void BlockColumns::find_layers(const std::vector<const RatioNode128*>& nodes, std::int32_t background) {
  if (nodes.empty()) return;
  openvdb::CoordBBox plan;
  for (const RatioNode128* node : nodes) plan.expand(node->origin());
  first_i8_ = plan.min().x() / kLeaf, first_j8_ = plan.min().y() / kLeaf;
  cols_ = (plan.max().x() - plan.min().x()) / kLeaf + kAcross;
  rows_ = (plan.max().y() - plan.min().y()) / kLeaf + kAcross;
  columns_.assign(static_cast<std::size_t>(cols_) * static_cast<std::size_t>(rows_), Column{});

  std::vector<const RatioNode128*> upwards = nodes;
  std::sort(upwards.begin(), upwards.end(),
            [](const auto* a, const auto* b) { return a->origin().z() < b->origin().z(); });
  for (const RatioNode128* node : upwards) {
    for (openvdb::Index n = 0; n < RatioNode128::NUM_VALUES; ++n) {
      const bool is_leaf = node->isChildMaskOn(n);
      if (!is_leaf && node->getTable()[n].getValue() == background) continue;
      const openvdb::Coord origin = node->offsetToGlobalCoord(n);
      Column& column = at(origin.x() >> 3, origin.y() >> 3);
      const bool begun = column.first != kEmpty && column.first != kIrregular;
      if (!begun) column.first = is_leaf ? origin.z() : kIrregular;
      if (begun || is_leaf) column.layers = origin.z() + kLeaf - column.first;
    }
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
    const int i0 = box.min().x() / kLeaf - first_i8_, i1 = (box.max().x() + 1) / kLeaf - first_i8_;
    const int j0 = box.min().y() / kLeaf - first_j8_, j1 = (box.max().y() + 1) / kLeaf - first_j8_;
    if (i0 < 0 || j0 < 0 || i1 > cols_ || j1 > rows_) beyond_.first = kIrregular;
    for (int j = std::max(j0, 0); j < std::min(j1, rows_); ++j) {
      for (int i = std::max(i0, 0); i < std::min(i1, cols_); ++i) {
        Column& column = at(first_i8_ + i, first_j8_ + j);
        if (column.first == kEmpty || column.first <= box.max().z()) column = {kIrregular, 0, 0};
      }
    }
  }
}

void BlockColumns::lay_out(std::int32_t background) {
  std::size_t layers = 0;
  ends_128_.assign(columns_.size() / (kAcross * kAcross), kEmpty);
  for (int j = 0; j < rows_; ++j) {
    for (int i = 0; i < cols_; ++i) {
      Column& column = at(first_i8_ + i, first_j8_ + j);
      column.offset = static_cast<std::uint32_t>(layers);
      layers += static_cast<std::size_t>(column.layers);
      int& end = ends_128_[static_cast<std::size_t>(j / kAcross) * static_cast<std::size_t>(cols_ / kAcross) +
                           static_cast<std::size_t>(i / kAcross)];
      end = std::max(end, column.end());
    }
  }
  layers_.assign(layers, background);
}

void BlockColumns::fill(const RatioNode128& node, std::int32_t background) {
  for (openvdb::Index n = 0; n < RatioNode128::NUM_VALUES; ++n) {
    const bool is_leaf = node.isChildMaskOn(n);
    if (!is_leaf && node.getTable()[n].getValue() == background) continue;
    const openvdb::Coord origin = node.offsetToGlobalCoord(n);
    const Column& column = at(origin.x() >> 3, origin.y() >> 3);
    if (origin.z() < column.first) continue;
    std::int32_t* layers = layers_.data() + column.offset + (origin.z() - column.first);
    if (is_leaf) {
      const auto least = least_of_layers(*node.getTable()[n].getChild());
      std::copy(least.begin(), least.end(), layers);
    } else {
      std::fill_n(layers, kLeaf, node.getTable()[n].getValue());
    }
  }
}

}  // namespace sightbound
