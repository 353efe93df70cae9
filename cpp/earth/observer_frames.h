// SPDX-License-Identifier: GPL-3.0-or-later
// The frames of one observer, one for each doubling of the distance in samples. What is found of a place then
// depends on observer, place and raster alone, to the last bit, however far a job reaches (a polynomial
// depends on what it is fitted to). Cost: that of ObserverFrame for each doubling.
#pragma once

#include <vector>

#include "earth/observer_frame.h"

namespace sightbound {

class ObserverFrames {
 public:
  // `raster` (whole) and `reach` (all places that will be asked for) in the coordinates of the georeference;
  // the observer is at (col, row), both in [0, 1]. Throws InvalidInput as ObserverFrame does for `reach`.
  ObserverFrames(const Georeference&, double col, double row, const Window& raster, const Window& reach);

  // The frame that covers the whole reach.
  const ObserverFrame& widest() const { return rings_.back(); }
  // The frame that answers for a place within reach.
  const ObserverFrame& of(double col, double row) const;

 private:
  std::vector<ObserverFrame> rings_;
};

}  // namespace sightbound
