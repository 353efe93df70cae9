// SPDX-License-Identifier: GPL-3.0-or-later
// What one column of the grid says within a block of the fan: bounds of the terrain, and of what stands
// there. Internal to the sweep.
#pragma once

#include <vector>

#include "sight/fan_block.h"

namespace sightbound {

// Where targets stand: on a surface, or at one absolute height.
struct TargetTops {
  const Grid<float>* surface = nullptr;  // on the scene's grid; null = absolute
  double height = 0;                     // metres above the surface, or absolute
  double at(int row, int col) const {
    return (surface ? static_cast<double>(surface->at(row, col)) : 0.0) + height;
  }
};

struct TerrainColumn {
  // Rows beyond a block's edges: pads and the cell around an edge.
  static constexpr int kMargin = 3;

  ColumnPlace place;
  int first = 0, rows = 0;          // minor coordinates from the base sample
  std::vector<float> above, below;  // z + K sigma, z - K sigma
  std::vector<float> top_above, top_below;
  // The last column of a strip that was leapt over: `highest` is all that is known, of the strip and of the
  // columns on both sides of it.
  bool leapt = false;
  float highest = 0;

  // Of `above`.
  float highest_above() const;
  // Rows as far as the block reaches here and on the columns beside it.
  void begin(const ColumnPlace& before, const ColumnPlace& here, const ColumnPlace& next);
};

// The column's rows of a grid, `outside` where the grid has none.
void copy_rows(const Grid<float>& from, const FanColumns&, const TerrainColumn&, float outside,
               std::vector<float>& to);

class ColumnLoader {
 public:
  // Keeps pointers.
  ColumnLoader(const Scene&, const TargetTops&, const FanColumns&, float height_pad);

  void load(const ColumnPlace& before, const ColumnPlace& here, const ColumnPlace& next, TerrainColumn&);

 private:
  void copy(const SampleField& from, const TerrainColumn&, std::vector<float>& to) const;
  void load_tops(TerrainColumn&);

  const Scene* scene_;
  const TargetTops* tops_;
  const FanColumns* columns_;
  float height_pad_;
  std::vector<float> z_, sampling_, between_;  // scratch
};

}  // namespace sightbound
