// SPDX-License-Identifier: GPL-3.0-or-later
// What one observer sees of sixteen realised terrains at once.
//
// Rays leave the observer half a sample apart at the far end, on geodesics; each carries the horizon of every
// realisation outward, half a cell at a time. A target asks the ray nearest to it, at most a quarter of a
// sample off. Eye and target stand on each realised ground. Cost: for each sixteen realisations some 40 ns of
// one processor a sample; memory a bit for each realisation and cell.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "earth/observer_frames.h"
#include "sight/realised_columns.h"
#include "sight/viewshed.h"

namespace sightbound {

// Bit l of a cell: seen in realisation l of the sixteen. Cells that nobody can be asked about hold none.
using SeenBits = Grid<std::uint16_t>;

struct ProbableEye {
  const ObserverFrame* frame = nullptr;  // in coordinates from the base sample
  int base_col = 0, base_row = 0;        // of the terrain's grid
  double height = 1.7;                   // metres above the ground there
  Window reach;  // all that he could be asked about, on the terrain's grid or beyond: rays depend on it
};

class ProbableView {
 public:
  // `target_height` above the ground, metres; `bend`: Scene::bend.
  ProbableView(const OpenTerrain&, const ProbableEye&, double target_height, double bend);

  std::size_t blocks() const { return blocks_.size(); }
  // Sets the bits of a block's targets; blocks have no targets in common. `seen` is on the terrain's grid.
  void march(std::size_t block, std::uint32_t first_realisation, SeenBits& seen) const;

 private:
  struct Side {
    bool transposed;
    int sign;
  };
  struct Block {
    Side side;
    int first, count, rays;  // of the side's rays
  };
  class March;

  Lanes eye_heights(std::uint32_t first_realisation) const;

  const OpenTerrain& terrain_;
  ProbableEye eye_;
  double target_height_, bend_;
  std::vector<Block> blocks_;
};

}  // namespace sightbound
