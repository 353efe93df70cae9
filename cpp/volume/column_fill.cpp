// SPDX-License-Identifier: GPL-3.0-or-later
// Every face over a column gives the corners of their overlay (column_overlay.h); the column's bounds of k
// are those of all its corners together. 128 x 128 columns are one piece of work, 8 x 8 of them stand above
// one another in the same leaves.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "volume/column_faces.h"
#include "volume/leaf_columns.h"
#include "volume/vdb_block.h"
#include "volume/vdb_fill.h"

namespace sightbound {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Where |k| <= ratio: the reach of the terrain's volume over a column.
struct Reach {
  double bottom = kInfinity, top = -kInfinity;              // touched by it
  double inner_bottom = -kInfinity, inner_top = kInfinity;  // wholly in it, whatever the place

  void add(const OverlayCorner& corner, double ratio) {
    bottom = std::min(bottom, corner.height - ratio * corner.sigma_high);
    top = std::max(top, corner.height + ratio * corner.sigma_high);
    inner_bottom = std::max(inner_bottom, corner.height - ratio * corner.sigma_low);
    inner_top = std::min(inner_top, corner.height + ratio * corner.sigma_low);
  }
  bool any() const { return bottom <= top; }
  // Voxels [first, last] that touch it, and that lie wholly in it.
  std::array<int, 2> touched(double height) const {
    return {static_cast<int>(std::ceil((bottom - kHeightSlack) / height)) - 1,
            static_cast<int>(std::floor((top + kHeightSlack) / height))};
  }
  std::array<int, 2> held(double height) const {
    return {static_cast<int>(std::ceil((inner_bottom + kHeightSlack) / height)),
            static_cast<int>(std::floor((inner_top - kHeightSlack) / height)) - 1};
  }
};

// The reach of each of 64 columns.
struct LeafReach {
  explicit LeafReach(double quantile) : ratio(quantile) {}

  void clear() { of.fill({}); }
  void operator()(std::size_t column, const OverlayCorner& corner) { of[column].add(corner, ratio); }
  void operator()(const LatticePoints& lattice) {
    std::array<double, 81> low, high;
    for (std::size_t n = 0; n < 81; ++n) {
      low[n] = lattice.height[n] - ratio * lattice.sigma[n];
      high[n] = lattice.height[n] + ratio * lattice.sigma[n];
    }
    for (std::size_t c = 0; c < kColumns; ++c) {
      const std::size_t n = 9 * (c / 8) + c % 8;
      Reach& reach = of[c];
      reach.bottom =
          std::min(reach.bottom, std::min(std::min(low[n], low[n + 1]), std::min(low[n + 9], low[n + 10])));
      reach.inner_bottom = std::max(
          reach.inner_bottom, std::max(std::max(low[n], low[n + 1]), std::max(low[n + 9], low[n + 10])));
      reach.top =
          std::max(reach.top, std::max(std::max(high[n], high[n + 1]), std::max(high[n + 9], high[n + 10])));
      reach.inner_top = std::min(
          reach.inner_top, std::min(std::min(high[n], high[n + 1]), std::min(high[n + 9], high[n + 10])));
    }
  }

  double ratio;
  std::array<Reach, kColumns> of;
};

// Bits of the leaf rows k in [first, last] of a column, in the leaf that begins at k0.
std::uint64_t rows_of(const std::array<int, 2>& range, int k0) {
  const int from = std::max(range[0] - k0, 0), to = std::min(range[1] - k0, 7);
  return from > to ? 0 : (0xffull >> (7 - to + from)) << from;
}

// Adds the leaves of 64 columns with the ranges of k that are set.
void add_columns(const std::array<std::array<int, 2>, kColumns>& ranges, int i8, int j8,
                 NodeStack<BitTree>& stack) {
  int first = std::numeric_limits<int>::max(), last = std::numeric_limits<int>::min();
  for (const auto& range : ranges) {
    if (range[0] > range[1]) continue;
    first = std::min(first, range[0]);
    last = std::max(last, range[1]);
  }
  if (first > last) return;
  for (int k8 = floor_div(first, 8); k8 <= floor_div(last, 8); ++k8) {
    std::array<std::uint64_t, 8> words{};
    bool any = false, all = true;
    for (std::size_t i = 0; i < 8; ++i) {
      for (std::size_t j = 0; j < 8; ++j) words[i] |= rows_of(ranges[8 * i + j], 8 * k8) << (8 * j);
      any = any || words[i] != 0;
      all = all && ~words[i] == 0;
    }
    if (!any) continue;
    const openvdb::Coord origin(8 * i8, 8 * j8, 8 * k8);
    if (all) {
      stack.add_tile(origin, true, true);
      continue;
    }
    auto leaf = std::make_unique<BitTree::LeafNodeType>(origin, false, false);
    BitTree::LeafNodeType::NodeMaskType mask;
    for (std::size_t i = 0; i < 8; ++i)
      mask.getWord<std::uint64_t>(static_cast<openvdb::Index>(i)) = words[i];
    leaf->setValueMask(mask);
    stack.add(std::move(leaf));
  }
}

constexpr std::array<int, 2> kNothing{1, 0};

// The bounds of k over a column, from its corners.
class ColumnRatios {
 public:
  void clear() { steps_.clear(); }
  void add(const OverlayCorner& corner) {
    steps_.push_back({corner.height, 1 / corner.sigma_low, 1 / corner.sigma_high});
  }
  // Over the voxel between two heights. The slack covers the rounding of what is computed here and in the
  // corners.
  void bounds(double bottom, double top, double& low, double& high) const {
    low = kInfinity;
    high = -kInfinity;
    for (const Step& step : steps_) {
      const double below = bottom - kHeightSlack - step.height, above = top + kHeightSlack - step.height;
      low = std::min(low, below * (below > 0 ? step.per_high : step.per_low));
      high = std::max(high, above * (above > 0 ? step.per_low : step.per_high));
    }
  }

