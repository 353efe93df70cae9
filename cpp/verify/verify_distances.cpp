// SPDX-License-Identifier: GPL-3.0-or-later
// Both surfaces are sampled: each face at the corners of n x n equal parts of it. No place of a triangle is
// farther than (longest side) / sqrt(3) from its nearest corner, so none of the face is farther than 1 / n of
// that from a sample, and the distance to the other surface is at most that much larger than the largest
// sampled.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "verify/check_input.h"
#include "verify/nearest_face.h"
#include "verify/verify.h"
#include "verify/vertex_summary.h"

#include "base/error.h"
#include "base/number_text.h"
#include "base/parallel.h"

namespace sightbound {

namespace {

constexpr double kSamples = 1e6;          // about, of the larger surface, where no resolution is given
constexpr double kMostParts = 30000;      // of a side
constexpr std::size_t kBlock = 256;       // faces or vertices a task
constexpr double kOutward = 1 + 0x1p-40;  // for the rounding of distances

std::vector<Triangle3> triangles_of(const OriginalSurface& surface) {
  std::vector<Triangle3> triangles;
  OriginalSurface::Corners at;
  for (std::size_t n = 0; n < surface.faces(); ++n) {
    if (surface.face(n, at))
      triangles.push_back({surface.place(at[0]), surface.place(at[1]), surface.place(at[2])});
  }
  return triangles;
}

double longest_side(const Triangle3& t) {
  return std::max({length(t[1] - t[0]), length(t[2] - t[1]), length(t[0] - t[2])});
}
double area_of(const Triangle3& t) { return 0.5 * length(cross(t[1] - t[0], t[2] - t[0])); }

double total_area(const std::vector<Triangle3>& triangles) {
  double area = 0;
  for (const Triangle3& t : triangles) area += area_of(t);
  return area;
}

double resolution_of(const VerifyOptions& options, double area) {
  if (options.resolution_m == 0) return std::max(std::sqrt(area / kSamples), 1e-3);
  if (options.resolution_m >= 1e-4 && options.resolution_m <= 1e6) return options.resolution_m;
  throw InvalidInput("resolution is " + number_text(options.resolution_m, 6) +
                     "; allowed is 0.0001 to 1000000 m, or 0 for a choice from the area.");
}

// Tolerances at the corners of the original's faces.
class FaceTolerance {
 public:
  FaceTolerance(const Tin& original, const Tolerance& tolerance)
      : original_(original), tolerance_(tolerance) {}

  std::array<double, 3> of(std::size_t face) const {
    if (tolerance_.of_vertices.empty()) return {tolerance_.metres, tolerance_.metres, tolerance_.metres};
    std::array<double, 3> values{};
    for (std::size_t i = 0; i < 3; ++i)
      values[i] =
          static_cast<double>(tolerance_.of_vertices[static_cast<std::size_t>(original_.faces[face][i])]);
    return values;
  }
  double least(std::size_t face) const {
    const std::array<double, 3> values = of(face);
    return *std::min_element(values.begin(), values.end());
  }

 private:
  const Tin& original_;
  const Tolerance& tolerance_;
};

struct Sampled {
  Extreme deviation, ratio;
  std::size_t samples = 0;
  double radius = 0;  // no place is farther from a sample

