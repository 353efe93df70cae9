// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/volume_ray.h"

#include <algorithm>
#include <cmath>

#include "volume/vdb_ray_walk.h"

namespace sightbound {

namespace {

constexpr double kAroundHint = 8;  // voxels: within one leaf or two

// The smallest k of a terrain that has an inside; bounds as places in the order of halves.
struct LeastRatio {
  int low, high, certain;  // certain: -K or below
  double at = VolumeRays::kNever;

  bool voxel(std::int32_t packed, bool, double t) {
    const int here = ordered_low(packed);
    at = here < low ? t : at;
    low = std::min(low, here);
    high = std::min(high, ordered_high(packed));
    return high > certain;
  }
  bool may_matter(std::int32_t packed) const {
    return ordered_low(packed) < low || ordered_high(packed) < high;
  }
  bool unknown(double) {
    low = std::min(low, 0);
    high = std::min(high, 0);
    return true;
  }
  bool is_certain() const { return high <= certain; }
};

// The smallest distance from a sheet, and how far through it the line goes.
struct Passage {
  float nearest, farthest;    // bounds of the smallest abs(k)
  float through = 0;          // sigmas on both sides of the sheet
  float plus = 0, minus = 0;  // the most proven on either side since the sheet's side was last in doubt
  std::int32_t outside;

  bool voxel(std::int32_t packed, bool ambiguous, double) {
    if (packed == outside) {  // between sheets no side is known
      plus = minus = 0;
      return true;
    }
    const RatioInterval k = unpack(packed);
    nearest = std::min(nearest, std::max({k.low, -k.high, 0.0f}));
    farthest = std::min(farthest, std::max(std::abs(k.low), std::abs(k.high)));
    if (ambiguous) {
      plus = minus = 0;
      return true;
    }
    if (k.low > 0) {
      through = std::max(through, std::min(minus, k.low));
      plus = std::max(plus, k.low);
    } else if (k.high < 0) {
      through = std::max(through, std::min(plus, -k.high));
      minus = std::max(minus, -k.high);
    }
    return true;
  }
  bool unknown(double) { return true; }
  bool may_matter(std::int32_t) const { return true; }  // sides count, too
};

struct FirstBelow {
  float ratio;
  bool sheet;
  double t = VolumeRays::kNever;

  bool voxel(std::int32_t packed, bool, double at) {
    const RatioInterval k = unpack(packed);
    if (!((sheet ? std::max({k.low, -k.high, 0.0f}) : k.low) < ratio)) return true;
    t = at;
    return false;
  }
  bool may_matter(std::int32_t packed) const { return sheet || unpack(packed).low < ratio; }
  bool unknown(double at) {
    if (!(ratio > 0)) return true;
    t = at;
    return false;
  }
};

}  // namespace

VolumeRays::VolumeRays(const ErrorVolume& volume)
    : volume_(volume),
      columns_(std::make_unique<BlockColumns>(volume.trees().ratios, Workers(Workers::count_here()))) {}

WalkedTrees VolumeRays::walked() const {
  const ErrorVolume::Trees& trees = volume_.trees();
  const bool columns = volume_.surface().metric() == Metric::kVertical;
  return {trees.ratios,      trees.ambiguous,          columns ? &volume_.unknown_columns() : nullptr,
          volume_.voxel_m(), volume_.voxel_height_m(), *columns_};
}

VolumeRays::~VolumeRays() = default;

LeastOnLine VolumeRays::least_near(const VolumeLine& line, double t0, double t1, double hint) const {
  const float beyond_all = volume_.beyond_ratio();
  RayWalk walk(walked(), line);
  if (volume_.surface().sides() == Sides::kSheet) {
    Passage passage{beyond_all, beyond_all, 0, 0, 0, volume_.trees().ratios.background()};
    walk.run(t0, t1, passage);
    if (passage.nearest > 0) return {{passage.nearest, passage.farthest}};
    return {{-beyond_all, passage.through > 0 ? -passage.through : passage.farthest}};
  }
  const int most = ordered_half(half_above(static_cast<double>(beyond_all)));
  LeastRatio least{most, most, ordered_half(half_below(-volume_.largest_ratio()))};
  const double around = kAroundHint * volume_.voxel_m() / plan_length(line);
  const double from = std::max(t0, hint - around), to = std::min(t1, hint + around);
  if (from < to) walk.run(from, to, least);
  if (!least.is_certain()) walk.run(t0, t1, least);
  return {{from_ordered(least.low), from_ordered(least.high)}, least.at};
}

double VolumeRays::first(const VolumeLine& line, double ratio, double t0, double t1) const {
  RayWalk walk(walked(), line);
  FirstBelow first{static_cast<float>(ratio), volume_.surface().sides() == Sides::kSheet};
  walk.run(t0, t1, first);
  return first.t;
}

}  // namespace sightbound
