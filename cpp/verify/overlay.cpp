// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/overlay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace sightbound {

namespace {

// What is left of a face when others are taken away, overlapping as they may.
double area_without(const PlanFace& face, const std::vector<const PlanFace*>& others) {
  constexpr std::size_t kManyCorners = 8;
  std::vector<PlanPolygon> left{PlanPolygon(face)}, next;
  for (const PlanFace* other : others) {
    next.clear();
    for (PlanPolygon& inner : left) {
      for (std::size_t side = 0; side < 3 && !inner.empty(); ++side) {
        const PlanPolygon outer = inner.cut(*other, side, 0, -1);
        if (outer.size() > kManyCorners) {
          next.push_back(outer.part(1, kManyCorners / 2));
          next.push_back(outer.part(kManyCorners / 2, outer.size() - 1));
        } else if (!outer.empty()) {
          next.push_back(outer);
        }
        inner = inner.cut(*other, side, 0);
      }
    }
    std::swap(left, next);
  }
  double area = 0;
  for (const PlanPolygon& polygon : left) area += polygon.area();
  return area;
}

void keep_larger(Extreme& kept, const Extreme& other) {
  const double measured = std::max(kept.measured, other.measured);
  if (other.bound > kept.bound) kept = other;
  kept.measured = measured;
}

// One face of the original with its tolerance.
struct JudgedFace {
  PlanFace plan;
  std::array<double, 3> tolerance{};  // at its corners
  double least_tolerance = 0, tolerance_steepness = 0;
};

// A face of the original over one of the simplified.
struct FacePair {
  const JudgedFace& original;
  const PlanFace& simplified;
  std::size_t number;  // of the simplified face

