// SPDX-License-Identifier: GPL-3.0-or-later
// The distance to a surface is bounded on a triangle in two ways:
//   it changes no faster than the place: at most that of the middle + the middle's distance from the farthest
//   corner;
//   it is at most that to one face of the surface, which is convex, hence largest at a corner: the largest of
//   the three corners' distances to the face nearest to the middle. Exact where the triangle lies over one
//   face.
// Triangles whose bound is not above what was measured somewhere are done with; the others are cut into four,
// level by level, until a bound is not more than the resolution above the distance measured there.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
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

constexpr double kFineEnough = 1.0 / 64;         // of the largest distance or the tolerance
constexpr std::size_t kMostTriangles = 1 << 19;  // at a level: beyond, they are cut no more
constexpr double kSmallest = 1e-6;               // metres; nothing is told finer
constexpr std::size_t kFacesAtOnce = 1 << 16;    // 100 bytes a triangle
constexpr std::size_t kBlock = 256;              // triangles or vertices a task
constexpr double kOutward = 1 + 0x1p-40;         // for the rounding of distances

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

void check_resolution(double metres) {
  if (metres == 0 || (metres >= 1e-4 && metres <= 1e6)) return;
  throw InvalidInput("resolution is " + number_text(metres, 6) +
                     "; allowed is 0.0001 to 1000000 m, or 0 for one that fits.");
}

// Of the original's faces.
class FaceTolerance {
 public:
  FaceTolerance(const Tin& original, const Tolerance& tolerance)
      : original_(original), tolerance_(tolerance) {
    for (std::size_t n = 0; n < original.faces.size(); ++n) {
      for (const double one : of(n)) least_ = std::min(least_, one);
    }
  }

  double least() const { return least_; }

  double at_vertex(std::size_t vertex) const {
    return tolerance_.of_vertices.empty() ? tolerance_.metres
                                          : static_cast<double>(tolerance_.of_vertices[vertex]);
  }
  std::array<double, 3> of(std::size_t face) const {
    std::array<double, 3> values{};
    for (std::size_t i = 0; i < 3; ++i)
      values[i] = at_vertex(static_cast<std::size_t>(original_.faces[face][i]));
    return values;
  }
  // At a place of the face; the least of its corners where it has no area.
  double at(std::size_t face, const Triangle3& corners, const Xyz& p) const {
    const std::array<double, 3> values = of(face);
    const Xyz normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double whole = dot(normal, normal);
    if (!(whole > 0)) return *std::min_element(values.begin(), values.end());
    const double b = dot(cross(corners[2] - corners[1], p - corners[1]), normal) / whole,
                 c = dot(cross(corners[0] - corners[2], p - corners[2]), normal) / whole;
    const double found = b * values[0] + c * values[1] + (1 - b - c) * values[2];
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    return std::clamp(found, *least, *most);
  }

 private:
  const Tin& original_;
  const Tolerance& tolerance_;
  double least_ = std::numeric_limits<double>::infinity();
};

// What was measured at a place, and where on the simplified TIN that tells of it.
struct Measured {
  double distance = 0, most = 0;    // there, and the bound of the triangle around
  double tolerance = 1, least = 1;  // there, and the least of the triangle around
  Xyz place;
  std::size_t face = 0;
};

// The largest of all, grown as more is looked at. Bounds of places that are left out are not above it.
class Largest {
 public:
  void measure(const Measured& m) {
    raise(deviation_, m.distance, m.distance, m);
    raise(ratio_, m.distance / m.tolerance, m.distance / m.tolerance, m);
  }
  // Of all places around.
  void bound(const Measured& m) {
    raise(deviation_, m.most, m.distance, m);
    raise(ratio_, m.most / m.least, m.distance / m.tolerance, m);
  }
  bool covers(const Measured& m) const {
    return m.most <= deviation_.measured && m.most / m.least <= ratio_.measured;
  }
  const Extreme& deviation() const { return deviation_; }
  const Extreme& ratio() const { return ratio_; }

