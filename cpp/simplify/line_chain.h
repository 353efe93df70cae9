// SPDX-License-Identifier: GPL-3.0-or-later
// Break lines as edges of the regular TIN.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "simplify/plan_mesh.h"
#include "terrain/geotransform.h"
#include "terrain/grid.h"

namespace sightbound {

// From a sample to the next one in a direction.
struct LineEdge {
  std::int32_t row = 0, col = 0;
  LineBits direction = kLineEast;

  friend auto operator<=>(const LineEdge&, const LineEdge&) = default;
};

// The edges that follow lines given by their places (columns and rows, samples at whole numbers), in order,
// each once. From each sample of a chain the next one is nearest to the line, so that all are within 0.71
// cells of it; where it runs from southwest to northeast, in which direction there are no edges, the samples
// between two are within a cell. What lies off the raster is left out. Throws InvalidInput (places that are
// not finite).
std::vector<LineEdge> line_chains(std::span<const std::vector<Xy>> lines, int rows, int cols);

// The LineBits of a window's samples, of edges wholly in it; empty where there are none.
Grid<std::uint8_t> line_bits(std::span<const LineEdge> edges, const Window& window);

}  // namespace sightbound
