// SPDX-License-Identifier: GPL-3.0-or-later
// Leaves within reach of some face are refined: box by box the faces that may be nearest to one of its places
// are kept (those whose least distance is not above the least of all largest distances), the box is halved,
// down to voxels. A box all of whose faces are beyond K sigma is left.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "volume/column_overlay.h"
#include "volume/face_distance.h"
#include "volume/vdb_block.h"
#include "volume/vdb_fill.h"

namespace sightbound {

namespace {

using BitLeaf = BitTree::LeafNodeType;

// Leaves, as voxels of a tree whose unit is a leaf, that may hold band.
BitTree leaves_in_reach(const TinSurface& surface, const FaceDistances& distances, const VoxelSize& size,
                        double largest_ratio, Progress& progress) {
  BitTree leaves;
  openvdb::tree::ValueAccessor<BitTree> to(leaves);
  const Xyz leaf{8 * size.side, 8 * size.side, 8 * size.height}, half = 0.5 * leaf;
  const double diagonal = length(half);
  for (std::size_t f = 0; f < surface.face_count(); ++f) {
    if (f % 65536 == 0) progress.check();
    const std::array<Xyz, 3> p = surface.face(f)->corner;
    const double reach = largest_ratio * distances.largest_sigma(f) + kHeightSlack;
    const auto range = [&](double a, double b, double c, double unit) {
      return std::array{static_cast<int>(std::floor((std::min({a, b, c}) - reach) / unit)),
                        static_cast<int>(std::floor((std::max({a, b, c}) + reach) / unit))};
    };
    const auto is = range(p[0].x, p[1].x, p[2].x, leaf.x), js = range(p[0].y, p[1].y, p[2].y, leaf.y),
               ks = range(p[0].z, p[1].z, p[2].z, leaf.z);
    for (int i = is[0]; i <= is[1]; ++i) {
      for (int j = js[0]; j <= js[1]; ++j) {
        for (int k = ks[0]; k <= ks[1]; ++k) {
          const Xyz centre{i * leaf.x + half.x, j * leaf.y + half.y, k * leaf.z + half.z};
          if (norm(closest_on(p, centre) - centre) <= reach + diagonal) to.setValueOn({i, j, k});
        }
      }
    }
  }
  return leaves;
}

// One leaf's voxels.
class LeafRefiner {
 public:
  LeafRefiner(const TinSurface& surface, const FaceDistances& distances, const VoxelSize& size,
              double largest_ratio)
      : surface_(surface),
        distances_(distances),
        size_(size),
        ratio_(largest_ratio),
        beyond_(static_cast<double>(beyond(largest_ratio))) {}

  void refine(RatioLeaf& leaf, BitLeaf& ambiguous) {
    leaf_ = &leaf;
    ambiguous_ = &ambiguous;
    const BoxOf box = box_of({0, 0, 0}, 8);
    // Whatever is nearest to some place of the leaf is no further from its centre than the nearest there plus
    // its diagonal.
    const double most = surface_.closest(box.centre).distance + 2 * box.radius + kHeightSlack;
    std::vector<std::uint32_t>& found = levels_[0];
    found.clear();
    surface_.boxes().visit([&](const Box3& node) { return BoxTree::distance(node, box.centre) <= most; },
                           [&](std::size_t face) { found.push_back(static_cast<std::uint32_t>(face)); });
    std::sort(found.begin(), found.end());
    divide({0, 0, 0}, 8, 0);
  }

 private:
  BoxOf box_of(const std::array<int, 3>& from, int voxels) const {
    const openvdb::Coord origin = leaf_->origin();
    const Xyz half{voxels * size_.side / 2, voxels * size_.side / 2, voxels * size_.height / 2};
    return {{(origin.x() + from[0]) * size_.side + half.x, (origin.y() + from[1]) * size_.side + half.y,
             (origin.z() + from[2]) * size_.height + half.z},
            half,
            norm(half)};
  }

  // The box of voxels from `from`, whose nearest faces are among levels_[level].
  void divide(const std::array<int, 3>& from, int voxels, std::size_t level) {
    const BoxOf box = box_of(from, voxels);
    double furthest = std::numeric_limits<double>::infinity();
    std::size_t best =
        0;  // the face whose furthest place is nearest: first in the lists, so that bounds are tight at once
    near_.clear();
    for (const std::uint32_t face : levels_[level]) {
      if (distances_.at_least(face, box) > furthest + kHeightSlack) continue;
      const FaceDistances::Distance d = distances_.distance(face, box);
      if (d.furthest < furthest) best = near_.size();
      furthest = std::min(furthest, d.furthest);
      near_.push_back({face, d.nearest});
    }
    furthest += kHeightSlack;
    std::swap(near_[0], near_[best]);
    std::vector<std::uint32_t>& kept = levels_[level + 1];
    kept.clear();
    bool in_reach = false;
    for (const auto& [face, nearest] : near_) {
      if (nearest > furthest) continue;
      kept.push_back(face);
      in_reach = in_reach || nearest <= ratio_ * distances_.largest_sigma(face) + kHeightSlack;
    }
    if (!in_reach) return;
    if (voxels == 1) {
      set(from, box, furthest, kept);
      return;
    }
    const int half = voxels / 2;
    for (int part = 0; part < 8; ++part) {
      divide({from[0] + half * (part >> 2), from[1] + half * (part >> 1 & 1), from[2] + half * (part & 1)},
             half, level + 1);
    }
  }

