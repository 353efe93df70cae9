// SPDX-License-Identifier: GPL-3.0-or-later
// What a hidden volume means on the ground: area that hides a thing of some height, the largest hiding
// places, rasters, and its top as a mesh.
//
// A column hides a thing of height h when every layer that it reaches into (TargetLattice::top_layer; layers
// without a verdict aside, one with a verdict at least) is not visible; it surely hides it when every one is
// surely hidden. Areas are in the plan of the CRS, metres.
#pragma once

#include <cstddef>
#include <vector>

#include "terrain/geotransform.h"
#include "terrain/grid.h"
#include "terrain/tin.h"
#include "volume/hidden_volume.h"

namespace sightbound {

struct HiddenArea {
  double asked_m2 = 0;   // of columns with a verdict
  double hidden_m2 = 0;  // not visible up to the height
  double core_m2 = 0;    // surely hidden up to it
};
// Throws InvalidInput for a height outside (0, ceiling].
HiddenArea hidden_area(const HiddenVolume&, double height_m);

enum class Hiding { kNotVisible, kSurelyHidden };

// Columns that hide a thing of the height asked and touch by a side.
struct HiddenPlace {
  double area_m2 = 0;
  double volume_m3 = 0;  // of all that is not visible (surely hidden) over these columns, up to the ceiling
  double centroid_x = 0, centroid_y = 0;  // CRS; mean of the columns' centres, may lie outside a bent place
  double deepest_x = 0, deepest_y = 0;    // CRS; the column with the thickest hidden layer
  double depth_m = 0;                     // its thickness
};
// Largest area first (of equal ones the southernmost, then westernmost first column), at most `most` of them.
std::vector<HiddenPlace> hidden_places(const HiddenVolume&, double height_m, Hiding, std::size_t most);

// North up: row 0 is the northernmost, j = ny - 1.
Geotransform geotransform_of(const TargetLattice&);
struct HiddenRasters {
  // Height above ground of the lowest target that is visible and has none above it that is not, metres; NaN
  // where there is none up to the ceiling, or nothing is asked. True lowest visible heights are at most one
  // height spacing lower.
  Grid<float> lowest_visible_height;
  Grid<float> thickness;       // of all that is not visible, metres; 0 = all is visible, NaN = nothing asked
  Grid<float> core_thickness;  // of the surely hidden, metres
};
HiddenRasters rasters_of(const HiddenVolume&);

// The top of the hidden volume: over each column with some target that is not visible a square at the upper
// side of the highest of these; corners of neighbours meet at their mean height. A height field with normals
// up, clean, origin set; vertex attributes "p" (least p of the column, mean of the columns that meet) and
// "thickness" (m). Throws InvalidInput when nothing is hidden.
Tin top_of(const HiddenVolume&);

}  // namespace sightbound
