// SPDX-License-Identifier: GPL-3.0-or-later
// The sweep's lower bound of the horizon: one slope a wedge, which the ground that has been passed reaches at
// least on every line within the wedge. Internal to the sweep.
#pragma once

#include <span>
#include <vector>

#include "sight/fan_block.h"

namespace sightbound {

// Metres by which heights in floats may be wrong: some eight roundings of 6e-8 meet in one slope.
float pad_of_heights(const Eye&);

class LowerHorizon {
 public:
  // `eye`: metres, at most. Keeps a reference.
  LowerHorizon(const FanColumns&, float eye);

  int wedges() const { return wedges_; }
  float eye() const { return eye_; }
  const float* slopes() const { return below_.data(); }
  // Each wedge becomes two.
  void split();
  // A column: the ground in row first + j is at least line[j] high (linear between), no slope below
  // -kUnbounded. Nearer than half a step says nothing.
  void raise(const ColumnPlace&, int first, int rows, const float* line);
  // Does it hide in all wedges what reaches up to `top` metres, anywhere between the nearest and the farthest
  // of some columns?
  bool hides(std::span<const ColumnPlace> nearest_first, double top) const;

 private:
  const FanColumns& columns_;
  float eye_;
  int wedges_;
  std::vector<float> below_, widened_;  // one a wedge; scratch
};

}  // namespace sightbound