 private:
  static void raise(Extreme& kept, double most, double measured, const Measured& m) {
    const double before = kept.measured;
    if (most > kept.bound) kept = {most, before, m.place, m.face};
    kept.measured = std::max(before, measured);
  }

  Extreme deviation_, ratio_;
};

struct Part {
  Triangle3 triangle;
  std::array<double, 3> tolerance;  // at its corners; of the original's faces
  std::uint32_t face;

  Xyz middle() const { return (1.0 / 3) * (triangle[0] + triangle[1] + triangle[2]); }
  double radius() const {
    const Xyz m = middle();
    return std::max({length(triangle[0] - m), length(triangle[1] - m), length(triangle[2] - m)});
  }
  std::array<Part, 4> quarters() const {
    const auto& [a, b, c] = triangle;
    const auto& [d, e, f] = tolerance;
    const Xyz ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
    const double de = 0.5 * (d + e), ef = 0.5 * (e + f), fd = 0.5 * (f + d);
    return {{{{a, ab, ca}, {d, de, fd}, face},
             {{ab, b, bc}, {de, e, ef}, face},
             {{ca, bc, c}, {fd, ef, f}, face},
             {{ab, bc, ca}, {de, ef, fd}, face}}};
  }
};

// From one of the surfaces to the other.
struct Direction {
  const NearestFace& from;
  const NearestFace& to;
  bool from_simplified;
  const FaceTolerance& allowed;

  std::vector<Part> parts(std::size_t first, std::size_t last) const {
    std::vector<Part> some;
    for (std::size_t n = first; n < last; ++n) {
      const std::array<double, 3> tolerance = from_simplified ? std::array<double, 3>{} : allowed.of(n);
      some.push_back({from.triangles()[n], tolerance, static_cast<std::uint32_t>(n)});
    }
    return some;
  }
  // At the middle of a part. With a tolerance that varies the simplified TIN has only that of the nearest
  // place.
  Measured measure(const Part& part) const {
    const Xyz p = part.middle();
    const NearestFace::Found near = to.nearest(p);
    const Triangle3& face = to.triangles()[near.face];
    double at_corners = 0;
    for (const Xyz& corner : part.triangle)
      at_corners = std::max(at_corners, length(nearest_place(face, corner) - corner));
    const double most = std::min(near.distance + part.radius(), at_corners) * kOutward;
    if (from_simplified) {
      const double there = allowed.at(near.face, face, near.place);
      return {near.distance, most, there, there, p, part.face};
    }
    const auto& [a, b, c] = part.tolerance;
    return {near.distance, most, (a + b + c) / 3, std::min({a, b, c}), near.place, near.face};
  }
};

// At all vertices of a TIN's faces; of the others nothing.
std::vector<Measured> measure_vertices(const Direction& way, const Tin& tin, const Workers& workers,
                                       Progress& progress) {
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> face_of(tin.vertices.size(), kUnused);
  for (std::size_t n = 0; n < tin.faces.size(); ++n) {
    for (const std::int32_t corner : tin.faces[n])
      face_of[static_cast<std::size_t>(corner)] = static_cast<std::uint32_t>(n);
  }
  std::vector<Measured> found(face_of.size());
  const std::size_t blocks = (face_of.size() + kBlock - 1) / kBlock;
  workers.for_each(blocks, [&](std::size_t block) {
    for (std::size_t n = block * kBlock; n < std::min((block + 1) * kBlock, face_of.size()); ++n) {
      if (face_of[n] == kUnused) continue;
      const Face& face = tin.faces[face_of[n]];
      const auto corner = static_cast<std::size_t>(
          std::find(face.begin(), face.end(), static_cast<std::int32_t>(n)) - face.begin());
      const Xyz& p = way.from.triangles()[face_of[n]][corner];
      const double here = way.from_simplified ? 0 : way.allowed.at_vertex(n);
      found[n] = way.measure({{p, p, p}, {here, here, here}, face_of[n]});
    }
    progress.advance(1.0 / static_cast<double>(blocks));
  });
  return found;
}

