// SPDX-License-Identifier: GPL-3.0-or-later
// Edge collapses within the envelope, cheapest first, tile by tile.
//
// A pass cuts the plane into square tiles; vertices of triangles that reach over a tile's edge stay as they
// are, so that tiles do not see each other. The next pass has its tiles elsewhere.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "simplify/envelope.h"
#include "simplify/plan_mesh.h"
#include "simplify/quadric.h"

namespace sightbound {

struct PassPlan {
  int tile = 128;                // cells a side
  int shift_x = 0, shift_y = 0;  // of the tiles, cells
  bool relax = false;            // move vertices to where they have most room before anything else
  // That a tile may lose, give or take 1.
  std::size_t most_faces = std::numeric_limits<std::size_t>::max();
  double share = 0;  // of `progress`
};

class Decimation {
 public:
  Decimation(PlanMesh& mesh, const Envelope& envelope);

  // Returns how many faces went. Advances `progress` by the plan's share.
  std::size_t pass(const PassPlan& plan, const Workers& workers, Progress& progress);

 private:
  friend class TileDecimation;

  // Of a vertex. Tiles write to their own alone.
  struct State {
    std::uint32_t moves = 0;
    std::int32_t tile = 0;
    // The last pass that changed something around it, or left edges of it untested.
    std::uint16_t changed = 0;
    bool frozen = false;  // in this pass
  };

  void assign_tiles(const PassPlan& plan);
  void freeze_seams();

  PlanMesh& mesh_;
  const Envelope& envelope_;
  std::vector<State> states_;
  std::vector<Quadric> quadrics_;  // of vertices
  std::uint16_t pass_ = 0;
  // Vertices by tile: those of tile t are members_[begin_[t]] to members_[begin_[t + 1]].
  std::vector<std::int32_t> begin_, members_;
};

}  // namespace sightbound
