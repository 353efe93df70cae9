// SPDX-License-Identifier: GPL-3.0-or-later
// The error volume (paper section 4; docs/algorithms/volume.md): the terrain with its doubt, in voxels.
//
// Each voxel near the terrain holds bounds of the clearance ratio k = (distance from the terrain) / sigma, of
// every place in the closed voxel. Kept is the band: every voxel whose bounds meet [-K, K]. All other voxels
// lie above (outside) the band, k > K, and hold (K', K'), or, where the terrain has an inside, below it, k <
// -K, and hold (-K', -K'); K' = beyond(K). A bound beyond K says no more than that: beyond K.
//
// Height fields: unknown_columns() says where there is no terrain, or not everywhere in the column. Bounds
// there speak only of the terrain that there is; nothing behind can be claimed visible (k <= 0 stands for
// them).
//
// Sheets: nothing is inside; the sign tells the side of the faces. is_ambiguous() voxels have places nearest
// to a border (or a part that has no sides); their bounds are (-m, m).
//
// Same bytes for any number of threads.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "base/progress.h"
#include "error_model/error_model.h"
#include "volume/plan_mask.h"
#include "volume/ratio_interval.h"
#include "volume/surface.h"
#include "volume/volume_mask.h"

namespace sightbound {

struct VolumeOptions {
  double voxel_m = 0;         // side in plan; 0 = chosen (voxel_size.h)
  double voxel_height_m = 0;  // 0 = voxel_m
  double alpha = 0;           // eps / voxel when voxel_m is chosen; 0 = from the slopes
  double confidence = 0.95;   // the one that voxels are chosen for
  double largest_confidence =
      0;  // the band reaches as far as its quantile; 0 = K is certain_ratio(), or z(confidence) when larger
  Tails tails = Tails::kNormal;  // of the surface's error in units of sigma: whose quantiles count
  std::size_t memory_bytes = 0;  // budget; 0 = three quarters of the memory usable
  int threads = 0;               // 0 = all
  std::string error_model;       // ErrorModel::describe() of what the surface's error came from; only kept
};

struct VolumeReport {
  std::size_t faces = 0;
  std::size_t faces_not_held =
      0;  // whose whole error volume no voxel of this size fits into: inner(confidence) may miss them
  double finest_needed_m = 0;  // voxel side that would hold all
  std::size_t voxels = 0;      // of the band
  std::size_t leaves = 0;
  std::size_t bytes = 0;  // of the volume in memory, surface included
  std::size_t unknown_columns = 0;
  std::size_t ambiguous_voxels = 0;
  std::vector<std::string> warnings;
};

class ErrorVolume {
 public:
  struct Trees;  // volume/vdb.h

  // Estimates the need first: throws OverBudget naming the voxel size that would fit. Throws InvalidInput,
  // Cancelled.
  static ErrorVolume build(std::shared_ptr<const Surface> surface, const VolumeOptions&, Progress&);
  // Written by save(). Throws IoError for what cannot be read or is damaged, InvalidInput for a .vdb that is
  // no error volume.
  static ErrorVolume open(const std::string& path, Progress&);
  // Half-float grids k_low and k_high, readable by any OpenVDB tool; the same volume comes back from open(),
  // bit by bit. The file appears under its name when whole.
  void save(const std::string& path, Progress&) const;

  ErrorVolume(ErrorVolume&&) noexcept;
  ErrorVolume& operator=(ErrorVolume&&) noexcept;
  ~ErrorVolume();

  double voxel_m() const { return voxel_m_; }
  double voxel_height_m() const { return voxel_height_m_; }
  double largest_ratio() const { return largest_ratio_; }  // K
  Tails tails() const { return tails_; }
  double largest_confidence() const { return 2 * cdf(largest_ratio_, tails_) - 1; }  // that K stands for
  // z(c). Throws InvalidInput for a confidence outside (0, 1) or beyond the band.
  double quantile(double confidence) const;
  float beyond_ratio() const { return beyond(largest_ratio_); }  // K'
  const Surface& surface() const { return *surface_; }
  const std::shared_ptr<const Surface>& shared_surface() const { return surface_; }
  const std::string& error_model() const { return error_model_; }
  const VolumeReport& report() const { return report_; }

  Voxel voxel_of(const Xyz& local) const;
  // Any thread. For many voxels walk the tree itself (volume/vdb.h).
  RatioInterval at(const Voxel&) const;
  bool is_ambiguous(const Voxel&) const;
  const PlanMask& unknown_columns() const { return unknown_; }

  // Wholly within +-z(c), and touching it. Throws InvalidInput for a confidence outside (0, 1) or beyond the
  // band.
  VolumeMask inner(double confidence) const;
  VolumeMask outer(double confidence) const;

  const Trees& trees() const { return *trees_; }

 private:
  ErrorVolume() = default;

  double voxel_m_ = 0, voxel_height_m_ = 0, largest_ratio_ = 0;
  Tails tails_ = Tails::kNormal;
  std::string error_model_;
  std::shared_ptr<const Surface> surface_;
  std::shared_ptr<const Trees> trees_;
  PlanMask unknown_;
  VolumeReport report_;
};

// inner(c) and outer(c) alone. Height fields: filled without bounds of k, in a tenth of the memory.
struct CoverMasks {
  VolumeMask inner, outer;
  double voxel_m = 0, voxel_height_m = 0;
};
CoverMasks build_covers(const std::shared_ptr<const Surface>& surface, double confidence,
                        const VolumeOptions&, Progress&);

// What build() would take, before it does.
struct VolumeNeed {
  double voxel_m = 0, voxel_height_m = 0;
  double voxels = 0;      // of the band, about
  std::size_t bytes = 0;  // at the peak
};
VolumeNeed estimate_need(const Surface& surface, const VolumeOptions&);

}  // namespace sightbound
