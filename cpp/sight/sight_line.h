// SPDX-License-Identifier: GPL-3.0-or-later
// One sight line, judged exactly: every crossing with column, row and diagonal lines of the terrain, and the
// places close to both ends (design section 3).
//
//     k* = min over the judged places of (height of the line - terrain) / sigma
//
// The answer is a function of the two ends alone. `settle` finds it by branch and bound down the pyramids;
// `for_each_place` visits every place. Cost: some tens of node visits for a line near the ground, a hundred
// nanoseconds for a plain one.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "earth/observer_frames.h"
#include "sight/scene.h"

namespace sightbound {

// Raster coordinates of lines count from the observer's base sample (the one at or before him in row and
// column), so that no result depends on the window in memory.
struct Eye {
  const ObserverFrame* frame =
      nullptr;                     // in coordinates from the base sample: its col() and row() are in [0, 1)
  int base_col = 0, base_row = 0;  // the base sample in the scene's grid
  double height = 0;               // metres, absolute
  double sampling = 0;  // sigma_s of the ground at the observer, metres (counts when the ends move)
  const ObserverFrames* frames = nullptr;  // by distance; none: `frame` answers for every place

  const ObserverFrame& frame_to(double col, double row) const {
    return frames != nullptr ? frames->of(col, row) : *frame;
  }
};

struct Target {
  double col = 0, row = 0;  // from the base sample
  double height = 0;        // metres, absolute
  double sampling = 0;      // as above
};

struct JudgedPlace {
  double xi = 0;      // share of the line along its major axis
  double share = 0;   // share of the distance
  double ground = 0;  // metres; NaN = unknown
  double sigma = 0;   // metres, what it is judged with
  double line = 0;    // height of the line, metres
};

// Steps [from, to) between columns (rows, when transposed) of the scene's grid.
struct MajorRange {
  int from = 0, to = 0;
};

struct Critical {
  double k = 0;       // k*, within +-K
  double xi = -1;     // where; -1 = no judged place came below K
  bool hole = false;  // held down by unknown ground
};

class SightLine {
 public:
  SightLine(const Scene&, const Eye&, const Target&);

  double distance() const { return distance_; }
  double azimuth_deg() const { return place_.azimuth_deg(); }
  // Angle of the line above the observer's horizontal, degrees.
  double elevation_deg() const;
  // The place at xi, from the base sample.
  double col(double xi) const { return transposed_ ? path_.minor(xi) : major0_ + xi * span_; }
  double row(double xi) const { return transposed_ ? major0_ + xi * span_ : path_.minor(xi); }

  // k*. `hint`: xi near which a neighbour was decided, or -1.
  Critical settle(double hint = -1) const;
  // The same when everything outside `open` is known to clear by K.
  Critical settle(std::span<const MajorRange> open, double hint) const;
  // Lowest absolute height of the target at which k* >= k, for k >= 0; never below `floor`, infinite behind
  // unknown ground when k > 0. `hint` as in settle(); it becomes where this height was decided.
  double needed_height(double k, double floor, double& hint) const;
  double needed_height(double k, double floor) const {
    double hint = -1;
    return needed_height(k, floor, hint);
  }

  void for_each_place(const std::function<void(const JudgedPlace&)>&) const;

 private:
  class Places;
  template <class Objective>
  class Search;
  class LeastRatio;
  class NeededHeight;

  const Scene& scene_;
  bool transposed_;
  std::ptrdiff_t major_stride_, minor_stride_;  // of the samples
  int majors_, minors_;                         // of the scene's grid
  int base_major_, base_minor_;                 // the base sample in it
  double major0_, span_;
  double eye_height_, target_height_, eye_sampling_, target_sampling_;
  FramePlace place_;
  double distance_, drop_;
  GeodesicPath path_;
};

}  // namespace sightbound
