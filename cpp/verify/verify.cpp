// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/verify.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "verify/check_input.h"
#include "verify/overlay.h"
#include "verify/vertex_summary.h"

#include "base/error.h"
#include "base/number_text.h"
#include "base/parallel.h"
#include "terrain/tin_height_field.h"

namespace sightbound {

namespace {

constexpr std::size_t kBlock = 4096;  // faces or vertices; what one task looks at

std::size_t blocks_of(std::size_t count) { return (count + kBlock - 1) / kBlock; }

// Largest absolute coordinate in plan and in height.
struct Reach {
  double plan = 1, height = 1;

  void add(const Xyz& p) {
    if (!std::isfinite(p.z)) return;
    plan = std::max({plan, std::abs(p.x), std::abs(p.y)});
    height = std::max(height, std::abs(p.z));
  }
};

Reach reach_of(const OriginalSurface& original, const Tin& simplified) {
  Reach reach;
  for (const Xyz& p : simplified.vertices) reach.add(p);
  for (std::size_t n = 0; n < original.vertices(); ++n) reach.add(original.place(n));
  return reach;
}

// Places of a TIN came through coordinates of the CRS, each of them rounded a few times: borders and faces
// that differ by less are not told apart.
double rim_of(const Tin& tin) {
  return 0x1p-50 * std::max(std::abs(tin.origin.x), std::abs(tin.origin.y)) * tin.metres_per_unit;
}

std::vector<PlanFace> plan_faces(const Tin& tin, double margin) {
  std::vector<PlanFace> faces;
  faces.reserve(tin.faces.size());
  const auto at = [&](std::int32_t n) { return tin.vertices[static_cast<std::size_t>(n)]; };
  for (const Face& face : tin.faces) faces.emplace_back(at(face[0]), at(face[1]), at(face[2]), margin);
  return faces;
}

void count_bad_faces(const PlanBins& bins, const std::vector<std::uint8_t>& folded, VerifyReport& report) {
  const auto count = [](FaceCount& bad, std::size_t n, bool is_bad) {
    if (is_bad && bad.count++ == 0) bad.first = n;
  };
  for (std::size_t n = 0; n < bins.faces().size(); ++n) {
    const PlanFace& face = bins.faces()[n];
    const bool has_width = face.twice_area > bins.rim() * face.perimeter;
    count(report.flipped, n, has_width && face.is_flipped);
    count(report.folded, n, folded[n] != 0);
    count(report.degenerate, n, !has_width);
  }
}

PieceSummary all_pieces(const Overlay& overlay, CoveredShares& covered, const Workers& workers,
                        Progress& progress) {
  const std::size_t faces = overlay.original.faces(), blocks = blocks_of(faces);
  std::vector<PieceSummary> found(blocks);
  workers.for_each(blocks, [&](std::size_t block) {
    found[block] = overlay.pieces_of(block * kBlock, std::min((block + 1) * kBlock, faces), covered);
    progress.advance(1.0 / static_cast<double>(blocks));
  });
  PieceSummary all;
  for (const PieceSummary& part : found) all.append(part);
  return all;
}

Area surplus_of(const PlanBins& bins, const CoveredShares& covered, const Tin& frame) {
  Area surplus;
  double largest = 0;
  for (std::size_t n = 0; n < bins.faces().size(); ++n) {
    const PlanFace& face = bins.faces()[n];
    const double beyond = 0.5 * face.twice_area * (1 - covered.of(n));
    if (!(beyond > bins.rim() * face.perimeter)) continue;
    surplus.m2 += beyond;
    if (beyond <= largest) continue;
    largest = beyond;
    const auto& [a, b, c] = face.corner;
    surplus.place = frame.to_crs({(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3, face.z[0]});
  }
  return surplus;
}

// Vertices of faces; the others are no part of the surface.
std::vector<bool> used_vertices(const OriginalSurface& original) {
  std::vector<bool> used(original.vertices(), false);
  OriginalSurface::Corners corners;
  for (std::size_t n = 0; n < original.faces(); ++n) {
    if (!original.face(n, corners)) continue;
    for (const std::size_t corner : corners) used[corner] = true;
  }
  return used;
}

std::vector<float> vertex_deviations(const Overlay& overlay, const std::vector<bool>& used,
                                     const Workers& workers, Progress& progress) {
  std::vector<float> found(used.size(), std::numeric_limits<float>::quiet_NaN());
  const std::size_t blocks = blocks_of(used.size());
  workers.for_each(blocks, [&](std::size_t block) {
    for (std::size_t n = block * kBlock; n < std::min((block + 1) * kBlock, used.size()); ++n) {
      if (used[n]) found[n] = static_cast<float>(overlay.deviation_at(overlay.original.place(n)));
    }
    progress.advance(1.0 / static_cast<double>(blocks));
  });
  return found;
}

Extreme in_crs(Extreme found, const Tin& frame) {
  found.place = frame.to_crs(found.place);
  return found;
}

}  // namespace

VerifyReport verify_heights(const OriginalSurface& original, const Tin& simplified,
                            const Tolerance& tolerance, const VerifyOptions& options, Progress& progress) {
  check_tin(simplified, "simplified");
  const std::vector<bool> used = used_vertices(original);
  check_tolerance(tolerance, used);
  const Workers workers(options.threads);
  const Reach reach = reach_of(original, simplified);
  const double margin = plan_margin(reach.plan), rim = margin + rim_of(simplified);

  progress.begin(0.2, 1);
  const PlanBins bins(plan_faces(simplified, margin), rim);
  const std::vector<std::uint8_t> folded = folded_faces(bins, workers, progress);
  progress.begin(0.6, 1);
  const Overlay overlay{original, bins, folded, tolerance, margin, 0x1p-50 * reach.height};
  CoveredShares covered(simplified.faces.size());
  const PieceSummary pieces = all_pieces(overlay, covered, workers, progress);
  if (pieces.pieces == 0)
    throw InvalidInput("original and simplified have no place in common; check their CRS.");
  progress.begin(0.1, 1);

  VerifyReport report;
  report.method = "vertical";
  report.largest_deviation = in_crs(pieces.deviation, simplified);
  report.largest_ratio = in_crs(pieces.ratio, simplified);
  count_bad_faces(bins, folded, report);
  report.uncovered = {pieces.uncovered.m2, simplified.to_crs(pieces.uncovered.place)};
  report.surplus = surplus_of(bins, covered, simplified);
  report.resolution_m = margin;
  report.original_faces = pieces.faces;
  report.simplified_faces = simplified.faces.size();
  report.pieces = pieces.pieces;
  report.vertex_deviation = vertex_deviations(overlay, used, workers, progress);
  summarise_vertices(report, used);
  progress.finish();
  return report;
}

VerifyReport verify(const Tin& original, const Tin& simplified, const Tolerance& tolerance,
                    const VerifyOptions& options, Progress& progress) {
  check_tin(original, "original");
  if (!is_height_field(original)) return verify_distances(original, simplified, tolerance, options, progress);
  return verify_heights(OriginalTin(original, simplified), simplified, tolerance, options, progress);
}

}  // namespace sightbound
