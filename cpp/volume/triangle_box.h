// SPDX-License-Identifier: GPL-3.0-or-later
// Does a triangle touch a cube of whole numbers? Internal to cpp/volume.
//
// Exact but for a slack: separating axes as Schwarz and Seidel 2010 ("Fast parallel surface and solid
// voxelization on GPUs") sort them: the cube's own (bounding boxes), the triangle's normal, and the three
// projections, where each edge has the cube on one side or not. What depends on the cube's size alone is
// computed once a size. Touching counts, and so does passing by within `slack` along each axis.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "terrain/tin.h"

namespace sightbound {

class TriangleInVoxels {
 public:
  // Corners in voxels; slack in voxels, at least 2^-46 of the largest coordinate: far more than rounding.
  TriangleInVoxels(const std::array<Xyz, 3>& corners, double slack) : slack_(slack) {
    // Near the corner of their box products lose nothing that counts.
    low_ = {least(corners, &Xyz::x), least(corners, &Xyz::y), least(corners, &Xyz::z)};
    base_ = {std::floor(low_.x), std::floor(low_.y), std::floor(low_.z)};
    std::array<Xyz, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = corners[i] - base_;
    low_ = low_ - base_;
    high_ = {largest(p, &Xyz::x), largest(p, &Xyz::y), largest(p, &Xyz::z)};
    extent_ = 1 + std::max({high_.x, high_.y, high_.z});
    const Xyz normal = cross(p[1] - p[0], p[2] - p[0]);
    plane_ = {{normal.x, normal.y, normal.z}, -dot(normal, p[0])};
    project(p, &Xyz::x, &Xyz::y, normal.z, sides_[0]);
    project(p, &Xyz::y, &Xyz::z, normal.x, sides_[1]);
    project(p, &Xyz::z, &Xyz::x, normal.y, sides_[2]);
  }

  // First and last voxel along each axis that it may touch.
  std::array<int, 3> first() const { return range(low_, -slack_); }
  std::array<int, 3> last() const { return range(high_, slack_); }

  // The cube from voxel `from`, so many voxels a side.
  bool touches(const std::array<int, 3>& from, int voxels) const {
    const double size = voxels + 2 * slack_;
    const Xyz at{from[0] - base_.x - slack_, from[1] - base_.y - slack_, from[2] - base_.z - slack_};
    if (at.x > high_.x || at.y > high_.y || at.z > high_.z || at.x + size < low_.x || at.y + size < low_.y ||
        at.z + size < low_.z)
      return false;
    const auto& n = plane_.normal;
    double least = plane_.offset + n[0] * at.x + n[1] * at.y + n[2] * at.z, most = least;
    for (const double component : n) (component > 0 ? most : least) += component * size;
    // A dozen roundings of 2^-53; normals of thin triangles are little else.
    const double of_sides = 0x1p-48 * extent_ * (extent_ + size), of_plane = extent_ * of_sides;
    if (least > of_plane || most < -of_plane) return false;
    return beside(sides_[0], at.x, at.y, size, of_sides) && beside(sides_[1], at.y, at.z, size, of_sides) &&
           beside(sides_[2], at.z, at.x, size, of_sides);
  }

 private:
  struct Plane {
    std::array<double, 3> normal;
    double offset;
  };
  struct Side {  // of an edge in a projection: inside where a u + b v + c >= 0
    double a, b, c;
  };
  using Sides = std::array<Side, 3>;

  static double least(const std::array<Xyz, 3>& p, double Xyz::*axis) {
    return std::min({p[0].*axis, p[1].*axis, p[2].*axis});
  }
  static double largest(const std::array<Xyz, 3>& p, double Xyz::*axis) {
    return std::max({p[0].*axis, p[1].*axis, p[2].*axis});
  }

  // `turn`: the sign says which way round the projection runs.
  static void project(const std::array<Xyz, 3>& p, double Xyz::*u, double Xyz::*v, double turn, Sides& to) {
    const double sign = turn < 0 ? -1 : 1;
    for (std::size_t i = 0; i < 3; ++i) {
      const Xyz &from = p[i], &end = p[(i + 1) % 3];
      const double a = -sign * (end.*v - from.*v), b = sign * (end.*u - from.*u);
      to[i] = {a, b, -(a * from.*u + b * from.*v)};
    }
  }

  // Has the square some place on the inner side of each edge?
  static bool beside(const Sides& sides, double u, double v, double size, double rounding) {
    for (const Side& s : sides) {
      if (s.a * (s.a > 0 ? u + size : u) + s.b * (s.b > 0 ? v + size : v) + s.c < -rounding) return false;
    }
    return true;
  }

  std::array<int, 3> range(const Xyz& of, double slack) const {
    return {static_cast<int>(std::floor(of.x + slack) + base_.x),
            static_cast<int>(std::floor(of.y + slack) + base_.y),
            static_cast<int>(std::floor(of.z + slack) + base_.z)};
  }

  double slack_;
  Xyz base_, low_, high_;  // the box, from base_
  double extent_ = 1;
  Plane plane_{};
  std::array<Sides, 3> sides_{};
};

}  // namespace sightbound