  // Between two sheets the near one changes, and with it the side, where no face is. A side that changes
  // within a voxel is one face's, or that of faces which hang together and look one way.
  bool may_change_sides(const RatioBounds& k, const std::vector<std::uint32_t>& faces) {
    if (surface_.sides() == Sides::kSolid || !(k.low < 0 && k.high > 0) || faces.size() == 1) return false;
    constexpr double kOneWay = 0.5;  // cosine; three faces of a cube's corner look one way
    Xyz all;
    for (const std::uint32_t face : faces) all = all + distances_.normal(face);
    const double most = kOneWay * norm(all);
    for (const std::uint32_t face : faces) {
      if (!(dot(distances_.normal(face), all) > most)) return true;
    }
    // From the first face over common edges.
    linked_.assign(1, faces.front());
    for (std::size_t n = 0; n < linked_.size(); ++n) {
      for (const std::int32_t next : surface_.topology().neighbours[linked_[n]]) {
        const auto face = static_cast<std::uint32_t>(next);
        if (next >= 0 && std::find(faces.begin(), faces.end(), face) != faces.end() &&
            std::find(linked_.begin(), linked_.end(), face) == linked_.end()) {
          linked_.push_back(face);
        }
      }
    }
    return linked_.size() < faces.size();
  }

  void set(const std::array<int, 3>& voxel, const BoxOf& box, double furthest,
           const std::vector<std::uint32_t>& faces) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    RatioBounds k{kInfinity, -kInfinity, false};
    for (const std::uint32_t face : faces) k.enlarge(distances_.bounds(face, box, furthest));
    k.ambiguous = k.ambiguous || may_change_sides(k, faces);
    if (k.ambiguous) {  // no side: as far on one as on the other
      const double most = std::max(-k.low, k.high);
      k.low = -most;
      k.high = most;
    }
    if (k.low > ratio_ || k.high < -ratio_) return;
    const auto at = static_cast<openvdb::Index>(64 * voxel[0] + 8 * voxel[1] + voxel[2]);
    leaf_->setValueOn(at, pack(std::clamp(k.low, -beyond_, beyond_), std::clamp(k.high, -beyond_, beyond_)));
    if (k.ambiguous) ambiguous_->setValueOn(at);
  }

  const TinSurface& surface_;
  const FaceDistances& distances_;
  VoxelSize size_;
  double ratio_, beyond_;
  RatioLeaf* leaf_ = nullptr;
  BitLeaf* ambiguous_ = nullptr;
  std::array<std::vector<std::uint32_t>, 5> levels_;    // faces by depth: 8, 4, 2, 1 voxels
  std::vector<std::pair<std::uint32_t, double>> near_;  // face, least distance
  std::vector<std::uint32_t> linked_;
};

}  // namespace

void fill_nearest(const TinSurface& surface, const VoxelSize& size, double largest_ratio, RatioTree& ratios,
                  BitTree& ambiguous, const Workers& workers, Progress& progress) {
  const FaceDistances distances(surface);
  const BitTree in_reach = leaves_in_reach(surface, distances, size, largest_ratio, progress);
  // In the tree's own order, so grouped by nodes; a stack for each group of 16 x 16 leaves in plan.
  std::vector<std::array<int, 3>> leaves;
  for (auto it = in_reach.cbeginValueOn(); it; ++it) {
    for (auto voxel = it.getBoundingBox().begin(); voxel; ++voxel)
      leaves.push_back({(*voxel).x(), (*voxel).y(), (*voxel).z()});
  }
  const auto group = [](const std::array<int, 3>& leaf) {
    return std::array{floor_div(leaf[0], 16), floor_div(leaf[1], 16)};
  };
  std::sort(leaves.begin(), leaves.end(),
            [&](const auto& a, const auto& b) { return std::pair(group(a), a) < std::pair(group(b), b); });
  std::vector<std::size_t> start;
  for (std::size_t n = 0; n < leaves.size(); ++n) {
    if (n == 0 || group(leaves[n]) != group(leaves[n - 1])) start.push_back(n);
  }
  start.push_back(leaves.size());

  const double end = static_cast<double>(beyond(largest_ratio));
  const std::int32_t outside = pack(end, end);
  std::vector<NodeStack<RatioTree>> stacks(start.size() - 1);
  std::vector<NodeStack<BitTree>> ambiguous_stacks(start.size() - 1);
  workers.for_each(start.size() - 1, [&](std::size_t n) {
    const auto at = group(leaves[start[n]]);
    stacks[n] = NodeStack<RatioTree>(at[0], at[1], outside);
    ambiguous_stacks[n] = NodeStack<BitTree>(at[0], at[1], false);
    LeafRefiner refiner(surface, distances, size, largest_ratio);
    for (std::size_t l = start[n]; l < start[n + 1]; ++l) {
      if ((l - start[n]) % 64 == 0) progress.check();
      const openvdb::Coord origin(8 * leaves[l][0], 8 * leaves[l][1], 8 * leaves[l][2]);
      auto leaf = std::make_unique<RatioLeaf>(origin, outside, false);
      auto bits = std::make_unique<BitLeaf>(origin, false, false);
      refiner.refine(*leaf, *bits);
      if (!leaf->isEmpty()) stacks[n].add(std::move(leaf));
      if (!bits->isEmpty()) ambiguous_stacks[n].add(std::move(bits));
    }
    progress.advance(static_cast<double>(start[n + 1] - start[n]) / static_cast<double>(leaves.size()));
  });
  put_together(stacks, ratios);
  put_together(ambiguous_stacks, ambiguous);
  if (surface.sides() == Sides::kSolid)
    fill_inside(surface, distances, size, pack(-end, -end), ratios, workers);
}

}  // namespace sightbound
