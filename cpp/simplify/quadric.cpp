// SPDX-License-Identifier: GPL-3.0-or-later
//   N . q = d     the plane of a triangle, |N| twice its area; N . p - d is six times the volume up to p
#include "simplify/quadric.h"

#include <algorithm>

namespace sightbound {

namespace {
// Pulls the optimum towards the middle of the edge where the terrain does not tell: along a ridge, on a
// plane.
constexpr double kPull = 1e-3, kLeastPull = 1e-12;
}  // namespace

Quadric::Quadric(const EdgeStar& star) {
  const Point &a = star.place_a, &b = star.place_b;
  origin_ = {(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2};
  for (int i = 0; i < star.sides(); ++i) {
    const auto n = static_cast<std::size_t>(i);
    add(star.belongs_to_b(i) ? b : a, star.at[n], star.at[n + 1]);
  }
  const Point& left = star.at[static_cast<std::size_t>(star.left)];
  add(a, b, left);
  if (star.right >= 0) add(a, b, star.at[static_cast<std::size_t>(star.right)]);
}

void Quadric::add(const Point& apex, const Point& b, const Point& c) {
  const double bx = b.x - apex.x, by = b.y - apex.y, bz = b.z - apex.z;
  const double cx = c.x - apex.x, cy = c.y - apex.y, cz = c.z - apex.z;
  const double nx = by * cz - bz * cy, ny = bz * cx - bx * cz, nz = bx * cy - by * cx;
  const double d = nx * (apex.x - origin_.x) + ny * (apex.y - origin_.y) + nz * (apex.z - origin_.z);
  xx_ += nx * nx, xy_ += nx * ny, xz_ += nx * nz, yy_ += ny * ny, yz_ += ny * nz, zz_ += nz * nz;
  x_ -= nx * d, y_ -= ny * d, z_ -= nz * d, one_ += d * d;
}

Point Quadric::optimum() const {
  // The height goes first; what is left is how much the slopes around differ.
  double xx = xx_ - xz_ * xz_ / zz_, yy = yy_ - yz_ * yz_ / zz_;
  const double xy = xy_ - xz_ * yz_ / zz_, x = x_ - xz_ * z_ / zz_, y = y_ - yz_ * z_ / zz_;
  const double pull = kPull * (xx + yy) + kLeastPull * zz_;
  xx += pull;
  yy += pull;
  const double determinant = xx * yy - xy * xy;
  const double px = (xy * y - yy * x) / determinant, py = (xy * x - xx * y) / determinant;
  return {origin_.x + px, origin_.y + py, best_height(origin_.x + px, origin_.y + py)};
}

double Quadric::best_height(double x, double y) const {
  return origin_.z - (xz_ * (x - origin_.x) + yz_ * (y - origin_.y) + z_) / zz_;
}

double Quadric::cost(const Point& p) const {
  const double x = p.x - origin_.x, y = p.y - origin_.y, z = p.z - origin_.z;
  const double cost = x * (xx_ * x + 2 * (xy_ * y + xz_ * z + x_)) + y * (yy_ * y + 2 * (yz_ * z + y_)) +
                      z * (zz_ * z + 2 * z_) + one_;
  return std::max(0.0, cost);  // on a plane rounding alone is left
}

}  // namespace sightbound
