// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/tin_quadric.h"

#include <cmath>

namespace sightbound {

void TinQuadric::add_plane(const Xyz& n, const Xyz& place, double weight) {
  const double d = -dot(n, place);
  xx_ += weight * n.x * n.x;
  xy_ += weight * n.x * n.y;
  xz_ += weight * n.x * n.z;
  yy_ += weight * n.y * n.y;
  yz_ += weight * n.y * n.z;
  zz_ += weight * n.z * n.z;
  b_ = b_ + (weight * d) * n;
  c_ += weight * d * d;
}

void TinQuadric::add(const TinQuadric& o) {
  xx_ += o.xx_;
  xy_ += o.xy_;
  xz_ += o.xz_;
  yy_ += o.yy_;
  yz_ += o.yz_;
  zz_ += o.zz_;
  b_ = b_ + o.b_;
  c_ += o.c_;
}

Xyz TinQuadric::row(const Xyz& p) const {
  return {xx_ * p.x + xy_ * p.y + xz_ * p.z, xy_ * p.x + yy_ * p.y + yz_ * p.z,
          xz_ * p.x + yz_ * p.y + zz_ * p.z};
}

TinQuadric TinQuadric::moved(const Xyz& step) const {
  TinQuadric q = *this;
  q.b_ = b_ + row(step);
  q.c_ = cost(step);
  return q;
}

double TinQuadric::cost(const Xyz& p) const { return dot(p, row(p)) + 2 * dot(b_, p) + c_; }

// (A + l I) step = -(A preferred + b), by Cramer's rule. l, a millionth of A's size, keeps what no plane
// speaks of where it is.
Xyz TinQuadric::optimum(const Xyz& preferred) const {
  const double l = 1e-6 * (xx_ + yy_ + zz_);
  if (!(l > 0)) return preferred;
  const Xyz u{xx_ + l, xy_, xz_}, v{xy_, yy_ + l, yz_}, w{xz_, yz_, zz_ + l};
  const Xyz right = -1 * (row(preferred) + b_);
  const Xyz vw = cross(v, w), wu = cross(w, u), uv = cross(u, v);
  const double determinant = dot(u, vw);
  const Xyz step = (1 / determinant) * (right.x * vw + right.y * wu + right.z * uv);
  return std::isfinite(step.x + step.y + step.z) ? preferred + step : preferred;
}

}  // namespace sightbound
