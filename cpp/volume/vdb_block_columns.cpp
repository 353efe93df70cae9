// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/vdb_block_columns.h"

#include <algorithm>
#include <array>

#include "volume/vdb_block.h"

namespace sightbound {

namespace {

constexpr int kLeaf = 8;

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
  cols_ = (plan.max().x() - plan.min().x()) / kLeaf + kAcross128;
  rows_ = (plan.max().y() - plan.min().y()) / kLeaf + kAcross128;
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
  for (Column& column : columns_) {
    column.offset = static_cast<std::uint32_t>(layers);
    layers += static_cast<std::size_t>(column.layers);
  }
  layers_.assign(layers, background);
  largest_.assign(layers, background);
  ends_32_ = ends_of(kAcross32);
  ends_128_ = ends_of(kAcross128);
}

// The highest end in every square of `across` columns of 8.
std::vector<int> BlockColumns::ends_of(int across) const {
  const auto wide = static_cast<std::size_t>(cols_ / across), cols = static_cast<std::size_t>(cols_);
  std::vector<int> ends(wide * static_cast<std::size_t>(rows_ / across), kEmpty);
  for (std::size_t n = 0; n < columns_.size(); ++n) {
    const std::size_t i = n % cols / static_cast<std::size_t>(across),
                      j = n / cols / static_cast<std::size_t>(across);
    ends[j * wide + i] = std::max(ends[j * wide + i], columns_[n].end());
  }
  return ends;
}

void BlockColumns::fill(const RatioNode128& node, std::int32_t background) {
  for (openvdb::Index n = 0; n < RatioNode128::NUM_VALUES; ++n) {
    const bool is_leaf = node.isChildMaskOn(n);
    if (!is_leaf && node.getTable()[n].getValue() == background) continue;
    const openvdb::Coord origin = node.offsetToGlobalCoord(n);
    const Column& column = at(origin.x() >> 3, origin.y() >> 3);
    if (origin.z() < column.first) continue;
    const std::size_t at = column.offset + static_cast<std::size_t>(origin.z() - column.first);
    if (is_leaf) {
      const LeafLayers layers = layers_of(*node.getTable()[n].getChild());
      std::copy(layers.least.begin(), layers.least.end(), layers_.data() + at);
      std::copy(layers.largest.begin(), layers.largest.end(), largest_.data() + at);
    } else {
      const std::int32_t value = node.getTable()[n].getValue();
      std::fill_n(layers_.data() + at, kLeaf, value);
      std::fill_n(largest_.data() + at, kLeaf, value);
    }
  }
}

}  // namespace sightbound
