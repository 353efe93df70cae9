// SPDX-License-Identifier: GPL-3.0-or-later
// From the blocks of 8^3 voxels that the triangle's box meets down to single voxels: parts that the triangle
// does not touch are left, parts that are wholly in the set (tiles, full leaves) too.
//
// A projection of a triangle without extent there (seen edge on) has no inner side of one sign; its edges
// then run both ways along one line, and a square off that line lies on the wrong side of one of the two.
#include "volume/permission_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "volume/triangle_box.h"
#include "volume/vdb.h"

namespace sightbound {

namespace {

using BitLeaf = BitTree::LeafNodeType;
constexpr int kLeaf = 8;

class Walk {
 public:
  Walk(const BitTree& tree, const TriangleInVoxels& triangle) : tree_(tree), triangle_(triangle) {}

  // The block of 2^n leaves a side.
  bool holds(const std::array<int, 3>& from, int voxels) const {
    if (!triangle_.touches(from, voxels)) return true;
    if (voxels == kLeaf) return leaf_holds(from);
    const int half = voxels / 2;
    for (int part = 0; part < 8; ++part) {
      if (!holds(part_of(from, half, part), half)) return false;
    }
    return true;
  }

 private:
  static std::array<int, 3> part_of(const std::array<int, 3>& from, int half, int part) {
    return {from[0] + half * (part >> 2), from[1] + half * (part >> 1 & 1), from[2] + half * (part & 1)};
  }

  bool leaf_holds(const std::array<int, 3>& from) const {
    const openvdb::Coord origin(from[0], from[1], from[2]);
    const BitLeaf* leaf = tree_.probeConstLeaf(origin);
    if (leaf == nullptr) return tree_.isValueOn(origin);
    return leaf->getValueMask().isOn() || part_holds(*leaf, from, kLeaf);
  }

  bool part_holds(const BitLeaf& leaf, const std::array<int, 3>& from, int voxels) const {
    const int half = voxels / 2;
    for (int part = 0; part < 8; ++part) {
      const std::array<int, 3> at = part_of(from, half, part);
      if (half == 1 && leaf.isValueOn({at[0], at[1], at[2]})) continue;
      if (!triangle_.touches(at, half)) continue;
      if (half == 1 || !part_holds(leaf, at, half)) return false;
    }
    return true;
  }

  openvdb::tree::ValueAccessor<const BitTree> tree_;
  const TriangleInVoxels& triangle_;
};

int down_to(int i, int multiple) { return static_cast<int>(std::floor(double(i) / multiple)) * multiple; }

}  // namespace

bool PermissionGrid::holds(const std::array<Xyz, 3>& triangle) const {
  std::array<Xyz, 3> corners;
  double largest = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    corners[i] = {triangle[i].x / voxel_.x, triangle[i].y / voxel_.y, triangle[i].z / voxel_.z};
    largest = std::max({largest, std::abs(corners[i].x), std::abs(corners[i].y), std::abs(corners[i].z)});
  }
  constexpr double kRounding = 0x1p-46, kMostVoxels = 1 << 28;
  if (!(largest < kMostVoxels)) return false;
  const TriangleInVoxels in_voxels(corners,
                                   kRounding * largest + kWrittenSlack / std::min(voxel_.x, voxel_.z));
  const std::array<int, 3> first = in_voxels.first(), last = in_voxels.last();
  int block = kLeaf;
  const int extent = std::max({last[0] - first[0], last[1] - first[1], last[2] - first[2]});
  while (block < extent) block *= 2;
  const Walk walk(allowed_.tree().bits, in_voxels);
  for (int i = down_to(first[0], block); i <= last[0]; i += block) {
    for (int j = down_to(first[1], block); j <= last[1]; j += block) {
      for (int k = down_to(first[2], block); k <= last[2]; k += block) {
        if (!walk.holds({i, j, k}, block)) return false;
      }
    }
  }
  return true;
}

}  // namespace sightbound
