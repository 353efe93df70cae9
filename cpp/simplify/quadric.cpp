// SPDX-License-Identifier: GPL-3.0-or-later
//   N . q = d     the plane of a triangle, N_z twice its plan area; (N . p - d) / N_z is the height of p
//   above it cost(p) = p . H p + 2 g . p + c
#include "simplify/quadric.h"

#include <algorithm>
#include <cmath>

namespace sightbound {

namespace {
// Pulls the optimum towards the middle of the edge where the terrain does not tell: along a ridge, on a
// plane.
constexpr double kPull = 1e-3, kLeastPull = 1e-12;
}  // namespace

void Quadric::add_triangle(const Point& a, const Point& b, const Point& c, const Point& here) {
  const double bx = b.x - a.x, by = b.y - a.y, bz = b.z - a.z;
  const double cx = c.x - a.x, cy = c.y - a.y, cz = c.z - a.z;
  const double nx = by * cz - bz * cy, ny = bz * cx - bx * cz, nz = bx * cy - by * cx;
  const double d = nx * (a.x - here.x) + ny * (a.y - here.y) + nz * (a.z - here.z);
  const double wx = nx / nz, wy = ny / nz, wd = d / nz;
  const auto add = [](float& to, double value) { to += static_cast<float>(value); };
  add(xx, wx * nx), add(xy, wx * ny), add(xz, nx), add(yy, wy * ny), add(yz, ny), add(zz, nz);
  add(x, -wd * nx), add(y, -wd * ny), add(z, -d), add(one, wd * d);
}

Quadric& Quadric::operator+=(const Quadric& q) {
  xx += q.xx, xy += q.xy, xz += q.xz, yy += q.yy, yz += q.yz, zz += q.zz;
  x += q.x, y += q.y, z += q.z, one += q.one;
  return *this;
}

QuadricSum::QuadricSum(const Quadric& q, const Point& q_place, const Quadric& r, const Point& r_place)
    : middle_{(q_place.x + r_place.x) / 2, (q_place.y + r_place.y) / 2, (q_place.z + r_place.z) / 2} {
  add(q, q_place);
  add(r, r_place);
}

void QuadricSum::add(const Quadric& q, const Point& place) {
  const double x = middle_.x - place.x, y = middle_.y - place.y, z = middle_.z - place.z;
  const double hx = q.xx * x + q.xy * y + q.xz * z, hy = q.xy * x + q.yy * y + q.yz * z,
               hz = q.xz * x + q.yz * y + q.zz * z;
  xx_ += q.xx, xy_ += q.xy, xz_ += q.xz, yy_ += q.yy, yz_ += q.yz, zz_ += q.zz;
  x_ += q.x + hx, y_ += q.y + hy, z_ += q.z + hz;
  one_ += q.one + x * (2 * q.x + hx) + y * (2 * q.y + hy) + z * (2 * q.z + hz);
}

Quadric QuadricSum::seen_from(const Point& here) const {
  const double x = here.x - middle_.x, y = here.y - middle_.y, z = here.z - middle_.z;
  const double hx = xx_ * x + xy_ * y + xz_ * z, hy = xy_ * x + yy_ * y + yz_ * z,
               hz = xz_ * x + yz_ * y + zz_ * z;
  const auto f = [](double value) { return static_cast<float>(value); };
  return {f(xx_),     f(xy_),
          f(xz_),     f(yy_),
          f(yz_),     f(zz_),
          f(x_ + hx), f(y_ + hy),
          f(z_ + hz), f(one_ + x * (2 * x_ + hx) + y * (2 * y_ + hy) + z * (2 * z_ + hz))};
}

Point QuadricSum::optimum() const {
  // The height goes first; what is left is how much the slopes around differ.
  double xx = xx_ - xz_ * xz_ / zz_, yy = yy_ - yz_ * yz_ / zz_;
  const double xy = xy_ - xz_ * yz_ / zz_, x = x_ - xz_ * z_ / zz_, y = y_ - yz_ * z_ / zz_;
  const double pull = kPull * (xx + yy) + kLeastPull * zz_;
  xx += pull;
  yy += pull;
  const double determinant = xx * yy - xy * xy;
  const double px = middle_.x + (xy * y - yy * x) / determinant,
               py = middle_.y + (xy * x - xx * y) / determinant;
  return {px, py, best_height(px, py)};
}

double QuadricSum::best_height(double x, double y) const {
  return middle_.z - (xz_ * (x - middle_.x) + yz_ * (y - middle_.y) + z_) / zz_;
}

double QuadricSum::cost(const Point& p) const {
  const double x = p.x - middle_.x, y = p.y - middle_.y, z = p.z - middle_.z;
  const double cost = x * (xx_ * x + 2 * (xy_ * y + xz_ * z + x_)) + y * (yy_ * y + 2 * (yz_ * z + y_)) +
                      z * (zz_ * z + 2 * z_) + one_;
  return std::max(0.0, cost);  // on a plane rounding alone is left
}

}  // namespace sightbound
