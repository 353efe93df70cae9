// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/error_volume.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/memory_budget.h"
#include "base/number_text.h"
#include "base/parallel.h"
#include "volume/tin_surface.h"
#include "volume/vdb.h"
#include "volume/vdb_fill.h"
#include "volume/voxel_size.h"

namespace sightbound {

namespace {

constexpr double kThinnest = 0.01;  // metres; smaller voxels are no advice

// A voxel side whose estimated need is within the budget: the smallest, to 5 %.
double side_that_fits(const Surface& surface, VolumeOptions options, const VolumeNeed& need,
                      std::size_t budget) {
  const double flatness = need.voxel_height_m / need.voxel_m;
  const auto fits = [&](double side) {
    options.voxel_m = side;
    options.voxel_height_m = side * flatness;
    return estimate_need(surface, options).bytes <= budget;
  };
  double low = need.voxel_m, high = 2 * low;
  while (!fits(high) && high < 1e4) {
    low = high;
    high *= 2;
  }
  while (high > 1.05 * low) {
    const double middle = std::sqrt(low * high);
    (fits(middle) ? high : low) = middle;
  }
  return high;
}

void require_memory(const Surface& surface, const VolumeOptions& options) {
  const VolumeNeed need = estimate_need(surface, options);
  const MemoryBudget budget(options.memory_bytes);
  if (need.bytes <= budget.bytes()) return;
  const double fits = side_that_fits(surface, options, need, budget.bytes());
  budget.require(need.bytes, "The error volume with voxels of " + number_text(need.voxel_m, 3) + " m",
                 "voxel_m = " + number_text(std::ceil(fits * 100) / 100, 3) + " would fit.");
}

}  // namespace

ErrorVolume::ErrorVolume(ErrorVolume&&) noexcept = default;
ErrorVolume& ErrorVolume::operator=(ErrorVolume&&) noexcept = default;
ErrorVolume::~ErrorVolume() = default;

ErrorVolume ErrorVolume::build(std::shared_ptr<const Surface> surface, const VolumeOptions& options,
                               Progress& progress) {
  const VoxelChoice voxels = choose_voxels(*surface, options);
  ErrorVolume volume;
  volume.voxel_m_ = voxels.voxel_m;
  volume.voxel_height_m_ = voxels.voxel_height_m;
  volume.largest_ratio_ = largest_ratio_of(options);
  volume.tails_ = options.tails;
  volume.error_model_ = options.error_model;
  require_memory(*surface, options);

  const Workers workers(options.threads);
  const double end = static_cast<double>(volume.beyond_ratio());
  auto trees = std::make_shared<Trees>(pack(end, end));
  const VoxelSize size{voxels.voxel_m, voxels.voxel_height_m};
  progress.begin(1, 1);
  if (surface->metric() == Metric::kVertical) {
    volume.unknown_ = fill_ratios(*surface, size, volume.largest_ratio_, trees->ratios, workers, progress);
  } else {
    fill_nearest(dynamic_cast<const TinSurface&>(*surface), size, volume.largest_ratio_, trees->ratios,
                 trees->ambiguous, workers, progress);
  }
  progress.finish();

  VolumeReport& report = volume.report_;
  const HeldFaces held = count_held(*surface, voxels, options.confidence, options.tails);
  report.faces = held.faces;
  report.faces_not_held = held.not_held;
  report.finest_needed_m = held.finest_needed_m;
  report.voxels = trees->ratios.activeVoxelCount();
  report.leaves = trees->ratios.leafCount();
  report.bytes = trees->ratios.memUsage() + trees->ambiguous.memUsage() + surface->bytes();
  report.unknown_columns = volume.unknown_.count();
  report.ambiguous_voxels = trees->ambiguous.activeVoxelCount();
  if (held.not_held > 0) {
    // Where samples are without error the volume has no thickness at them, and nothing fits.
    const std::string advice =
        held.finest_needed_m < kThinnest
            ? " Samples without error leave it no thickness there; sight is judged all the same."
            : " Voxels of " + number_text(held.finest_needed_m, 3) + " m would hold all.";
    report.warnings.push_back(std::to_string(held.not_held) + " of " + std::to_string(held.faces) +
                              " faces are too steep or too well known for voxels of " +
                              number_text(voxels.voxel_m, 3) +
                              " m: there the volume is only known from outside." + advice);
  }
  volume.surface_ = std::move(surface);
  volume.trees_ = std::move(trees);
  return volume;
}

double ErrorVolume::quantile(double confidence) const {
  const double quantile = two_sided_quantile(confidence, tails_);
  if (quantile <= largest_ratio_) return quantile;
  throw InvalidInput("confidence is " + number_text(confidence) + ", more than this volume was built for (" +
                     number_text(largest_confidence(), 4) + "); build it with a larger largest_confidence.");
}

Voxel ErrorVolume::voxel_of(const Xyz& local) const {
  return {static_cast<int>(std::floor(local.x / voxel_m_)), static_cast<int>(std::floor(local.y / voxel_m_)),
          static_cast<int>(std::floor(local.z / voxel_height_m_))};
}

RatioInterval ErrorVolume::at(const Voxel& voxel) const {
  return unpack(trees_->ratios.getValue(coord(voxel)));
}
bool ErrorVolume::is_ambiguous(const Voxel& voxel) const { return trees_->ambiguous.isValueOn(coord(voxel)); }

CoverMasks build_covers(const std::shared_ptr<const Surface>& shared, double confidence,
                        const VolumeOptions& options, Progress& progress) {
  const Surface& surface = *shared;
  const double quantile = two_sided_quantile(confidence, options.tails);
  const VoxelChoice voxels = choose_voxels(surface, options);
  if (surface.metric() == Metric::kNormal) {
    VolumeOptions exact = options;
    exact.confidence = exact.largest_confidence = confidence;
    exact.voxel_m = voxels.voxel_m;
    exact.voxel_height_m = voxels.voxel_height_m;
    const ErrorVolume volume = ErrorVolume::build(shared, exact, progress);
    return {volume.inner(confidence), volume.outer(confidence), voxels.voxel_m, voxels.voxel_height_m};
  }
  const Workers workers(options.threads);
  auto inner = std::make_shared<VolumeMask::Tree>(), outer = std::make_shared<VolumeMask::Tree>();
  progress.begin(1, 1);
  fill_covers(surface, {voxels.voxel_m, voxels.voxel_height_m}, quantile, inner->bits, outer->bits, workers,
              progress);
  progress.finish();
  return {VolumeMask(inner), VolumeMask(outer), voxels.voxel_m, voxels.voxel_height_m};
}

}  // namespace sightbound
