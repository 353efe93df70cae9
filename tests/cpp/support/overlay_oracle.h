// SPDX-License-Identifier: GPL-3.0-or-later
// Is a TIN a simplification of a DEM within its tolerance? By brute force and in long double, with no code of
// cpp/simplify: the DEM's triangles are written out, and every triangle of the TIN is compared with each of
// them at the corners of what they share.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "terrain/geotransform.h"
#include "terrain/grid.h"
#include "terrain/tin.h"

namespace sightbound::testing {

struct OverlayReport {
  double deviation = 0;    // the largest |TIN - DEM|, metres
  double excess = -1e300;  // the largest |TIN - DEM| - tolerance
  double ratio = 0;        // the largest |TIN - DEM| / tolerance where that is not nearly 0
  double uncovered = 0;    // of the DEM's footprint that no triangle of the TIN covers, cells
  double outside = 0;      // of the TIN's beyond the DEM's footprint, cells
  double overlap = 0;      // covered twice, cells
  std::size_t not_up = 0;  // triangles that do not look up
  std::size_t non_manifold = 0;
  int holes = 0;  // V - E + F is 1 - this for one connected piece
};

namespace oracle {

using Real = long double;
// Metres: beside places that count as exact, a ratio is one of roundings.
inline constexpr Real kLeastTolerance = 1e-9L;
struct P {
  Real x, y, z, e;
};
using Triangle = std::array<P, 3>;

inline Real area2(const P& a, const P& b, const P& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// The part of a polygon to the left of a -> b.
inline std::vector<P> cut(const std::vector<P>& polygon, const P& a, const P& b) {
  std::vector<P> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const P &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const Real sp = area2(a, b, p), sq = area2(a, b, q);
    if (sp >= 0) kept.push_back(p);
    if ((sp > 0 && sq < 0) || (sp < 0 && sq > 0)) {
      const Real t = sp / (sp - sq);
      kept.push_back({p.x + t * (q.x - p.x), p.y + t * (q.y - p.y), 0, 0});
    }
  }
  return kept;
}

// Height and tolerance of a triangle's plane.
inline P on_plane(const Triangle& t, const P& at) {
  const Real all = area2(t[0], t[1], t[2]);
  const Real w1 = area2(t[0], at, t[2]) / all, w2 = area2(t[0], t[1], at) / all, w0 = 1 - w1 - w2;
  return {at.x, at.y, w0 * t[0].z + w1 * t[1].z + w2 * t[2].z, w0 * t[0].e + w1 * t[1].e + w2 * t[2].e};
}

inline Real area_of(const std::vector<P>& polygon) {
  Real sum = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i) sum += area2(polygon[0], polygon[i - 1], polygon[i]);
  return sum / 2;
}

}  // namespace oracle

// `tolerance(row, col)` of each sample. Triangles in raster coordinates, counterclockwise there.
template <class F>
OverlayReport overlay_report(const Grid<float>& heights, const Geotransform& map, const F& tolerance,
                             const Tin& tin) {
  using namespace oracle;
  OverlayReport report;
  const auto& g = map.coefficients();
  const bool turned = g[1] * g[5] - g[2] * g[4] < 0;
  std::vector<Triangle> fresh;
  std::map<std::pair<int, int>, int> edges;
  for (const Face& face : tin.faces) {
    if (normal_of(tin, face).z <= 0) ++report.not_up;
    Triangle t;
    for (std::size_t i = 0; i < 3; ++i) {
      const Xyz crs = tin.to_crs(tin.vertices[static_cast<std::size_t>(face[i])]);
      const Xy at = map.to_raster(crs.x, crs.y);
      t[i] = {at.x, at.y, crs.z, 0};
      ++edges[{face[i], face[(i + 1) % 3]}];
    }
    if (turned) std::swap(t[1], t[2]);
    fresh.push_back(t);
  }
  std::size_t inner = 0;
  for (const auto& [edge, count] : edges) {
    if (count != 1) ++report.non_manifold;
    inner += edges.count({edge.second, edge.first});
  }
  const std::size_t all_edges = edges.size() - inner / 2;
  report.holes = 1 - static_cast<int>(tin.vertices.size()) + static_cast<int>(all_edges) -
                 static_cast<int>(tin.faces.size());

  Real footprint = 0, shared = 0, own = 0;
  for (const Triangle& t : fresh) own += area2(t[0], t[1], t[2]) / 2;
  const auto sample = [&](int r, int c) {
    return P{static_cast<Real>(c), static_cast<Real>(r), heights.at(r, c),
             static_cast<Real>(tolerance(r, c))};
  };
  for (int r = 0; r + 1 < heights.rows(); ++r) {
    for (int c = 0; c + 1 < heights.cols(); ++c) {
      for (const Triangle& old : {Triangle{sample(r, c), sample(r, c + 1), sample(r + 1, c + 1)},
                                  Triangle{sample(r, c), sample(r + 1, c + 1), sample(r + 1, c)}}) {
        if (std::isnan(old[0].z + old[1].z + old[2].z)) continue;
        footprint += 0.5L;
        Real here = 0;
        for (const Triangle& t : fresh) {
          if (std::max({t[0].x, t[1].x, t[2].x}) < c || std::min({t[0].x, t[1].x, t[2].x}) > c + 1 ||
              std::max({t[0].y, t[1].y, t[2].y}) < r || std::min({t[0].y, t[1].y, t[2].y}) > r + 1) {
            continue;
          }
          std::vector<P> piece(old.begin(), old.end());
          for (std::size_t i = 0; i < 3; ++i) piece = cut(piece, t[i], t[(i + 1) % 3]);
          const Real area = area_of(piece);
          here += area;
          if (area < 1e-12L) continue;
          for (const P& corner : piece) {
            const P before = on_plane(old, corner), after = on_plane(t, corner);
            const Real off = std::abs(after.z - before.z);
            report.deviation = std::max(report.deviation, static_cast<double>(off));
            report.excess = std::max(report.excess, static_cast<double>(off - before.e));
            if (before.e > kLeastTolerance)
              report.ratio = std::max(report.ratio, static_cast<double>(off / before.e));
          }
        }
        shared += here;
        report.uncovered += std::max(0.0, static_cast<double>(0.5L - here));
        report.overlap += std::max(0.0, static_cast<double>(here - 0.5L));
      }
    }
  }
  report.outside = static_cast<double>(own - shared);
  return report;
}

}  // namespace sightbound::testing
