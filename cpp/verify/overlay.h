// SPDX-License-Identifier: GPL-3.0-or-later
// The pieces of the overlay of an original and a simplified triangulation. Internal to verify.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "verify/original_surface.h"
#include "verify/plan_bins.h"
#include "verify/verify.h"

#include "base/parallel.h"
#include "base/progress.h"

namespace sightbound {

// Of some of the original's faces; places in the frame, with the simplified height.
struct PieceSummary {
  Extreme deviation, ratio;
  Area uncovered;
  double largest_gap_m2 = 0;  // of one face, at uncovered.place
  std::size_t faces = 0, pieces = 0;

  // Of faces that come after these.
  void append(const PieceSummary&);
};

// Area of simplified faces that originals cover, in parts of each face's own area: whole numbers, whose sum
// does not depend on the order.
class CoveredShares {
 public:
  explicit CoveredShares(std::size_t faces) : shares_(faces) {}
  void add(std::size_t face, double share) {
    shares_[face].fetch_add(static_cast<std::int64_t>(share * kWhole), std::memory_order_relaxed);
  }
  double of(std::size_t face) const {
    return static_cast<double>(shares_[face].load(std::memory_order_relaxed)) / kWhole;
  }

 private:
  static constexpr double kWhole = 0x1p52;
  std::vector<std::atomic<std::int64_t>> shares_;
};

struct Overlay {
  const OriginalSurface& original;
  const PlanBins& simplified;
  const std::vector<std::uint8_t>& folded;  // simplified faces that others lie above or below
  const Tolerance& tolerance;
  double margin;      // outward of all cuts, metres
  double z_rounding;  // of a difference of two heights

  // All pieces of the original's faces [first, last). Any thread.
  PieceSummary pieces_of(std::size_t first, std::size_t last, CoveredShares& covered) const;
  // Simplified less original height there; the one largest away from 0 of several, NaN where uncovered.
  double deviation_at(const Xyz& place) const;
};

// Simplified faces that share more than a rim of rounding with another one: 1.
std::vector<std::uint8_t> folded_faces(const PlanBins&, const Workers&, Progress&);

}  // namespace sightbound
