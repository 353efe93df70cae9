// SPDX-License-Identifier: GPL-3.0-or-later
// The sweep's bracket: neighbouring geodesics from the observer march outward together, one column at a time,
// and carry for every wedge between two of them an upper and a lower bound of its horizon. Most targets are
// proven hidden by them alone.
//
// Upper bound at +K sigma: the highest cell the wedge touches. Lower bound at -K sigma: the lowest place of
// each column line within the wedge. They decide nothing but what is certain. Cost: a third to two thirds of
// a wedge step a cell, next to nothing where whole strips of columns are leapt over (wedge_march.h); memory:
// a float a wedge and part of the upper horizon (some hundred kilobytes a thread).
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "sight/fan_block.h"
#include "sight/terrain_column.h"
#include "sight/upper_horizon.h"

namespace sightbound {

// Neighbouring targets of one column (row, when transposed) with what the bracket says of them.
struct FanColumn {
  bool transposed = false;
  int major = 0;  // of the scene's grid
  int first_minor = 0, count = 0;
  const std::int32_t* state = nullptr;           // TargetState each; null = all of them are surely hidden
  double least_distance = 0, most_distance = 0;  // metres, of all of them

  bool all_hidden() const { return state == nullptr; }
};

class WedgeFan {
 public:
  // Nothing beyond `reach_m` is visited (some targets a little beyond may be).
  WedgeFan(const Scene&, const Eye&, const TargetTops&, double reach_m);

  std::size_t blocks() const { return blocks_.size(); }
  // Visits every target of a block once, nearest column first. The blocks together cover every cell of the
  // scene's grid within reach but the one the observer stands on exactly. Blocks are independent: any order,
  // any thread.
  using OpenPartsOf = std::function<OpenParts(int i)>;  // of target i of the column
  using Visitor = std::function<void(const FanColumn&, const OpenPartsOf&)>;
  void march(std::size_t block, const Visitor& visit) const;

 private:
  void add_side(bool transposed, int sign);

  const Scene& scene_;
  Eye eye_;
  TargetTops tops_;
  double reach_m_;
  std::vector<FanBlock> blocks_;
};

}  // namespace sightbound
