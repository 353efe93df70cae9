// SPDX-License-Identifier: GPL-3.0-or-later
// A face as the nearest part of the terrain to all places of a box (distance along the normal). Internal to
// cpp/volume.
//
// For a box with centre c and half size h, and a face in the plane with unit normal n:
//   - the nearest place of the face to any place of the box is the nearest to its projection q onto the
//   plane, and projections lie
//     within rho (the box's half size seen along n) of c's. Nearest places move no further than what they are
//     nearest to, so they all lie within rho of the one of c: sigma_s and d, which change at known rates, are
//     bounded there;
//   - which parts of the face (its inside, an edge, a corner) can be nearest follows from where q lies, give
//   or take rho;
//   - the side of the terrain a place lies on is that of its nearest part: the sign of (x - nearest) . m, m
//   the sum of the normals of the
//     faces at that part, weighted by their angles (Baerentzen and Aanaes 2005). Its range over the box tells
//     whether the sign is one.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "volume/ratio_interval.h"
#include "volume/tin_surface.h"

namespace sightbound {

// What is known of k for the places of a box that are nearest to this face.
struct RatioBounds {
  double low, high;
  bool ambiguous = false;  // the nearest part may be a border, which has no sides

  void enlarge(const RatioBounds& other);
};

struct BoxOf {
  Xyz centre, half;
  double radius;  // half the diagonal
};

// The faces of a TIN with the normals of their parts. 250 bytes a face.
class FaceDistances {
 public:
  explicit FaceDistances(const TinSurface& surface);

  // Bounds of the distance (>= 0) of the box's places to the face: of the nearest place of the box, of the
  // furthest.
  struct Distance {
    double nearest = 0, furthest = 0;
  };
  Distance distance(std::size_t face, const BoxOf& box) const;

  // No place of the box is nearer to the face than this; cheap.
  double at_least(std::size_t face, const BoxOf& box) const {
    const Ready& f = faces_[face];
    return norm(box.centre - f.middle) - f.radius - box.radius;
  }

  // Bounds of k over those places of the box that have their nearest part on this face, none further than
  // `furthest`.
  RatioBounds bounds(std::size_t face, const BoxOf& box, double furthest) const;

  // Unit.
  const Xyz& normal(std::size_t face) const { return faces_[face].normal; }
  // The largest sigma on the face.
  double largest_sigma(std::size_t face) const { return faces_[face].largest_sigma; }
  // Side of the terrain that a place lies on whose nearest place is on this face: +1, -1, or 0 on the terrain
  // or at a border.
  int side(std::size_t face, const Xyz& place) const;

 private:
  struct Ready {
    std::array<Xyz, 3> corner;
    Xyz normal;  // unit
    Xyz middle;  // of a ball that holds the face
    double radius = 0;
    std::array<Xyz, 3> along, outward;  // of edge i from corner i: unit vectors in the plane
    std::array<double, 3> length;
    std::array<Xyz, 3> edge_normal, corner_normal;  // m; 0 at a border
    std::array<double, 3> sampling;
    double sampling_rate = 0, amplitude_low = 0, amplitude_high = 0, amplitude_rate = 0;  // rates per metre
    std::array<double, 3> amplitude;
    double largest_sigma = 0;
  };
  struct Projected {
    double height;         // of the box's centre above the plane
    double reach, radius;  // half size of the box along the normal; rho
    std::array<double, 3> out,
        along;     // of the centre's projection: beyond edge i, and from corner i along it
    Xyz closest;   // on the face
    double aside;  // distance of the projection from the face, in the plane
  };
  Projected project(const Ready& face, const BoxOf& box) const;

  std::vector<Ready> faces_;
  GrowthProfile profile_;
};

}  // namespace sightbound
