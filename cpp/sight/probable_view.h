// SPDX-License-Identifier: GPL-3.0-or-later
// What one observer sees of the terrains that could lie behind a DEM.
//
// Each ray carries the horizons of sixteen realisations outward. Only what may decide is drawn
// (bounded_march.h). Unknown ground (nodata) is open or closed to sight by a coin
// thrown for each realisation: behind it half of what the known ground leaves is seen. Eye and target stand
// on each realised ground. Cost: some 40 ns of one processor a sample for what all realisations have in
// common; then it depends on how much of the view is in doubt: on fractal terrain a few nanoseconds a sample
// for sixteen realisations. Memory: some megabytes a thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sight/bounded_march.h"
#include "sight/ray_fan.h"
#include "sight/sight_plan.h"

namespace sightbound {

// Cells of the terrain's grid, by target heights.
struct CellLayers {
  Grid<Layers> open, seen;   // neither in all realisations; in all realisations
  Grid<std::uint32_t> item;  // of the cell's first height: where its answers go
};

// Realisations to draw, a multiple of sixteen.
struct Draws {
  std::uint32_t first;
  int sixteens;
};

class ProbableView {
 public:
  // `heights` of the targets above the ground, at most kMostLayers; `bend`: Scene::bend.
  ProbableView(const OpenTerrain&, const ProbableEye&, std::vector<float> heights, double bend,
               const Refinement&);

  // Blocks have no targets in common: any order, any thread.
  std::size_t blocks() const { return blocks_.size(); }
  // Adds to each cell of a block what is open, and what is seen in all realisations.
  void bound(std::size_t block, CellLayers&);
  // Draws realisations for the layers of the block's cells that are open, and adds those in which they are
  // seen; only after bound().
  void look(std::size_t block, const CellLayers&, const Draws&, const SeenBits&);

 private:
  struct Block {
    RayBlock rays;
    std::vector<int> last_lines;  // what is open ends there
  };

  HeightRange eye_range() const;
  Departure departure_at_eye() const;
  SixteenEyes eyes(std::uint32_t first_realisation) const;
  std::uint16_t open_holes(std::uint32_t first_realisation) const;
  template <class Visit>
  void nodes_at_eye(const Visit&) const;
  Layers all_layers() const { return static_cast<Layers>((1u << heights_.size()) - 1); }

  const OpenTerrain& terrain_;
  const ProbableEye eye_;
  const std::vector<float> heights_;
  const double bend_;
  const Refinement refinement_;
  const RealisedColumns columns_[2];  // columns; rows
  std::vector<Block> blocks_;
};

}  // namespace sightbound
