// SPDX-License-Identifier: GPL-3.0-or-later
// inner(c) and outer(c) out of the bounds of k: node by node, in parallel.
#include <string>
#include <vector>

#include "base/parallel.h"
#include "volume/error_volume.h"
#include "volume/vdb_block.h"

namespace sightbound {

namespace {

using BitLeaf = BitTree::LeafNodeType;

// The voxels of the band whose bounds satisfy `wanted`, bar the columns set in `left_out`.
template <class Wanted>
VolumeMask select(const RatioTree& ratios, const PlanMask* left_out, const Wanted& wanted) {
  std::vector<const RatioNode128*> nodes;
  ratios.getNodes(nodes);
  std::vector<NodeStack<BitTree>> stacks(nodes.size());
  const Workers workers(Workers::count_here());
  workers.for_each(nodes.size(), [&](std::size_t n) {
    const openvdb::Coord corner = nodes[n]->origin();
    stacks[n] = NodeStack<BitTree>(floor_div(corner.x(), 128), floor_div(corner.y(), 128), false);
    for (auto it = nodes[n]->cbeginChildOn(); it; ++it) {
      const openvdb::Coord origin = it->origin();
      BitLeaf::NodeMaskType mask;
      for (auto voxel = it->cbeginValueOn(); voxel; ++voxel) {
        if (wanted(unpack(*voxel))) mask.setOn(voxel.pos());
      }
      if (left_out != nullptr && left_out->of_8(origin.x() >> 3, origin.y() >> 3) != PlanState::kNone) {
        for (openvdb::Index c = 0; c < 64; ++c) {
          if (left_out->at(origin.x() + static_cast<int>(c / 8), origin.y() + static_cast<int>(c % 8))) {
            for (openvdb::Index k = 0; k < 8; ++k) mask.setOff(8 * c + k);
          }
        }
      }
      if (mask.isOff()) continue;
      if (mask.isOn()) {
        stacks[n].add_tile(origin, true, true);
        continue;
      }
      auto leaf = std::make_unique<BitLeaf>(origin, false, false);
      leaf->setValueMask(mask);
      stacks[n].add(std::move(leaf));
    }
  });
  auto tree = std::make_shared<VolumeMask::Tree>();
  put_together(stacks, tree->bits);
  return VolumeMask(std::move(tree));
}

}  // namespace

VolumeMask ErrorVolume::inner(double confidence) const {
  const auto z = static_cast<float>(quantile(confidence));
  const bool columns = surface_->metric() == Metric::kVertical;
  return select(trees_->ratios, columns ? &unknown_ : nullptr,
                [z](const RatioInterval& k) { return k.low >= -z && k.high <= z; });
}

VolumeMask ErrorVolume::outer(double confidence) const {
  const auto z = static_cast<float>(quantile(confidence));
  return select(trees_->ratios, nullptr, [z](const RatioInterval& k) { return k.low <= z && k.high >= -z; });
}

}  // namespace sightbound
