// SPDX-License-Identifier: GPL-3.0-or-later
// Sight lines through an error volume (paper section 5.2): the smallest clearance ratio on the way, from the
// bounds of the voxels that the line passes, and nothing else.
//
// The walk is hierarchical: where all that a line passes within a column of 4096, 128 or 8 voxels is one tile
// - above the terrain or within it - the column is crossed in one step, and so is a leaf none of whose layers
// passed could change the answer; what is left is walked voxel by voxel.
// A line passes a voxel when the two meet; places on a face between two voxels belong to either one.
// Cost: a few microseconds for a line of kilometres; memory of VolumeRays: some 130 bytes per 64 voxel
// columns.
#pragma once

#include <cmath>
#include <memory>

#include "volume/error_volume.h"

namespace sightbound {

// From the observer (t = 0) to the target (t = 1), local metres. Straight in plan; the height is the chord's
// less drop t (1 - t), by which the curved ground rises against the line (design section 3).
struct VolumeLine {
  Xyz from, to;
  double drop = 0;  // metres, >= 0

  double height(double t) const { return from.z + t * (to.z - from.z) - drop * t * (1 - t); }
  Xyz at(double t) const { return {from.x + t * (to.x - from.x), from.y + t * (to.y - from.y), height(t)}; }
};

inline double plan_length(const VolumeLine& line) {
  return std::hypot(line.to.x - line.from.x, line.to.y - line.from.y);
}

// Every line from a place of one box to a place of another.
struct VolumeBeam {
  Box3 from, to;
  double least_drop = 0, most_drop = 0;  // of the lines
};
// Shares of a line.
struct LinePart {
  double begin = 0, end = 1;
};
// How closely a beam looks: at blocks of 8 x 8 columns, or, where these do not tell, at voxels.
enum class Grain { kBlocks, kVoxels };

// Bounds of the least k on a line, and the share at which the lower one was met.
struct LeastOnLine {
  RatioInterval k;
  double at = 2;  // beyond 1 when k is K' everywhere
};

struct WalkedTrees;
class BlockColumns;
class BeamWalk;

class VolumeRays {
 public:
  // Keeps a reference to the volume. One pass over its leaves.
  explicit VolumeRays(const ErrorVolume&);
  ~VolumeRays();
  VolumeRays(const VolumeRays&) = delete;
  VolumeRays& operator=(const VolumeRays&) = delete;

  const ErrorVolume& volume() const { return volume_; }

  // Bounds of k*, the smallest clearance ratio anywhere on the line between t0 and t1, within +-K'. Over
  // unknown columns k* counts as 0 at most. A walk ends early once k* is proven below -K.
  //
  // Sheets have no inside: there k* >= 0 is the smallest distance from the terrain in sigmas on whichever
  // side, and k* < 0 says that the line goes through it: from -k* or more on one side to -k* or more on the
  // other, with no border of the sheet in between.
  RatioInterval least(const VolumeLine& line, double t0 = 0, double t1 = 1) const {
    return least_near(line, t0, t1, kNever).k;
  }
  // The same; looks first where a neighbouring line was closest to the ground (`hint`, beyond 1 = not known),
  // after which little else can matter. Bounds that are not below -K do not depend on the hint.
  LeastOnLine least_near(const VolumeLine&, double t0, double t1, double hint) const;

  // The smallest t in [t0, t1] at which the line enters a voxel that may hold k below `ratio`; beyond 1 when
  // there is none. For sheets abs(k).
  double first(const VolumeLine&, double ratio, double t0 = 0, double t1 = 1) const;

  static constexpr double kNever = 2;

  // Proofs for all lines of a beam at once; false = not proven. Nothing is proven of boxes that overlap both
  // in x and in y. abs(ratio) <= K. Cost: some nanoseconds for each block, or voxel, of the beam's floor.
  //
  // Every place of every line within its part [begin, end] has k >= ratio.
  bool clear(const VolumeBeam&, const LinePart&, double ratio, Grain) const;
  // Every line has k <= -ratio somewhere within its part. Not for sheets: their inside is too thin.
  bool blocked(const VolumeBeam&, const LinePart&, double ratio, Grain) const;
  // The lower bound that least() gives is not above `ratio` for any line. Not for sheets.
  bool doubtful(const VolumeBeam&, const LinePart&, double ratio, Grain) const;

 private:
  WalkedTrees walked() const;
  BeamWalk walk(const VolumeBeam&) const;
  template <class OfBlock, class OfVoxel, class May>
  bool any_section(const VolumeBeam&, const LinePart&, Grain, const OfBlock&, const OfVoxel&,
                   const May&) const;

  const ErrorVolume& volume_;
  std::unique_ptr<const BlockColumns> columns_;
};

}  // namespace sightbound
