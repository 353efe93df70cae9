// SPDX-License-Identifier: GPL-3.0-or-later
#include "earth/observer_frames.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace sightbound {

namespace {

constexpr int kInnermost = 64;  // samples each way: below, a frame costs more than what is seen with it

// The samples at most `half` from the base sample each way.
Window ring(int half, const Window& raster) {
  return intersection({-half, -half, 2 * half + 1, 2 * half + 1}, raster);
}

}  // namespace

ObserverFrames::ObserverFrames(const Georeference& georeference, double col, double row, const Window& raster,
                               const Window& reach) {
  for (int half = kInnermost;; half *= 2) {
    const Window window = ring(half, raster);
    const bool last = window.contains(reach);
    try {
      rings_.emplace_back(georeference, col, row, window);
    } catch (const InvalidInput&) {
      if (!last) throw;
      // The reach itself may still fit where the ring around it does not.
      rings_.emplace_back(georeference, col, row, reach);
    }
    if (last) return;
  }
}

const ObserverFrame& ObserverFrames::of(double col, double row) const {
  const double farthest = std::max(std::abs(col), std::abs(row));
  std::size_t i = 0;
  for (double half = kInnermost; half < farthest && i + 1 < rings_.size(); half *= 2) ++i;
  return rings_[i];
}

}  // namespace sightbound
