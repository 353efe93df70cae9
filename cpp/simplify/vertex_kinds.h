// SPDX-License-Identifier: GPL-3.0-or-later
// What may become of each vertex, by where it lies.
#pragma once

#include <cstdint>

#include "simplify/plan_mesh.h"

namespace sightbound {

struct KindRules {
  int rows = 0, cols = 0;     // of the raster: its corners stay
  bool keep_border = false;   // so does all of the outline
  bool border_moves = false;  // else only what is straight may go, or what keeps to a tolerance
};

// Of a vertex that is a sample still. O(neighbours).
VertexKind kind_of(const PlanMesh&, std::int32_t vertex, const KindRules&);

}  // namespace sightbound
