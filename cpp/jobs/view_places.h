// SPDX-License-Identifier: GPL-3.0-or-later
// Where observers may be (points, patrol areas with a height range), as places that a volume viewshed looks
// from.
#pragma once

#include <string>
#include <vector>

#include "jobs/viewshed_job.h"
#include "sight/view_tree.h"
#include "sight/volume_sight.h"
#include "volume/surface.h"

namespace sightbound {

struct ViewVolume {
  // CRS; one place alone, or the rings of polygons, each its corners (closed or not): inside is what an odd
  // number of rings goes round, so that holes are rings like any other.
  std::vector<std::vector<Xy>> rings;
  double height_from = 1.7, height_to = 1.7;  // metres, above ground or absolute
  std::string name;                           // for messages; empty = its number
};

struct ViewPlaces {
  std::vector<ViewPlace> places;     // local metres
  std::vector<std::string> as_json;  // one a view volume, with all that it was asked with
  std::vector<std::string> warnings;
};

// A point is one place, or several above one another, at most `spacing_m` apart, both ends of the height
// range among them. A polygon has places at the middles of squares of that side (half as large, again and
// again, until one lies inside, holes left out). A place's cell is all that it stands for: its square, with
// what of the polygon lies in squares beside it, as high as the ground there takes the height range. Above
// ground counts from the highest of the terrain there: who is set on a bridge stands on it. `spacing_m` 0: an
// eighth of each polygon's longer side, at least `least_m`. Throws InvalidInput naming view, field, value: no
// rings, a point off the terrain, a height that is not finite, from above to; a polygon with no place on the
// terrain.
ViewPlaces view_places(const Surface&, const std::vector<ViewVolume>&, HeightReference, double spacing_m,
                       double least_m = 0);

// The bend of the ground under the volume's frame, as the ellipsoid of its CRS has it at the middle of the
// terrain.
GroundBend ground_bend(const Surface&, double refraction);

}  // namespace sightbound
