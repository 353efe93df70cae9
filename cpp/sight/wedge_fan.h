// SPDX-License-Identifier: GPL-3.0-or-later
// The sweep's bracket: neighbouring geodesics from the observer march outward together, one column at a time,
// and carry for every wedge between two of them an upper and a lower bound of its horizon. Most targets are
// proven hidden by them alone.
//
// Upper bound at +K sigma: the highest cell the wedge touches. Lower bound at -K sigma: the lowest place of
// each column line within the wedge. Neither depends on the window in memory, and neither decides anything
// but what is certain. Cost: a third to two thirds of a wedge step a cell; memory: a float a wedge and part of the
// upper horizon (some hundred kilobytes a thread).
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "sight/sight_line.h"
#include "sight/wedge_kernel.h"

namespace sightbound {

// Where targets stand: on a surface, or at one absolute height.
struct TargetTops {
  const Grid<float>* surface = nullptr;  // on the scene's grid; null = absolute
  double height = 0;                     // metres above the surface, or absolute
  double at(int row, int col) const {
    return (surface ? static_cast<double>(surface->at(row, col)) : 0.0) + height;
  }
};

// Neighbouring targets of one column (row, when transposed) with what the bracket says of them.
struct FanColumn {
  bool transposed = false;
  int major = 0;  // of the scene's grid
  int first_minor = 0, count = 0;
  const std::int32_t* state = nullptr;           // TargetState each
  double least_distance = 0, most_distance = 0;  // metres, of all of them
};

// For an open target: the parts of its line that the upper horizon does not clear. Valid until the next is
// asked for.
using OpenParts = std::span<const MajorRange>;

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
  struct Block {
    bool transposed;
    int sign;
    int index;     // slopes [index, index + 1] / kBlocksPerUnit
    double reach;  // major steps to the rim of the grid
  };
  class March;

  void add_side(bool transposed, int sign);

  const Scene& scene_;
  Eye eye_;
  TargetTops tops_;
  double reach_m_;
  std::vector<Block> blocks_;
};

}  // namespace sightbound
