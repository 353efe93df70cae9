// SPDX-License-Identifier: GPL-3.0-or-later
// The faces around an end of a line, any TIN (distance along the normal): what they prove of the line there.
//
// sigma_g alone counts (at least 1 mm). Visible: the line meets no face, and stays clear of them by sigma_g
// at 1/16, 1/8, 1/4, 1/2 and 3/4 L from the end. Hidden: solids: it is inside, that far from all faces;
// sheets: it goes through, from that far on one side to that far on the other, away from borders. All else is
// left open. Cost: some tens of crossings; where it meets faces, some tens of nearest places.
#pragma once

#include <cstdint>
#include <vector>

#include "volume/tin_surface.h"
#include "volume/volume_ray.h"

namespace sightbound {

class EndFaces {
 public:
  // Within `reach` metres of the end in each direction. Keeps a pointer.
  EndFaces(const TinSurface&, const Xyz& place, double reach);

  // Bounds of k* between t0 and t1, which lie within reach; `judged`: shares of the line beside them.
  RatioInterval least(const VolumeLine&, double t0, double t1, const std::vector<double>& judged,
                      float beyond) const;

 private:
  struct Crossing {
    double t;  // between the part's ends
    int turn;  // +1: out through the face, as its normal; -1: in
  };
  struct Part {
    Xyz from, along;
    Xyz at(double t) const { return from + t * along; }
  };

  std::vector<Crossing> crossings(const Part&, const std::vector<std::uint32_t>& faces) const;
  bool lies_inside(const Xyz& place) const;
  double between(std::size_t face, const Xyz& on_it) const;
  double ratio(const Xyz& place) const;        // of the nearest place, abs
  double least_ratio(const Xyz& place) const;  // of all faces, never above ratio()
  double border_distance(const Xyz& place) const;
  double inside_by(const Part&, const std::vector<Crossing>&) const;
  double through_by(const Part&, const std::vector<Crossing>&) const;

  const TinSurface* surface_;
  Xyz place_;
  double reach_;
  std::vector<std::uint32_t> faces_;
  bool inside_;
};

}  // namespace sightbound
