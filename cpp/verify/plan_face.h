// SPDX-License-Identifier: GPL-3.0-or-later
// Faces as they lie in plan: cutting them to one another, and bounds of the heights on the pieces.
//
// A cut moves its line outward by a margin larger than the rounding of all that is computed here, so the
// polygon that comes out holds all of the true piece but a rim thinner than the rounding, which the slack of
// heights pays for. Notation: u = 2^-53, M = the largest coordinate in plan, w = the least height of a
// triangle in plan, G = (rise over the triangle) / w, at least its slope.
//   a place in this frame                     16 u M
//   signed distance of a place from a side    6 u 2M       all three < margin = 2^-46 M = 128 u M
//   a cut's place                             2 u M
//   height at a place by barycentric weights  34 u M G     < G margin
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "base/error.h"
#include "terrain/geotransform.h"
#include "terrain/tin.h"

namespace sightbound {

// Outward of all cuts, for coordinates of at most M.
inline double plan_margin(double largest_coordinate) { return 0x1p-46 * largest_coordinate; }

// Twice the area, positive when counterclockwise.
inline double plan_cross(const Xy& a, const Xy& b, const Xy& c) {
  return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
}

struct PlanBox {
  Xy low, high;

  bool meets(const PlanBox& o) const {
    return low.x <= o.high.x && o.low.x <= high.x && low.y <= o.high.y && o.low.y <= high.y;
  }
};

// A face turned counterclockwise in plan, with what is asked of it again and again.
struct PlanFace {
  std::array<Xy, 3> corner;
  std::array<double, 3> z{};      // metres
  std::array<double, 3> per_m{};  // 1 / length of the side from corner i to the next
  double twice_area = 0;          // of the turned face; 0 for one without width: it has no inside
  bool is_flipped = false;        // it was clockwise
  double steepness = 0;           // G
  double perimeter = 0;           // metres
  PlanBox box;

  PlanFace() = default;
  PlanFace(const Xyz& a, const Xyz& b, const Xyz& c, double margin);

  // Metres inside the side from corner i; negative outside.
  double inside(std::size_t i, const Xy& p) const {
    return plan_cross(corner[i], corner[(i + 1) % 3], p) * per_m[i];
  }
  // Linear in the numbers at the corners.
  double at(const Xy& p, const std::array<double, 3>& values) const {
    const double b = plan_cross(corner[2], corner[0], p) / twice_area;
    const double c = plan_cross(corner[0], corner[1], p) / twice_area;
    return values[0] + (b * (values[1] - values[0]) + c * (values[2] - values[0]));
  }
  double height(const Xy& p) const { return at(p, z); }
};

inline PlanFace::PlanFace(const Xyz& a, const Xyz& b, const Xyz& c, double margin)
    : corner{{{a.x, a.y}, {b.x, b.y}, {c.x, c.y}}}, z{a.z, b.z, c.z} {
  twice_area = plan_cross(corner[0], corner[1], corner[2]);
  is_flipped = twice_area < 0;
  if (is_flipped) {
    std::swap(corner[1], corner[2]);
    std::swap(z[1], z[2]);
    twice_area = -twice_area;
  }
  double longest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Xy &p = corner[i], &q = corner[(i + 1) % 3];
    const double side = std::hypot(q.x - p.x, q.y - p.y);
    per_m[i] = side > 0 ? 1 / side : 0;
    longest = std::max(longest, side);
    perimeter += side;
  }
  const auto [west, east] = std::minmax({a.x, b.x, c.x});
  const auto [south, north] = std::minmax({a.y, b.y, c.y});
  box = {{west, south}, {east, north}};
  if (!(twice_area > 2 * margin * longest)) {  // narrower than what rounding leaves
    twice_area = 0;
    is_flipped = false;
    return;
  }
  const auto [least, largest] = std::minmax({a.z, b.z, c.z});
  steepness = (largest - least) * longest / twice_area;
}

// Convex, counterclockwise. A triangle cut by the three sides of another has six corners at most; were
// rounding to turn signs as badly as it can, a cut would make half as many again: 3, 4, 6, 9.
class PlanPolygon {
 public:
  PlanPolygon() {}  // NOLINT: the corners are left as they are, most are never used
  explicit PlanPolygon(const PlanFace& face) {
    for (const Xy& corner : face.corner) add(corner);
  }
  PlanPolygon(const PlanPolygon& other) { *this = other; }
  PlanPolygon& operator=(const PlanPolygon& other) {
    count_ = other.count_;
    std::copy_n(other.x_.begin(), count_, x_.begin());
    std::copy_n(other.y_.begin(), count_, y_.begin());
    return *this;
  }

  std::size_t size() const { return count_; }
  bool empty() const { return count_ < 3; }
  Xy operator[](std::size_t n) const { return {x_[n], y_[n]}; }
  double area() const {
    double twice = 0;
    for (std::size_t n = 2; n < count_; ++n) twice += plan_cross((*this)[0], (*this)[n - 1], (*this)[n]);
    return std::max(0.5 * twice, 0.0);
  }
  // Its first corner, and those from `first` to `last`.
  PlanPolygon part(std::size_t first, std::size_t last) const {
    PlanPolygon some;
    some.add((*this)[0]);
    for (std::size_t n = first; n <= last; ++n) some.add((*this)[n]);
    return some;
  }

  // What of it lies at least -margin inside a side of the face (`sign` 1), or outside of it (-1).
  PlanPolygon cut(const PlanFace& face, std::size_t side, double margin, double sign = 1) const {
    PlanPolygon kept;
    std::array<double, kMost> depth;
    for (std::size_t n = 0; n < count_; ++n) depth[n] = sign * face.inside(side, (*this)[n]) + margin;
    for (std::size_t n = 0; n < count_; ++n) {
      const std::size_t m = n + 1 < count_ ? n + 1 : 0;
      const Xy p = (*this)[n], q = (*this)[m];
      if (depth[n] >= 0) kept.add(p);
      if ((depth[n] < 0) == (depth[m] < 0)) continue;
      const double t = depth[n] / (depth[n] - depth[m]);
      kept.add({p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)});
    }
    return kept;
  }

 private:
  static constexpr std::size_t kMost = 12;

  void add(const Xy& p) {
    if (count_ == kMost) throw BrokenGuarantee("a piece of two triangles has more than 12 corners.");
    x_[count_] = p.x;
    y_[count_++] = p.y;
  }

  std::size_t count_ = 0;
  std::array<double, kMost> x_, y_;
};

// How a face lies to the sides of another.
struct PlanRelation {
  bool apart = false;             // wholly beyond a side
  std::array<bool, 3> crosses{};  // not wholly inside the side
  bool is_inside() const { return !apart && !crosses[0] && !crosses[1] && !crosses[2]; }
};

inline PlanRelation relation(const PlanFace& face, const PlanFace& other, double margin) {
  PlanRelation found;
  for (std::size_t side = 0; side < 3 && !found.apart; ++side) {
    const double a = other.inside(side, face.corner[0]), b = other.inside(side, face.corner[1]),
                 c = other.inside(side, face.corner[2]);
    found.apart = std::max({a, b, c}) < -margin;
    found.crosses[side] = std::min({a, b, c}) < 0;
  }
  return found;
}

// What two faces share in plan.
inline PlanPolygon common(const PlanFace& face, const PlanFace& other, const PlanRelation& how,
                          double margin) {
  PlanPolygon piece(face);
  for (std::size_t side = 0; side < 3; ++side) {
    if (how.crosses[side] && !piece.empty()) piece = piece.cut(other, side, margin);
  }
  return piece;
}

}  // namespace sightbound
