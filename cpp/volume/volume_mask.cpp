// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/volume_mask.h"

#include <utility>

#include "volume/vdb.h"

namespace sightbound {

VolumeMask::VolumeMask() : tree_(std::make_shared<Tree>()) {}
VolumeMask::VolumeMask(std::shared_ptr<const Tree> tree) : tree_(std::move(tree)) {}

bool VolumeMask::contains(const Voxel& voxel) const { return tree_->bits.isValueOn(coord(voxel)); }
std::size_t VolumeMask::count() const { return tree_->bits.activeVoxelCount(); }
std::size_t VolumeMask::bytes() const { return tree_->bits.memUsage(); }

void VolumeMask::for_each(const std::function<void(const Voxel&, const Voxel&)>& f) const {
  for (auto it = tree_->bits.cbeginValueOn(); it; ++it) {
    const openvdb::CoordBBox box = it.getBoundingBox();
    f({box.min().x(), box.min().y(), box.min().z()}, {box.max().x(), box.max().y(), box.max().z()});
  }
}

bool operator==(const VolumeMask& a, const VolumeMask& b) {
  auto i = a.tree_->bits.cbeginValueOn(), j = b.tree_->bits.cbeginValueOn();
  for (; i && j; ++i, ++j) {
    if (i.getBoundingBox() != j.getBoundingBox()) return false;
  }
  return !i && !j;
}

}  // namespace sightbound
