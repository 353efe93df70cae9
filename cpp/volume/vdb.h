// SPDX-License-Identifier: GPL-3.0-or-later
// The trees inside our types. Headers named vdb*.h show OpenVDB; only sources of cpp/volume include them.
//
// Bounds of k stand in one tree of 32-bit numbers, low and high packed as half floats (ratio_interval.h):
// half the memory of two float trees and one look-up instead of two. Files hold two half-float grids. Voxel
// (i, j, k) of a tree is our Voxel: its box begins at (i, j, k), it is not centred there; the transforms
// written into files say so.
#pragma once

#include <memory>

#include <openvdb/openvdb.h>

#include "volume/error_volume.h"
#include "volume/volume_mask.h"

namespace sightbound {

using RatioTree = openvdb::Int32Tree;  // nodes of 4096^3, 128^3, leaves of 8^3
using RatioNode4096 = RatioTree::RootNodeType::ChildNodeType;
using RatioNode128 = RatioNode4096::ChildNodeType;
using RatioLeaf = RatioTree::LeafNodeType;
using BitTree = openvdb::MaskTree;  // the same sizes

struct ErrorVolume::Trees {
  // Background pack(K', K'). Active: the band (single voxels only). Inactive voxels and tiles: the
  // background, or pack(-K', -K') inside.
  RatioTree ratios;
  BitTree ambiguous;

  explicit Trees(std::int32_t background) : ratios(background) {}
  Trees(const openvdb::FloatTree& shape, std::int32_t background)
      : ratios(shape, background, openvdb::TopologyCopy()) {}
};

struct VolumeMask::Tree {
  BitTree bits;
};

inline openvdb::Coord coord(const Voxel& v) { return {v.i, v.j, v.k}; }

// openvdb::initialize(), once.
void initialize_vdb();

}  // namespace sightbound
