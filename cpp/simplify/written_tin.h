// SPDX-License-Identifier: GPL-3.0-or-later
// From the mesh in raster coordinates to a TIN in those of the CRS.
#pragma once

#include <cstdint>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "simplify/originals.h"
#include "simplify/plan_mesh.h"
#include "simplify/simplify.h"

namespace sightbound {

struct WrittenTin {
  SimplifiedTin made;
  std::vector<std::int32_t> number;  // of each vertex of the mesh in the TIN
};

// Faces up, with all attributes; fills in what the report says of them. The mesh is compact.
WrittenTin written_tin(const PlanMesh& mesh, const DemPlace& place, Originals& originals,
                       const Workers& workers, Progress& progress);

}  // namespace sightbound
