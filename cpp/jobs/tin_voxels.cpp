// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/tin_voxels.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/number_text.h"

namespace sightbound {

namespace {

// Of the voxel whose diagonal is the tolerance. A surface has the tolerance less about a voxel to move in.
constexpr double kVoxelShare = 0.5;
constexpr double kMayBeLost = 0.01;  // of the vertices that have a tolerance
constexpr double kSqrt3 = 1.7320508075688772;
constexpr double kLeastVoxel = 1e-3, kMostVoxel = 1e5;  // metres
// Of the band: ten seconds or so. Voxels of kFinestShare of the spacing may be more.
constexpr double kMostVoxels = 1e7;
constexpr double kMostAcross = 1 << 27;  // voxels a side
constexpr double kGrowth = 1.1;

}  // namespace

double voxel_for(const TinTolerance& tolerance) {
  std::vector<float> metres;
  std::copy_if(tolerance.metres.begin(), tolerance.metres.end(), std::back_inserter(metres),
               [](float value) { return value > 0; });
  if (metres.empty()) return kLeastVoxel;
  const auto least =
      metres.begin() + static_cast<std::ptrdiff_t>(kMayBeLost * static_cast<double>(metres.size() - 1));
  std::nth_element(metres.begin(), least, metres.end());
  const double side = static_cast<double>(*least) / kSqrt3;
  return std::clamp(kVoxelShare * std::min(side, tolerance.error.spacing_m), kLeastVoxel, kMostVoxel);
}

double affordable_voxel(const Surface& surface, double wanted_m, VolumeOptions options,
                        const MemoryBudget& budget, std::size_t beside) {
  const Xyz size = surface.bounds().high;
  options.voxel_m = std::max(wanted_m, std::max({size.x, size.y, std::abs(size.z)}) / kMostAcross);
  const double for_time = kVoxelShare * kFinestShare * surface.spacing_m();  // coarsened no further
  for (; options.voxel_m < kMostVoxel; options.voxel_m *= kGrowth) {
    const VolumeNeed need = estimate_need(surface, options);
    const bool soon = need.voxels <= kMostVoxels || options.voxel_m >= for_time;
    if (soon && need.bytes + beside <= budget.bytes()) break;
  }
  return options.voxel_m;
}

std::string too_coarse(const HeldFaces& held, double voxel_m, double wanted_m, bool chosen) {
  std::string told = "Voxels of " + number_text(voxel_m, 3) + " m";
  if (chosen && voxel_m > wanted_m) told += ", the smallest that can be afforded,";
  told += " are too coarse for the tolerance at " + std::to_string(held.not_held) + " of " +
          std::to_string(held.faces) + " faces: little can be removed there.";
  if (wanted_m < voxel_m)
    told += " A tolerance of " + number_text(voxel_m * kSqrt3 / kVoxelShare, 2) +
            " m would suit them, or voxel = " + number_text(wanted_m, 2) +
            (chosen ? " with more memory and time, or a part of the TIN." : ".");
  return told;
}

}  // namespace sightbound
