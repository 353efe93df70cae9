// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "volume/vdb_block.h"
#include "volume/vdb_fill.h"

namespace sightbound {

namespace {

// Groups of slots of a cube that are free and touch by a face. Slots are numbered as in OpenVDB's nodes: (i
// side + j) side + k. Calls f(slots of the group) for each.
template <class Free, class F>
void for_each_group(int side, const Free& is_free, const F& f) {
  const std::size_t count =
      static_cast<std::size_t>(side) * static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
  std::vector<bool> seen(count, false);
  std::vector<std::uint32_t> group;
  for (std::uint32_t first = 0; first < count; ++first) {
    if (seen[first] || !is_free(first)) continue;
    group.assign(1, first);
    seen[first] = true;
    for (std::size_t n = 0; n < group.size(); ++n) {
      const auto slot = static_cast<int>(group[n]);
      const std::array<int, 3> at{slot / (side * side), slot / side % side, slot % side};
      const std::array<int, 3> step{side * side, side, 1};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const int way : {-1, 1}) {
          const int next = at[axis] + way;
          if (next < 0 || next >= side) continue;
          const auto other = static_cast<std::uint32_t>(slot + way * step[axis]);
          if (seen[other] || !is_free(other)) continue;
          seen[other] = true;
          group.push_back(other);
        }
      }
    }
    f(group);
  }
}

class InsideFill {
 public:
  InsideFill(const TinSurface& surface, const FaceDistances& distances, const VoxelSize& size,
             std::int32_t inside)
      : surface_(surface), distances_(distances), size_(size), inside_(inside) {}

  // Is the middle of a cube of voxels inside?
  bool is_inside(const openvdb::Coord& from, int voxels) const {
    const double half = 0.5 * voxels;
    const Xyz middle{(from.x() + half) * size_.side, (from.y() + half) * size_.side,
                     (from.z() + half) * size_.height};
    const ClosestPlace closest = surface_.closest(middle);
    return distances_.side(closest.face, middle) < 0;
  }

  void leaf(RatioLeaf& leaf) const {
    for_each_group(
        8, [&](std::uint32_t slot) { return !leaf.isValueOn(slot); },
        [&](const std::vector<std::uint32_t>& group) {
          if (!is_inside(leaf.offsetToGlobalCoord(group[0]), 1)) return;
          for (const std::uint32_t slot : group) leaf.setValueOff(slot, inside_);
        });
  }
  template <class Node>
  void node(Node& node) const {
    constexpr int kSide = 1 << Node::LOG2DIM;
    for_each_group(
        kSide, [&](std::uint32_t slot) { return !node.isChildMaskOn(slot); },
        [&](const std::vector<std::uint32_t>& group) {
          if (!is_inside(node.offsetToGlobalCoord(group[0]), Node::ChildNodeType::DIM)) return;
          for (const std::uint32_t slot : group) node.addTile(slot, inside_, false);
        });
  }

 private:
  const TinSurface& surface_;
  const FaceDistances& distances_;
  VoxelSize size_;
  std::int32_t inside_;
};

}  // namespace

void fill_inside(const TinSurface& surface, const FaceDistances& distances, const VoxelSize& size,
                 std::int32_t inside, RatioTree& ratios, const Workers& workers) {
  const InsideFill fill(surface, distances, size, inside);
  std::vector<RatioLeaf*> leaves;
  ratios.getNodes(leaves);
  workers.for_each((leaves.size() + 63) / 64, [&](std::size_t n) {
    for (std::size_t l = 64 * n; l < std::min(64 * n + 64, leaves.size()); ++l) fill.leaf(*leaves[l]);
  });
  std::vector<RatioNode128*> small;
  ratios.getNodes(small);
  workers.for_each(small.size(), [&](std::size_t n) { fill.node(*small[n]); });
  std::vector<RatioNode4096*> large;
  ratios.getNodes(large);
  workers.for_each(large.size(), [&](std::size_t n) { fill.node(*large[n]); });

  // Whole cubes of 4096 voxels inside a very large body.
  const Box3& box = surface.bounds();
  const auto last = [](double place, double voxel) {
    return static_cast<int>(std::floor(place / voxel / 4096));
  };
  for (int a = 0; a <= last(box.high.x, size.side); ++a) {
    for (int b = 0; b <= last(box.high.y, size.side); ++b) {
      for (int c = last(box.low.z, size.height); c <= last(box.high.z, size.height); ++c) {
        const openvdb::Coord corner(4096 * a, 4096 * b, 4096 * c);
        if (ratios.root().getValueDepth(corner) < 0 && fill.is_inside(corner, 4096))
          ratios.root().addTile(corner, inside, false);
      }
    }
  }
}

}  // namespace sightbound