 private:
  struct Step {
    double height, per_low, per_high;
  };
  std::vector<Step> steps_;
};

// One column of leaves.
class RatioFiller {
 public:
  RatioFiller(const VoxelSize& size, double largest_ratio)
      : size_(size),
        ratio_(largest_ratio),
        beyond_(static_cast<double>(beyond(largest_ratio))),
        outside_(pack(beyond_, beyond_)),
        inside_(pack(-beyond_, -beyond_)) {}

  std::int32_t inside() const { return inside_; }
  std::int32_t outside() const { return outside_; }

  void clear() {
    reach_.fill({});
    for (auto& corners : corners_) corners.clear();
  }
  void operator()(std::size_t column, const OverlayCorner& corner) {
    reach_[column].add(corner, ratio_);
    corners_[column].push_back(corner);
  }
  void operator()(const LatticePoints& lattice) {
    for (std::size_t c = 0; c < kColumns; ++c) {
      for (const std::size_t n : {9 * (c / 8) + c % 8, 9 * (c / 8) + c % 8 + 1, 9 * (c / 8) + c % 8 + 9,
                                  9 * (c / 8) + c % 8 + 10}) {
        (*this)(c, {lattice.height[n], lattice.sigma[n], lattice.sigma[n]});
      }
    }
  }

  // Adds the leaves of the band; returns the k / 8 of the lowest, or INT_MAX when there is none.
  int fill(int i8, int j8, NodeStack<RatioTree>& stack) {
    std::array<std::array<int, 2>, kColumns> ranges;
    int first = std::numeric_limits<int>::max(), last = std::numeric_limits<int>::min();
    for (std::size_t c = 0; c < kColumns; ++c) {
      ranges[c] = kNothing;
      if (!reach_[c].any()) continue;
      ranges[c] = reach_[c].touched(size_.height);
      first = std::min(first, ranges[c][0]);
      last = std::max(last, ranges[c][1]);
    }
    if (first > last) return std::numeric_limits<int>::max();
    const int k8_first = floor_div(first, 8), k8_last = floor_div(last, 8);
    std::vector<std::unique_ptr<RatioLeaf>> leaves;
    for (int k8 = k8_first; k8 <= k8_last; ++k8) {
      leaves.push_back(std::make_unique<RatioLeaf>(openvdb::Coord(8 * i8, 8 * j8, 8 * k8), outside_, false));
    }
    for (std::size_t c = 0; c < kColumns; ++c) {
      if (!reach_[c].any()) continue;
      steps_.clear();
      for (const OverlayCorner& corner : corners_[c]) steps_.add(corner);
      for (int k = 8 * k8_first; k <= ranges[c][1]; ++k) {
        RatioLeaf& leaf = *leaves[static_cast<std::size_t>(floor_div(k, 8) - k8_first)];
        const auto at = static_cast<openvdb::Index>(8 * c + static_cast<std::size_t>(k - leaf.origin().z()));
        if (k < ranges[c][0]) {
          leaf.setValueOff(at, inside_);
          continue;
        }
        double low, high;
        steps_.bounds(k * size_.height, (k + 1) * size_.height, low, high);
        leaf.setValueOn(at, pack(std::clamp(low, -beyond_, beyond_), std::clamp(high, -beyond_, beyond_)));
      }
    }
    for (auto& leaf : leaves)
      stack.add(std::move(leaf));  // none is uniform: each has band, or inside and outside
    return k8_first;
  }

 private:
  VoxelSize size_;
  double ratio_, beyond_;
  std::int32_t outside_, inside_;
  std::array<Reach, kColumns> reach_;
  std::array<std::vector<OverlayCorner>, kColumns> corners_;
  ColumnRatios steps_;
};

}  // namespace

