// SPDX-License-Identifier: GPL-3.0-or-later
// Puts the meshes of blocks together into one. Neighbouring blocks share a row or column of samples, their
// rim, of which both have kept all: so seams close exactly.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "simplify/plan_mesh.h"
#include "simplify/vertex_kinds.h"

namespace sightbound {

// Is the sample on a rim of the window, the raster's own border excepted?
bool on_rim(const Window& block, int rows, int cols, int row, int col);

class BlockJoiner {
 public:
  // `whole` is empty and must outlive this.
  BlockJoiner(PlanMesh& whole, const KindRules& rules);

  // Blocks come row by row from above, from left to right. Returns the number that each vertex of the block
  // has in the whole.
  std::vector<std::int32_t> add(const PlanMesh& block, const Window& window);
  // Rims become what they are in the whole. Where parts touch in one sample only, it becomes a vertex of
  // each: returns whose twins the vertices are that are appended.
  std::vector<std::int32_t> finish();

 private:
  // Along a rim: the vertex of each sample, and the corner opposite to the edge from it to the next.
  struct Rim {
    explicit Rim(int samples) : vertex(static_cast<std::size_t>(samples), PlanMesh::kNone), corner(vertex) {}
    std::vector<std::int32_t> vertex, corner;
    void clear();
  };
  struct Place {
    Rim* rim;
    std::size_t at;
  };

  void begin(const Window& window);
  std::vector<Place> places_of(int row, int col);
  std::int32_t number_of(const PlanMesh& block, std::int32_t v);
  void join_edge(std::int32_t corner);

  PlanMesh& whole_;
  const KindRules rules_;
  Window window_;
  Rim above_, below_, left_, right_;  // of the block at hand
};

}  // namespace sightbound
