// SPDX-License-Identifier: GPL-3.0-or-later
// Places and triangles, for inner loops. Internal to cpp/volume.
#pragma once

#include <array>
#include <cmath>

#include "terrain/tin.h"

namespace sightbound {

inline double norm(const Xyz& a) { return std::sqrt(dot(a, a)); }

// The nearest place of a triangle. Ericson, Real-Time Collision Detection, section 5.1.5.
inline Xyz closest_on(const std::array<Xyz, 3>& t, const Xyz& p) {
  const Xyz ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0];
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return t[0];
  const Xyz bp = p - t[1];
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return t[1];
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return t[0] + (d1 / (d1 - d3)) * ab;
  const Xyz cp = p - t[2];
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return t[2];
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return t[0] + (d2 / (d2 - d6)) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return t[1] + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (t[2] - t[1]);
  const double all = va + vb + vc;
  return t[0] + (vb / all) * ab + (vc / all) * ac;
}

}  // namespace sightbound
