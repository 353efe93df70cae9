// SPDX-License-Identifier: GPL-3.0-or-later
// How large voxels may be, and what they cost.
//
// A face is held when some voxel fits wholly into its volume at each place: with eps = its least E(c), voxels
// of side v and height h
//   vertical metric   h + sqrt2 tan(slope) v <= eps     (the surface rises by so much below a voxel's
//   diagonal) along the normal  sqrt3 times the side (the diagonal) <= eps; with h apart, sqrt(2 v^2 + h^2)
// The default holds nine faces of ten: one cliff, or one sample known to a millimetre, must not set the size
// for all. It is never finer than a tenth of the spacing L, since the terrain is straight between the
// samples, nor coarser than L.
#pragma once

#include <cstddef>

#include "volume/error_volume.h"
#include "volume/surface.h"

namespace sightbound {

inline constexpr double kFacesHeld = 0.9;
inline constexpr double kFinestShare = 0.1;  // of L

struct VoxelChoice {
  double voxel_m = 0, voxel_height_m = 0;
};
// Options as given, what is 0 filled in. Throws InvalidInput.
VoxelChoice choose_voxels(const Surface& surface, const VolumeOptions& options);

struct HeldFaces {
  std::size_t faces = 0, not_held = 0;
  double finest_needed_m = 0;  // voxel side (with the same ratio of height to side) that holds all
};
HeldFaces count_held(const Surface& surface, const VoxelChoice& voxels, double confidence, Tails tails);

// K of the options. Throws InvalidInput.
double largest_ratio_of(const VolumeOptions& options);

}  // namespace sightbound
