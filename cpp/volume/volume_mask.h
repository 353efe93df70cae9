// SPDX-License-Identifier: GPL-3.0-or-later
// A set of voxels: a hierarchical bit mask (leaves of 8^3, nodes of 128^3 and 4096^3), OpenVDB's, behind our
// own type.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

namespace sightbound {

// Index of a voxel: it holds the places [i, i + 1] x [j, j + 1] voxel sides, [k, k + 1] voxel heights from
// the frame's origin.
struct Voxel {
  int i = 0, j = 0, k = 0;

  friend bool operator==(const Voxel&, const Voxel&) = default;
};

class VolumeMask {
 public:
  struct Tree;  // volume/vdb.h

  VolumeMask();
  explicit VolumeMask(std::shared_ptr<const Tree> tree);

  bool contains(const Voxel&) const;  // any thread
  std::size_t count() const;
  std::size_t bytes() const;
  // Every box [low, high] of voxels (both included) that is wholly in the set, single voxels and tiles of 8^3
  // and up; in a fixed order.
  void for_each(const std::function<void(const Voxel& low, const Voxel& high)>&) const;
  // The same voxels, held by the same tiles.
  friend bool operator==(const VolumeMask&, const VolumeMask&);

  const Tree& tree() const { return *tree_; }

 private:
  std::shared_ptr<const Tree> tree_;
};

}  // namespace sightbound
