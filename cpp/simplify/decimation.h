// SPDX-License-Identifier: GPL-3.0-or-later
// Edge collapses within the envelope, cheapest first, tile by tile.
//
// A pass cuts the plane into square tiles; vertices of triangles that reach over a tile's edge stay as they
// are, so that tiles do not see each other. The next pass has its tiles elsewhere, and a higher cost up to
// which it goes: no seam is ever far behind.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "simplify/envelope.h"
#include "simplify/plan_mesh.h"

namespace sightbound {

struct PassPlan {
  int tile = 256;                // cells a side
  int shift_x = 0, shift_y = 0;  // cells
  double cost_limit = std::numeric_limits<double>::infinity();
  std::size_t most_faces =
      std::numeric_limits<std::size_t>::max();  // that each tile may lose, give or take 1
};

// Seams wander from pass to pass; the last passes take what is left. With a number of faces to lose all of
// the plane is one tile: only then the cheapest go first everywhere.
std::vector<PassPlan> pass_plans(std::size_t faces_to_lose = 0);

class Decimation {
 public:
  Decimation(PlanMesh& mesh, const Envelope& envelope);

  // Returns how many faces went.
  std::size_t pass(const PassPlan& plan, const Workers& workers, Progress& progress);

 private:
  friend class TileDecimation;

  PlanMesh& mesh_;
  const Envelope& envelope_;
  std::vector<std::uint32_t> moves_;   // of a vertex, and of each of its edges put to the test
  std::vector<std::uint8_t> changed_;  // something around the vertex, since its edges were last tested
  std::vector<std::uint8_t> frozen_;   // for this pass
  std::vector<std::int32_t> tile_of_;
};

}  // namespace sightbound
