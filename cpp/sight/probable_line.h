// SPDX-License-Identifier: GPL-3.0-or-later
// The probability that a whole sight line is clear, over the terrains that could lie behind a DEM: those of
// the probable viewshed (the same seed draws the same ground), but for the line itself instead of a ray near
// to it.
//
// A realisation is clear when the line lies nowhere below the ground, at its crossings with the half-cell
// lines of nodes and on fine ground near both ends, whichever is the observer. Unknown ground is open or
// closed to sight by a coin thrown for each realisation. Cost: for each sixteen realisations some 0.8 us a
// cell of the line.
#pragma once

#include <cstdint>
#include <vector>

#include "sight/fine_ground.h"
#include "sight/line_over_nodes.h"
#include "sight/realised_columns.h"

namespace sightbound {

struct LineDoubt {
  double eye_ground = 0, target_ground = 0;  // of the DEM under the ends, metres
  bool ends_move = true;  // stand = ground: both ends rise and fall with the ground drawn under them
  // Radio: the share of the first Fresnel zone that is to be clear too; wavelength in metres, 0 = none.
  double wavelength = 0, zone_share = 0.6;
};

// A place where the line is compared with the ground. Heights are metres over `datum`.
struct DoubtfulPlace {
  double share = 0;                     // of the distance
  float line = 0;                       // the line's height while both ends are where the DEM has them
  float with_eye = 0, with_target = 0;  // by what share of an end's rise it rises (or the ground sinks)
  float zone = 0;                       // metres to keep clear for radio
  bool judged = true;                   // not: an end, or unknown ground that sight may cross
  bool unknown = false;                 // crossed in half of the realisations
};

// A node and the numbers of its parents among the sources.
using LineNode = NodeOf<int>;

// Half-way between two places, given by number.
struct FineHalf {
  int a, b;
  Departure draw;
};

// What is drawn and compared. Heights are over `datum`.
struct LineInDoubt {
  LineInDoubt(const Scene&, const OpenTerrain&, const RealisedColumns&, const Eye&, const Target&,
              const LineDoubt&);

  double distance() const { return over.distance; }
  // From the base sample.
  double col(std::size_t i) const { return over.transposed ? where[i].minor : where[i].major; }
  double row(std::size_t i) const { return over.transposed ? where[i].major : where[i].minor; }

  LineOverNodes over;
  bool normal;  // all that is drawn: independent, and no draw's spread depends on another
  StepLaw steps;
  std::uint64_t seed;
  double datum;
  double eye_ground, target_ground;  // of the DEM at the ends
  std::vector<SampleDraw> sources;   // samples, and centres of squares
  std::vector<LineNode> nodes;       // as `over` numbers them
  std::vector<Departure> across;     // of the places of `over`, from the line between their nodes
  std::vector<FineHalf> fine;
  // First the places of `over`, then those of `fine`.
  std::vector<RayPlace> where;
  std::vector<DoubtfulPlace> places;

 private:
  void find_nodes(const RealisedColumns&);
  void find_fine(const FineGround&);
};

struct LineCounts {
  int realisations = 0, clear = 0;
  int zone_clear = 0;        // the zone's share too
  std::vector<int> blocked;  // of each place: realisations whose ground rises above the line there
};

// The realisations are those from 0 on.
LineCounts count_clear(const LineInDoubt&, int realisations);

}  // namespace sightbound