  void append(const Sampled& later) {
    const auto keep = [](Extreme& kept, const Extreme& other) {
      const double measured = std::max(kept.measured, other.measured);
      if (other.bound > kept.bound) kept = other;
      kept.measured = measured;
    };
    keep(deviation, later.deviation);
    keep(ratio, later.ratio);
    samples += later.samples;
    radius = std::max(radius, later.radius);
  }
};

// One face against the other surface. judge(sample, what is nearest) is {place on the simplified, its face,
// tolerance}.
template <class Judge>
void sample_face(const Triangle3& face, const NearestFace& other, double resolution, const Judge& judge,
                 Sampled& found) {
  const double side = longest_side(face);
  const int parts =
      static_cast<int>(std::clamp(std::ceil(side / (std::sqrt(3.0) * resolution)), 1.0, kMostParts));
  const double radius = side / (std::sqrt(3.0) * parts);
  found.radius = std::max(found.radius, radius);
  for (int i = 0; i <= parts; ++i) {
    for (int j = 0; i + j <= parts; ++j) {
      const Xyz sample = face[0] + (static_cast<double>(i) / parts) * (face[1] - face[0]) +
                         (static_cast<double>(j) / parts) * (face[2] - face[0]);
      const NearestFace::Found near = other.nearest(sample);
      const auto [place, number, tolerance] = judge(sample, near);
      const double bound = (near.distance + radius) * kOutward;
      found.deviation.measured = std::max(found.deviation.measured, near.distance);
      found.ratio.measured = std::max(found.ratio.measured, near.distance / tolerance);
      if (bound > found.deviation.bound) found.deviation = {bound, found.deviation.measured, place, number};
      if (bound / tolerance > found.ratio.bound)
        found.ratio = {bound / tolerance, found.ratio.measured, place, number};
      ++found.samples;
    }
  }
}

struct Judged {
  Xyz place;
  std::size_t face;
  double tolerance;
};

// `judge_of(face)` is the judge of that face's samples.
template <class JudgeOf>
Sampled sample_all(const std::vector<Triangle3>& faces, const NearestFace& other, double resolution,
                   const JudgeOf& judge_of, const Workers& workers, Progress& progress) {
  const std::size_t blocks = (faces.size() + kBlock - 1) / kBlock;
  std::vector<Sampled> found(blocks);
  workers.for_each(blocks, [&](std::size_t block) {
    for (std::size_t n = block * kBlock; n < std::min((block + 1) * kBlock, faces.size()); ++n) {
      sample_face(faces[n], other, resolution, judge_of(n), found[block]);
      progress.check();
    }
    progress.advance(1.0 / static_cast<double>(blocks));
  });
  Sampled all;
  for (const Sampled& part : found) all.append(part);
  return all;
}

std::vector<float> vertex_distances(const OriginalSurface& original, const std::vector<bool>& used,
                                    const NearestFace& simplified, const Workers& workers,
                                    Progress& progress) {
  std::vector<float> found(used.size(), std::numeric_limits<float>::quiet_NaN());
  const std::size_t blocks = (used.size() + kBlock - 1) / kBlock;
  workers.for_each(blocks, [&](std::size_t block) {
    for (std::size_t n = block * kBlock; n < std::min((block + 1) * kBlock, used.size()); ++n) {
      if (used[n]) found[n] = static_cast<float>(simplified.nearest(original.place(n)).distance);
    }
    progress.advance(1.0 / static_cast<double>(blocks));
  });
  return found;
}

std::vector<bool> used_vertices(const Tin& tin) {
  std::vector<bool> used(tin.vertices.size(), false);
  for (const Face& face : tin.faces) {
    for (const std::int32_t corner : face) used[static_cast<std::size_t>(corner)] = true;
  }
  return used;
}

}  // namespace

VerifyReport verify_distances(const Tin& original, const Tin& simplified, const Tolerance& tolerance,
                              const VerifyOptions& options, Progress& progress) {
  check_tin(original, "original");
  check_tin(simplified, "simplified");
  const std::vector<bool> used = used_vertices(original);
  check_tolerance(tolerance, used);
  const Workers workers(options.threads);
  const OriginalTin was(original, simplified), is(simplified, simplified);
  const FaceTolerance allowed(original, tolerance);
  progress.begin(0.1, 1);
  const NearestFace to_original(triangles_of(was)), to_simplified(triangles_of(is));
  progress.advance(1);
  const double resolution = resolution_of(
      options, std::max(total_area(to_original.triangles()), total_area(to_simplified.triangles())));

  progress.begin(0.4, 1);
  Sampled found = sample_all(
      to_simplified.triangles(), to_original, resolution,
      [&](std::size_t n) {
        return [&, n](const Xyz& sample, const NearestFace::Found& near) {
          return Judged{sample, n, allowed.least(near.face)};
        };
      },
      workers, progress);
  progress.begin(0.4, 1);
  found.append(sample_all(
      to_original.triangles(), to_simplified, resolution,
      [&](std::size_t n) {
        return [&, least = allowed.least(n)](const Xyz&, const NearestFace::Found& near) {
          return Judged{near.place, near.face, least};
        };
      },
      workers, progress));
  progress.begin(0.1, 1);

  VerifyReport report;
  report.method = "distance";
  report.largest_deviation = found.deviation;
  report.largest_ratio = found.ratio;
  for (Extreme* extreme : {&report.largest_deviation, &report.largest_ratio})
    extreme->place = simplified.to_crs(extreme->place);
  for (std::size_t n = 0; n < simplified.faces.size(); ++n) {
    const Triangle3& face = to_simplified.triangles()[n];
    const double side = longest_side(face);
    if (area_of(face) <= 1e-12 * side * side && report.degenerate.count++ == 0) report.degenerate.first = n;
  }
  report.resolution_m = found.radius;
  report.original_faces = original.faces.size();
  report.simplified_faces = simplified.faces.size();
  report.pieces = found.samples;
  report.vertex_deviation = vertex_distances(was, used, to_simplified, workers, progress);
  summarise_vertices(report, used);
  progress.finish();
  return report;
}

}  // namespace sightbound
