// SPDX-License-Identifier: GPL-3.0-or-later
// The terrain with as few triangles as can be had, nowhere further from the original than its tolerance.
//
// At every place of the original's footprint, inside triangles as well as at samples,
//   |height of the simplified TIN - height of the original| <= tolerance there,
// where the original is the regular TIN of a DEM (dem.h) and the tolerance is a constant or linear on each of
// its triangles. The footprint stays, holes and islands of nodata too (but for what a border tolerance lets
// go); no triangle is turned over, folded or without area. A tolerance of 0 removes only what is coplanar.
// All this of coordinates as written, which are doubles (place_rounding.h). The same bytes for any number of
// threads. Method, and what is certified: docs/algorithms/simplify.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/progress.h"
#include "simplify/dem_windows.h"
#include "simplify/line_chain.h"
#include "terrain/geotransform.h"
#include "terrain/grid.h"
#include "terrain/tin.h"

namespace sightbound {

// Where a DEM lies.
struct DemPlace {
  Geotransform geotransform;   // of its rows in the core's order (dem.h)
  double metres_per_unit = 1;  // of the CRS in plan: the CRS must be projected
  std::string crs_wkt;
};

// A DEM in memory, or a window of one (dem.h): heights in the core's row order.
struct DemTerrain {
  const Grid<float>& heights;  // metres, NaN = nodata
  Geotransform geotransform;   // of the same window
  double metres_per_unit = 1;
  std::string crs_wkt;
};

struct SimplifyOptions {
  double tolerance_m = 1;    // the same everywhere, unless:
  Grid<float> tolerance;     // of each sample, metres, linear on each triangle; empty = tolerance_m
  Grid<std::uint8_t> keep;   // samples that stay vertices at their own height where not 0; empty = none
  bool keep_border = false;  // all samples of the outline and of holes stay: neighbouring tiles fit
  // By how many metres the outline may move in plan, that of holes too; the raster's corners stay. Where it
  // advances over what has no terrain, heights are those of the triangles beside.
  double border_tolerance_m = 0;
  // Edges that stay edges but for vertices between them, each longer one within so many metres of those it
  // stands for (line_chain.h: in order, each once).
  std::vector<LineEdge> break_lines;
  double break_line_tolerance_m = 0;
  // Stop as soon as there are no more faces, give or take one, what is cheap everywhere first; or as soon as
  // vertices and faces take no more bytes. 0 = until nothing can be removed. The tolerance may leave more.
  std::int64_t target_faces = 0;
  struct Bytes {
    double most = 0;
    double of_vertex = 32, of_face = 21;  // a binary PLY's
  } target_bytes;
  // Passes go on as long as one removes this part of the faces left (four at least). Smaller: fewer faces,
  // more time (docs/performance.md).
  double least_gain = 0.01;
  std::size_t memory_bytes = 0;  // budget; 0 = three quarters of the memory usable
  int threads = 0;               // 0 = all
  // Cells a side of what is worked on at once: larger ones hold more memory, smaller ones have more seams to
  // come back to. And the samples that are read at once, a row of blocks at least. The result depends on
  // both.
  int block = 256;
  std::int64_t samples_at_once = 1 << 23;
};

struct SimplifyReport {
  std::size_t faces_before = 0, faces_after = 0;
  double largest_deviation_m = 0;  // certified: nowhere more
  double largest_ratio = 0;        // of deviation to tolerance, certified; 0 where both are 0
  // Of the tolerance, largest anywhere. On triangles of the DEM with a corner whose tolerance is less the
  // result, as written, may be beyond it by as much, and largest_ratio does not tell of them.
  double kept_for_rounding_m = 0;
  std::size_t break_line_edges_lost = 0;  // that have no terrain on either side
};

struct SimplifiedTin {
  // Faces up. Origin and units as regular_tin() has them (regular_tin.h). Face attributes: "deviation", the
  // largest on that face, metres, and "bound_used", the largest of deviation / tolerance there, both rounded
  // up. Vertex attributes: "tolerance" there, metres, and "deviation_around", the largest of the
  // faces around it.
  Tin tin;
  SimplifyReport report;
  // Of a hierarchy: the vertex of the next TIN, the coarser one, that each vertex was drawn into. Faces whose
  // corners all become different ones are the faces of that TIN; the others have vanished. Empty in the last.
  std::vector<std::int32_t> coarser_vertex;
};

// Reads the DEM as it goes along, some eight times, and holds a band of its rows, 11 MiB a thread, and 72
// bytes for each face that the first pass leaves: on rough ground some 70,000 for a million samples at 5 m.
// Tolerance and samples to keep are those of the windows: a `tolerance_m` holds where they bring none. Throws
// InvalidInput (a tolerance that is negative or not finite, a height or coordinate beyond 1e9, cells or a
// tolerance too small for coordinates as doubles, fewer than 2 x 2 samples, no triangle, sizes that do not
// agree, more than 2^20 samples a side), OverBudget (as soon as what is left does
// not fit, or is more than 2^29 faces), Cancelled. On rough ground 16 microseconds of processor a sample for
// a tolerance of 5 m, 60 for 1 m (docs/performance.md). Advances `progress` by 1 in all.
SimplifiedTin simplify_dem(DemWindows&, const DemPlace&, const SimplifyOptions&, Progress&);

// Without vertices and faces, but with the names of all attributes that a simplified DEM has.
Tin empty_simplified_tin(const std::string& crs_wkt);

// A hierarchy: one TIN for each factor, within so many times the tolerance, each made from the one before.
// The factors ascend and begin with 1; no target goes with them.
std::vector<SimplifiedTin> simplify_dem_levels(DemWindows&, const DemPlace&, const SimplifyOptions&,
                                               std::span<const double> factors, Progress&);

// The same of a DEM in memory.
SimplifiedTin simplify_dem(const DemTerrain&, const SimplifyOptions&, Progress&);
std::vector<SimplifiedTin> simplify_dem_levels(const DemTerrain&, const SimplifyOptions&,
                                               std::span<const double> factors, Progress&);

}  // namespace sightbound
