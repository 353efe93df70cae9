// SPDX-License-Identifier: GPL-3.0-or-later
// Where an observer stands on the DEM and how far he can be asked to look.
#pragma once

#include <optional>
#include <string>

#include "earth/observer_frames.h"
#include "jobs/viewshed_job.h"

namespace sightbound {

// "Observer 3" or "Observer 'tower'".
std::string name_of(const Observer&, std::size_t index);

// Throws InvalidInput naming observer, field, value and allowed range.
void validate(const Observer&, const std::string& name);
void validate(const ViewshedOptions&);

// A position on the DEM: the base sample in the whole raster, and the offset from it in [0, 1).
struct GridPlace {
  int base_col = 0, base_row = 0;
  double col = 0, row = 0;

  double whole_col() const { return base_col + col; }
  double whole_row() const { return base_row + row; }
};

// Throws InvalidInput when (x, y) is outside the DEM. In the outer half of a border cell the place on the rim
// of the samples is taken, since the terrain ends there.
GridPlace place_on(const DemSource&, double x, double y, const std::string& name);
// The same without a complaint.
std::optional<GridPlace> find_on(const DemSource&, double x, double y);

// All samples within `distance_m` of the place (and some more), in the whole raster.
Window reach_of(const DemSource&, const Georeference&, const GridPlace&, double distance_m);

// The smallest part of `reach` that holds every sample within `distance_m`.
Window samples_within(const ObserverFrame&, const GridPlace&, const Window& reach, double distance_m);

// The observer's frame over `reach` (whole raster), in coordinates from his base sample: a function of place
// and reach.
ObserverFrame frame_of(const Georeference&, const GridPlace&, const Window& reach);
// The same as rings, a function of place and raster alone as far as they reach.
ObserverFrames frames_of(const DemSource&, const Georeference&, const GridPlace&, const Window& reach);

// What must be in memory for lines from the observer to anywhere in `targets`: both, and room for lines that
// bow.
Window lines_window(const DemSource&, const ObserverFrame&, const GridPlace&, const Window& targets);

}  // namespace sightbound
