// SPDX-License-Identifier: GPL-3.0-or-later
// The sweep's upper bound of the horizon, in parts that stand for some columns each: an open target is
// searched for only in the parts that its line may not clear. Internal to the sweep.
#pragma once

#include <span>
#include <vector>

#include "sight/sight_line.h"
#include "sight/wedge_kernel.h"

namespace sightbound {

// For an open target: the parts of its line that the upper horizon does not clear. Valid until the next is
// asked for.
using OpenParts = std::span<const MajorRange>;

class UpperHorizon {
 public:
  // `base`: the observer's base sample in the grid; `observer`: from there; `reach`: steps to the rim.
  UpperHorizon(int base, double observer, int sign, double reach, int wedges);

  // Between the columns `near` and `here`, next after one another: slopes by wedge, at least -kUnbounded, to
  // be raised.
  float* between(int near, int here);
  // The same of all wedges.
  void raise_all(int near, int here, float slope);
  // Nothing is known of what has been passed.
  void forget();
  // Each wedge becomes two.
  void split();

  // Everything from the observer to where the horizon begins, the parts that reach `slope` in one of two
  // wedges, and what has not been reached. `sure` false: all parts.
  OpenParts open_parts(WedgePair, float slope, bool sure, int target_major);

 private:
  // Of some columns alone.
  struct Part {
    int number;
    int from, to;              // majors from the base sample
    float everywhere;          // of all wedges
    std::vector<float> above;  // one a wedge
  };

  Part& part_between(int near, int here);
  int part_number(int major) const;
  void add_range(int from, int to);

  int base_, observer_, sign_;
  int part_length_;
  std::size_t wedges_;
  std::vector<Part> parts_;
  std::vector<MajorRange> ranges_;
};

}  // namespace sightbound