PlanMask fill_ratios(const Surface& surface, const VoxelSize& size, double largest_ratio, RatioTree& ratios,
                     const Workers& workers, Progress& progress) {
  const ColumnFaces faces(surface, size.side);
  const std::int32_t outside = RatioFiller(size, largest_ratio).outside(),
                     inside = RatioFiller(size, largest_ratio).inside();
  PlanMask unknown(faces.cols(), faces.rows(), true);
  const int across = faces.blocks_across(), down = faces.blocks_down();
  const std::size_t blocks = static_cast<std::size_t>(across) * static_cast<std::size_t>(down);
  std::vector<NodeStack<RatioTree>> stacks(blocks);
  std::vector<int> lowest(blocks, std::numeric_limits<int>::max());  // k / 128 of the lowest node
  workers.for_each(blocks, [&](std::size_t n) {
    progress.check();
    const int a = static_cast<int>(n) % across, b = static_cast<int>(n) / across;
    const ColumnFaces::Block block(faces, a, b);
    stacks[n] = NodeStack<RatioTree>(a, b, outside);
    RatioFiller filler(size, largest_ratio);
    LeafColumns columns(surface, faces, block);
    std::array<int, 256> first;
    for (int square = 0; square < 256; ++square) {
      const int i8 = 16 * a + square / 16, j8 = 16 * b + square % 16;
      first[static_cast<std::size_t>(square)] = std::numeric_limits<int>::max();
      if (8 * i8 >= faces.cols() || 8 * j8 >= faces.rows()) continue;
      columns.visit(i8, j8, filler);
      unknown.set_8(i8, j8, columns.unknown());
      first[static_cast<std::size_t>(square)] = filler.fill(i8, j8, stacks[n]);
    }
    if (!stacks[n].nodes().empty()) lowest[n] = stacks[n].nodes().begin()->first;
    for (int square = 0; square < 256; ++square) {
      const int k8 = first[static_cast<std::size_t>(square)];
      if (k8 == std::numeric_limits<int>::max()) continue;
      for (int below = 16 * lowest[n]; below < k8; ++below) {
        stacks[n].add_tile({128 * a + 8 * (square / 16), 128 * b + 8 * (square % 16), 8 * below}, inside,
                           false);
      }
    }
    progress.advance(1.0 / static_cast<double>(blocks));
  });
  unknown.summarise();
  put_together(stacks, ratios);

  // Below the lowest node of each block all is inside, down to the end of the tree's lowest nodes and one
  // more.
  const int bottom = *std::min_element(lowest.begin(), lowest.end());
  if (bottom == std::numeric_limits<int>::max()) return unknown;
  const int end = 32 * floor_div(bottom, 32);
  for (int b = 0; b < down; ++b) {
    for (int a = 0; a < across; ++a) {
      const int from = lowest[static_cast<std::size_t>(b) * static_cast<std::size_t>(across) +
                              static_cast<std::size_t>(a)];
      if (from == std::numeric_limits<int>::max()) continue;
      for (int level = end; level < from; ++level)
        ratios.addTile(2, {128 * a, 128 * b, 128 * level}, inside, false);
    }
  }
  for (int b = 0; b < down; b += 32) {
    for (int a = 0; a < across; a += 32)
      ratios.root().addTile({128 * a, 128 * b, 128 * (end - 32)}, inside, false);
  }
  return unknown;
}

void fill_covers(const Surface& surface, const VoxelSize& size, double quantile, BitTree& inner,
                 BitTree& outer, const Workers& workers, Progress& progress) {
  const ColumnFaces faces(surface, size.side);
  const int across = faces.blocks_across();
  const std::size_t blocks = static_cast<std::size_t>(across) * static_cast<std::size_t>(faces.blocks_down());
  std::vector<NodeStack<BitTree>> inner_stacks(blocks), outer_stacks(blocks);
  workers.for_each(blocks, [&](std::size_t n) {
    progress.check();
    const int a = static_cast<int>(n) % across, b = static_cast<int>(n) / across;
    const ColumnFaces::Block block(faces, a, b);
    inner_stacks[n] = NodeStack<BitTree>(a, b, false);
    outer_stacks[n] = NodeStack<BitTree>(a, b, false);
    LeafColumns columns(surface, faces, block);
    LeafReach reach(quantile);
    std::array<std::array<int, 2>, kColumns> held, touched;
    for (int square = 0; square < 256; ++square) {
      const int i8 = 16 * a + square / 16, j8 = 16 * b + square % 16;
      if (8 * i8 >= faces.cols() || 8 * j8 >= faces.rows()) continue;
      columns.visit(i8, j8, reach);
      for (std::size_t c = 0; c < kColumns; ++c) {
        touched[c] = reach.of[c].any() ? reach.of[c].touched(size.height) : kNothing;
        held[c] = reach.of[c].any() && columns.is_known(c) ? reach.of[c].held(size.height) : kNothing;
      }
      add_columns(held, i8, j8, inner_stacks[n]);
      add_columns(touched, i8, j8, outer_stacks[n]);
    }
    progress.advance(1.0 / static_cast<double>(blocks));
  });
  put_together(inner_stacks, inner);
  put_together(outer_stacks, outer);
}

}  // namespace sightbound