// How many triangles were looked at, and how far a bound that was kept is above the distance there.
struct Looked {
  std::size_t triangles = 0;
  double doubt = 0;
};

void bound_parts(const Direction& way, std::vector<Part> parts, double resolution, const Workers& workers,
                 Progress& progress, Largest& largest, Looked& looked) {
  std::vector<Part> next;
  std::vector<Measured> found;
  while (!parts.empty()) {
    found.resize(parts.size());
    workers.for_each((parts.size() + kBlock - 1) / kBlock, [&](std::size_t block) {
      for (std::size_t n = block * kBlock; n < std::min((block + 1) * kBlock, parts.size()); ++n)
        found[n] = way.measure(parts[n]);
      progress.check();
    });
    looked.triangles += parts.size();
    for (const Measured& one : found) largest.measure(one);
    const double fine =
        std::max(resolution > 0 ? resolution
                                : kFineEnough * std::max(largest.deviation().measured, way.allowed.least()),
                 kSmallest);
    next.clear();
    for (std::size_t n = 0; n < parts.size(); ++n) {
      if (largest.covers(found[n])) continue;
      const double doubt = found[n].most - found[n].distance;
      if (doubt <= fine || next.size() + 4 > kMostTriangles) {
        looked.doubt = std::max(looked.doubt, doubt);
        largest.bound(found[n]);
      } else {
        for (const Part& part : parts[n].quarters()) next.push_back(part);
      }
    }
    std::swap(parts, next);
  }
}

Looked bound_all(const Direction& way, double resolution, const Workers& workers, Progress& progress,
                 Largest& largest) {
  Looked looked;
  const std::size_t faces = way.from.triangles().size();
  for (std::size_t first = 0; first < faces; first += kFacesAtOnce) {
    const std::size_t last = std::min(first + kFacesAtOnce, faces);
    bound_parts(way, way.parts(first, last), resolution, workers, progress, largest, looked);
    progress.advance(static_cast<double>(last - first) / static_cast<double>(faces));
  }
  return looked;
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
  check_resolution(options.resolution_m);
  const Workers workers(options.threads);
  const OriginalTin was(original, simplified), is(simplified, simplified);
  const FaceTolerance allowed(original, tolerance);
  progress.begin(0.1, 1);
  const NearestFace to_original(triangles_of(was)), to_simplified(triangles_of(is));
  progress.advance(1);

  const Direction there{to_simplified, to_original, true, allowed},
      back{to_original, to_simplified, false, allowed};

  progress.begin(0.3, 2);
  Largest largest;
  for (const Measured& one : measure_vertices(there, simplified, workers, progress)) largest.measure(one);
  const std::vector<Measured> at_vertices = measure_vertices(back, original, workers, progress);
  for (const Measured& one : at_vertices) largest.measure(one);
  progress.begin(0.6, 2);
  const Looked on_simplified = bound_all(there, options.resolution_m, workers, progress, largest);
  const Looked on_original = bound_all(back, options.resolution_m, workers, progress, largest);

  VerifyReport report;
  report.method = "distance";
  report.largest_deviation = largest.deviation();
  report.largest_ratio = largest.ratio();
  for (Extreme* extreme : {&report.largest_deviation, &report.largest_ratio})
    extreme->place = simplified.to_crs(extreme->place);
  for (std::size_t n = 0; n < simplified.faces.size(); ++n) {
    const Triangle3& face = to_simplified.triangles()[n];
    const double side = longest_side(face);
    if (area_of(face) <= 1e-12 * side * side && report.degenerate.count++ == 0) report.degenerate.first = n;
  }
  report.resolution_m = std::max(on_simplified.doubt, on_original.doubt);
  report.original_faces = original.faces.size();
  report.simplified_faces = simplified.faces.size();
  report.pieces = on_simplified.triangles + on_original.triangles;
  report.vertex_deviation.assign(used.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t n = 0; n < used.size(); ++n) {
    if (used[n]) report.vertex_deviation[n] = static_cast<float>(at_vertices[n].distance);
  }
  summarise_vertices(report, used);
  progress.finish();
  return report;
}

}  // namespace sightbound
