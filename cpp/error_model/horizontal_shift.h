// SPDX-License-Identifier: GPL-3.0-or-later
// How far a DEM lies beside the truth.
//
// A surface that is shifted sideways is wrong by the shift times the slope towards it, in the manner of
// Nuth & Kaab (2011), The Cryosphere 5, 271-290:
//
//   dh / tan(slope) = a cos(b - aspect) + c          theirs; a = size of the shift, b = its direction
//   dh = dz - x dz/dx - y dz/dy                      the same times tan(slope), which flat ground can bear
//
// fitted by least squares with Huber's weights, and again at the places found, until nothing moves.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "terrain/geotransform.h"

namespace sightbound {

// One place of both surfaces, compared with the shift assumed so far taken off.
struct ShiftPlace {
  double error = 0;             // DEM minus truth, metres
  double per_x = 0, per_y = 0;  // rise of the ground per metre along x and y
  int block = 0;                // neighbourhood; errors of one may depend on each other
};

struct HorizontalShift {
  double x = 0, y = 0, z = 0;           // metres: the DEM at (p + x, q + y), less z, is the truth at (p, q)
  double se_x = 0, se_y = 0, se_z = 0;  // standard errors; what errors of one block share is in them
  double nmad_before = 0, nmad_after = 0;
  int rounds = 0;

  // Is it more than chance (three standard errors), and do heights agree better without it (by 2 %)? The
  // second, because noise in the DEM's own slopes makes the standard errors too small.
  bool is_significant() const;
};

// `at` compares both surfaces with a shift (x, y) in metres taken off. Empty when the ground is too flat or
// the places too few to say, or the search leads away farther than `farthest` metres. Precision: 1e-4 of
// `cell` metres.
std::optional<HorizontalShift> find_shift(const std::function<std::vector<ShiftPlace>(Xy)>& at, double cell,
                                          double farthest);

}  // namespace sightbound