  double deviation(const Xy& p) const { return std::abs(simplified.height(p) - original.plan.height(p)); }
  double tolerance(const Xy& p, double slack) const {
    return std::max(original.plan.at(p, original.tolerance) - slack, original.least_tolerance);
  }
};

// At the corners of a piece that holds all of what the two share, and not much more.
void bound(const FacePair& pair, const PlanPolygon& piece, double margin, double z_rounding,
           PieceSummary& found) {
  const double slack = (pair.original.plan.steepness + pair.simplified.steepness) * margin + z_rounding;
  const double tolerance_slack = pair.original.tolerance_steepness * margin;
  const auto keep = [&](Extreme& kept, double bound, const Xy& p) {
    if (bound > kept.bound) kept = {bound, kept.measured, {p.x, p.y, pair.simplified.height(p)}, pair.number};
  };
  for (std::size_t n = 0; n < piece.size(); ++n) {
    const Xy p = piece[n];
    const double most = pair.deviation(p) + slack;
    keep(found.deviation, most, p);
    keep(found.ratio, most / pair.tolerance(p, tolerance_slack) * (1 + 0x1p-50), p);
  }
}

// At the corners of what they share.
void measure(const FacePair& pair, const PlanPolygon& piece, PieceSummary& found) {
  for (std::size_t n = 0; n < piece.size(); ++n) {
    const double deviation = pair.deviation(piece[n]);
    found.deviation.measured = std::max(found.deviation.measured, deviation);
    found.ratio.measured = std::max(found.ratio.measured, deviation / pair.tolerance(piece[n], 0));
  }
}

Xyz middle_of(const PlanFace& face) {
  const auto& [a, b, c] = face.corner;
  return {(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3, (face.z[0] + face.z[1] + face.z[2]) / 3};
}

}  // namespace

void PieceSummary::append(const PieceSummary& later) {
  keep_larger(deviation, later.deviation);
  keep_larger(ratio, later.ratio);
  uncovered.m2 += later.uncovered.m2;
  if (later.largest_gap_m2 > largest_gap_m2) {
    largest_gap_m2 = later.largest_gap_m2;
    uncovered.place = later.uncovered.place;
  }
  faces += later.faces;
  pieces += later.pieces;
}

PieceSummary Overlay::pieces_of(std::size_t first, std::size_t last, CoveredShares& covered) const {
  PieceSummary found;
  std::vector<const PlanFace*> over;
  OriginalSurface::Corners corners;
  for (std::size_t n = first; n < last; ++n) {
    if (!original.face(n, corners)) continue;
    ++found.faces;
    JudgedFace face;
    face.plan =
        PlanFace(original.place(corners[0]), original.place(corners[1]), original.place(corners[2]), margin);
    if (face.plan.twice_area == 0) continue;  // its neighbours hold all its places
    if (face.plan.is_flipped) std::swap(corners[1], corners[2]);
    face.tolerance.fill(tolerance.metres);
    if (!tolerance.of_vertices.empty()) {
      for (std::size_t i = 0; i < 3; ++i)
        face.tolerance[i] = static_cast<double>(tolerance.of_vertices[corners[i]]);
    }
    const auto [least, most] = std::minmax_element(face.tolerance.begin(), face.tolerance.end());
    face.least_tolerance = *least;
    face.tolerance_steepness = (*most - *least) * face.plan.perimeter / face.plan.twice_area;

    const double area = 0.5 * face.plan.twice_area;
    double shared = 0;
    bool is_folded = false;
    over.clear();
    simplified.each_near(face.plan.box, [&](std::size_t number) {
      const PlanFace& other = simplified.faces()[number];
      const PlanRelation how = relation(face.plan, other, margin);
      if (how.apart) return;
      const PlanPolygon piece = common(face.plan, other, how, margin);
      if (piece.empty()) return;
      ++found.pieces;
      const FacePair pair{face, other, number};
      bound(pair, piece, margin, z_rounding, found);
      const PlanPolygon core = how.is_inside() ? piece : common(face.plan, other, how, 0);
      measure(pair, core, found);
      const double piece_area = how.is_inside() ? area : core.area();
      shared += piece_area;
      covered.add(number, piece_area / (0.5 * other.twice_area));
      is_folded = is_folded || folded[number] != 0;
      over.push_back(&other);
    });
    const double gap = is_folded ? area_without(face.plan, over) : area - shared;
    if (gap <= simplified.rim() * face.plan.perimeter) continue;
    found.uncovered.m2 += gap;
    if (gap > found.largest_gap_m2) {
      found.largest_gap_m2 = gap;
      found.uncovered.place = middle_of(face.plan);
    }
  }
  return found;
}

double Overlay::deviation_at(const Xyz& place) const {
  const Xy p{place.x, place.y};
  double found = std::numeric_limits<double>::quiet_NaN();
  const double around = simplified.rim();
  simplified.each_near({{p.x - around, p.y - around}, {p.x + around, p.y + around}}, [&](std::size_t number) {
    const PlanFace& face = simplified.faces()[number];
    for (std::size_t side = 0; side < 3; ++side) {
      if (face.inside(side, p) < -around) return;
    }
    const double deviation = face.height(p) - place.z;
    if (!(std::abs(deviation) <= std::abs(found))) found = deviation;
  });
  return found;
}

std::vector<std::uint8_t> folded_faces(const PlanBins& bins, const Workers& workers, Progress& progress) {
  const std::vector<PlanFace>& faces = bins.faces();
  std::vector<std::uint8_t> folded(faces.size(), 0);
  constexpr std::size_t kBlock = 1024;
  const std::size_t blocks = (faces.size() + kBlock - 1) / kBlock;
  workers.for_each(blocks, [&](std::size_t block) {
    for (std::size_t n = block * kBlock; n < std::min((block + 1) * kBlock, faces.size()); ++n) {
      const PlanFace& face = faces[n];
      if (face.twice_area == 0) continue;
      bins.each_near(face.box, [&](std::size_t other) {
        if (folded[n] != 0 || other == n) return;
        const PlanRelation how = relation(face, faces[other], 0);
        if (how.apart) return;
        const double shared = common(face, faces[other], how, 0).area();
        if (shared > bins.rim() * std::min(face.perimeter, faces[other].perimeter)) folded[n] = 1;
      });
    }
    progress.advance(1.0 / static_cast<double>(blocks));
  });
  return folded;
}

}  // namespace sightbound
