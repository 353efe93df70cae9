// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/wedge_fan.h"

#include <algorithm>
#include <cmath>

#include "sight/wedge_march.h"

namespace sightbound {

WedgeFan::WedgeFan(const Scene& scene, const Eye& eye, const TargetTops& tops, double reach_m)
    : scene_(scene), eye_(eye), tops_(tops), reach_m_(reach_m) {
  for (const bool transposed : {false, true}) {
    for (const int sign : {1, -1}) add_side(transposed, sign);
  }
}

void WedgeFan::add_side(bool transposed, int sign) {
  const ObserverFrame& frame = *eye_.frame;
  const double major0 = transposed ? frame.row() : frame.col(),
               minor0 = transposed ? frame.col() : frame.row();
  const int base_minor = transposed ? eye_.base_col : eye_.base_row;
  const int minors = transposed ? scene_.heights.cols() : scene_.heights.rows();
  const double reach = reach_of_side(scene_, eye_, transposed, sign);
  if (reach <= 0) return;
  // A geodesic to a cell on the diagonal may leave the observer a little steeper than 1: some blocks more,
  // where needed.
  double steepest = 1;
  for (const int side : {1, -1}) {
    const double across = side > 0 ? minors - 1 - base_minor - minor0 : minor0 + base_minor;
    const double along = std::min(reach, across);
    for (const double share : {0.25, 0.5, 0.75, 1.0}) {
      const double major = major0 + sign * along * share, minor = minor0 + side * along * share;
      if (along * share <= 0) continue;
      const GeodesicPath path =
          frame.path_to(transposed ? minor : major, transposed ? major : minor, transposed);
      steepest = std::max(steepest, std::abs(path.minor_slope(0) / (along * share)));
    }
  }
  const int extra =
      steepest > 1 + 1e-9 ? static_cast<int>(std::ceil((steepest - 1) * kBlocksPerUnit)) + 1 : 1;
  for (int index = -kBlocksPerUnit - extra; index < kBlocksPerUnit + extra; ++index) {
    blocks_.push_back({transposed, sign, index, std::max(reach, 1.0)});
  }
}

void WedgeFan::march(std::size_t block, const Visitor& visit) const {
  WedgeMarch(scene_, eye_, tops_, blocks_[block]).run(reach_m_, visit);
}

}  // namespace sightbound
