// SPDX-License-Identifier: GPL-3.0-or-later
// All that has to be drawn and compared on the way of a block of rays, written down once and carried out for
// sixteen realisations at a time.
#pragma once

#include <cstdint>
#include <vector>

#include "sight/bounded_march.h"

namespace sightbound {

// Heights that are known of a line stand in slots; a later line takes them over.
struct SightPlan {
  using Slot = std::uint32_t;
  struct Sample {
    SampleDraw draw;
    Slot slot;
  };
  struct Node : NodeOf<Slot> {
    Slot slot;
  };
  // Of a ray: ground between two nodes, a share `part` of the way from a to b.
  struct Place {
    RaySlope slope;
    float part;
    Departure across;
    Slot a, b;
    std::uint32_t ray;
  };
  // The ray goes on to there.
  struct Crossing : Place {
    std::uint32_t fine;  // first of the places between the last crossing and this
    Fineness fineness;
  };
  struct Target {
    RaySlope slope;
    Slot ground;
    std::uint32_t ray, fine, item;  // where the answer goes
    Layers layers;
    Fineness fineness;
    bool behind_unknown;
  };
  // Ends of what belongs to a line; it is carried out in this order.
  struct Line {
    std::uint32_t samples, nodes, targets, rows, crossings;
  };

  std::vector<Line> lines;
  std::vector<Sample> samples;
  std::vector<Node> nodes;
  std::vector<Target> targets;
  std::vector<Place> rows;  // between the line before and this
  std::vector<Crossing> crossings;
  std::vector<FinePlace> fine;
  StepLaw steps;  // of what departs between two places
  int rays = 0;
  Slot slots = 0;
};

// `item_of`: where the answer about a cell goes.
SightPlan write_plan(const BoundedMarch&, const RayFan&, const RealisedColumns&, const FineGround&,
                     const Refinement&, const std::function<std::uint32_t(int row, int col)>& item_of);

// What sixteen eyes stand on and are.
struct SixteenEyes {
  Lanes ground, eye;  // absolute heights
};

// Bit l of `open_holes`: sight crosses unknown ground in realisation first + l. Bit l of seen[(item + layer)
// stride]: seen in realisation first + l. Bits are added to those that are there.
struct SeenBits {
  std::uint16_t* bits;
  std::size_t stride;
};
class PlanRunner {
 public:
  void run(const SightPlan&, const SixteenEyes&, const std::vector<float>& heights, std::uint32_t first,
           std::uint16_t open_holes, const SeenBits&);

 private:
  std::vector<Lanes> slots_, horizons_, places_;  // of lines; of rays; of rays
};

}  // namespace sightbound
