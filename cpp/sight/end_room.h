// SPDX-License-Identifier: GPL-3.0-or-later
// The ground around an end that may lie anywhere in a box: what is proven of every line that ends there.
//
// Lines between two boxes stay, share for share, within a box around the line between their middles. So a
// clearance of that line less what the others may move down, and sideways up the steepest slopes, over the
// largest sigma_g around, holds for all. Cost: a look-up of faces, and some tens of crossings for each line.
#pragma once

#include <vector>

#include "volume/volume_ray.h"

namespace sightbound {

// All lines between two boxes, told by the one between their middles.
struct LineBundle {
  VolumeLine middle;
  Xyz from_room, to_room;            // half sizes of the boxes
  double drop_spread = 0;            // how far drops differ from the middle's
  double shortest = 0, longest = 0;  // as d is measured
};

class EndRoom {
 public:
  EndRoom() = default;
  // `room`: half sizes of the box around `middle`; 0 = the place itself.
  EndRoom(const ErrorVolume&, const Xyz& middle, const Xyz& room);

  const Xyz& middle() const { return middle_; }
  const Xyz& room() const { return room_; }
  Box3 box() const { return {middle_ - room_, middle_ + room_}; }

  // Proven: every line of the bundle is clear by `ratio` sigma_g within the end zone; all are as far beneath
  // the ground somewhere there. `from_start`: this is where the bundle begins.
  bool clear(const LineBundle&, bool from_start, double ratio) const;
  bool blocked(const LineBundle&, bool from_start, double ratio) const;

 private:
  bool tells(const LineBundle&, bool from_start) const;
  double rise(const Xyz& moved) const { return moved.z + rise_x_ * moved.x + rise_y_ * moved.y; }
  bool clear_in_plan(const LineBundle&, const LinePart&, double ratio) const;
  double between_around(const SurfaceFace&, const Xyz& place, double aside) const;
  bool clear_in_space(const LineBundle&, const LinePart&, double ratio) const;

  const ErrorVolume* volume_ = nullptr;
  const Surface* surface_ = nullptr;
  Xyz middle_, room_;
  std::vector<SurfaceFace> faces_;
  double rise_x_ = 0, rise_y_ = 0;           // steepest slopes along x and y
  double most_between_ = 0, amplitude_ = 0;  // sigma_g, Delta / z(0.95), metres
  bool is_dem_ = false;
};

}  // namespace sightbound
