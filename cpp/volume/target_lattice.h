// SPDX-License-Identifier: GPL-3.0-or-later
// The places that a volume viewshed asks about: the centres of the voxels of a regular lattice above ground.
//
// Coordinates are the local metres of the volume's frame (surface.h). Target (i, j, k) is the box
// [i, i + 1] x [j, j + 1] spacings, [k, k + 1] height spacings from the corner; its centre stands for it. The
// lattice is that of the volume viewshed alone: its spacing has nothing to do with the volume's voxels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "volume/surface.h"

namespace sightbound {

struct TargetColumn {
  float ground = 0;          // height of the ground at the column's centre, metres; NaN = none known
  int first = 0, last = -1;  // layers asked about, both included; last < first = none

  int size() const { return last < first ? 0 : last - first + 1; }
  friend bool operator==(const TargetColumn&, const TargetColumn&) = default;
};

struct TargetLattice {
  VolumeFrame frame;
  Xyz corner;  // of target (0, 0, 0), local metres; its height above the ground where layers follow that
  double spacing_m = 0, height_spacing_m = 0;
  double ceiling_m = 0;         // above ground, up to which columns were asked to reach
  bool follows_ground = false;  // one layer at a height above each column's ground, without thickness
  int nx = 0, ny = 0;
  std::vector<TargetColumn> columns;  // nx * ny; column (i, j) is number j * nx + i

  std::size_t number(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(i);
  }
  const TargetColumn& column(int i, int j) const { return columns[number(i, j)]; }
  double height_of(int k) const { return corner.z + (k + 0.5) * height_spacing_m; }  // of a layer's centres
  Xyz centre(int i, int j, int k) const {
    const double base = follows_ground ? static_cast<double>(column(i, j).ground) : 0;
    return {corner.x + (i + 0.5) * spacing_m, corner.y + (j + 0.5) * spacing_m, base + height_of(k)};
  }
  double column_m2() const { return spacing_m * spacing_m; }
  double target_m3() const { return column_m2() * height_spacing_m; }
  std::size_t targets() const;  // that are asked about, over all columns

  // The asked layers that a thing of this height on the ground reaches into, the first always among them:
  // [column.first, top]; first - 1 where nothing is asked. 0 < height_m <= ceiling_m.
  int top_layer(const TargetColumn&, double height_m) const;
};
// Of all fields, exactly.
bool operator==(const TargetLattice&, const TargetLattice&);

// Heights of the terrain over a plan place: the ground (the lowest face there, of solids the lowest that
// looks up) and the highest; NaN where there is none.
struct TerrainSpan {
  double ground = std::numeric_limits<double>::quiet_NaN(), highest = ground;
};
// `numbers` is room to work in.
TerrainSpan terrain_over(const Surface&, double x, double y, std::vector<std::uint32_t>& numbers);

// The lowest and the highest of all terrain over a rectangle (z of the box is not looked at), in `ground` and
// `highest`; NaN where there is none.
TerrainSpan terrain_within(const Surface&, const Box3& plan, std::vector<std::uint32_t>& numbers);

struct LatticeOptions {
  double spacing_m = 10;        // in plan
  double height_spacing_m = 0;  // 0 = the lesser of spacing_m and a quarter of the ceiling
  double ceiling_m = 20;        // above ground
};

// Over the whole surface: every layer whose centre is on or above the ground at the column's centre and not
// more than the ceiling above the highest of the terrain there (a bridge's deck). Columns without terrain at
// their centre ask nothing. The corner is a whole number of spacings from the frame's origin. Advances
// `progress` by 1 in all. Throws InvalidInput (field, value, allowed range; more than 2^31 - 1 columns),
// Cancelled.
std::shared_ptr<const TargetLattice> lattice_above(const Surface&, const LatticeOptions&, const Workers&,
                                                   Progress&);

// The same columns with one target each, `height_m` (0.001 to 1e6 m) above the highest of the terrain at the
// column's centre: who is asked about on a bridge stands on it.
std::shared_ptr<const TargetLattice> layer_above(const Surface&, double spacing_m, double height_m,
                                                 const Workers&, Progress&);

// One target alone, and the ground beneath it. No Surface is asked.
TargetLattice lattice_of(const Xyz& target, double ground);

}  // namespace sightbound
