// SPDX-License-Identifier: GPL-3.0-or-later
#include "terrain/exact_planes.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace sightbound {

namespace {
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
Kernel::Point_3 point(const Xyz& p) { return {p.x, p.y, p.z}; }
}  // namespace

bool in_one_plane(const Xyz& a, const Xyz& b, const Xyz& c, const Xyz& d) {
  return CGAL::coplanar(point(a), point(b), point(c), point(d));
}

bool on_one_line(const Xyz& a, const Xyz& b, const Xyz& c) {
  return CGAL::collinear(point(a), point(b), point(c));
}

int turn_in_plan(const Xyz& a, const Xyz& b, const Xyz& c) {
  return static_cast<int>(
      CGAL::orientation(Kernel::Point_2(a.x, a.y), Kernel::Point_2(b.x, b.y), Kernel::Point_2(c.x, c.y)));
}

}  // namespace sightbound
