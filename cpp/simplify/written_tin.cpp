// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/written_tin.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "simplify/envelope.h"

namespace sightbound {

namespace {

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

float rounded_up(double value) {
  const auto near = static_cast<float>(value);
  return near < value ? std::nextafter(near, std::numeric_limits<float>::infinity()) : near;
}

// A number for each vertex in the order of the triangles; one for all vertices at a sample where parts touch.
std::vector<std::int32_t> number_vertices(const PlanMesh& mesh, std::vector<std::int32_t>& first_of_number) {
  std::vector<std::int32_t> number(mesh.vertices(), PlanMesh::kNone);
  std::unordered_map<std::int64_t, std::int32_t> fixed;
  const auto next = [&](std::int32_t v) {
    first_of_number.push_back(v);
    return static_cast<std::int32_t>(first_of_number.size()) - 1;
  };
  for (std::int32_t t = 0; at(t) < mesh.triangles(); ++t) {
    for (std::int32_t corner = 4 * t; corner < 4 * t + 3; ++corner) {
      const std::int32_t v = mesh.vertex(corner);
      if (number[at(v)] != PlanMesh::kNone) continue;
      if (mesh.kind(v) != VertexKind::kFixed) {
        number[at(v)] = next(v);
        continue;
      }
      const std::int64_t place = (std::int64_t{mesh.step_y(v)} << 32) + mesh.step_x(v);
      const auto [known, is_new] =
          fixed.try_emplace(place, static_cast<std::int32_t>(first_of_number.size()));
      number[at(v)] = is_new ? next(v) : known->second;
    }
  }
  return number;
}

// What a triangle and a vertex are known by, each a number of the TIN's.
struct Numbers {
  std::vector<float> deviation, bound_used;               // of faces
  std::vector<float> vertex_tolerance, deviation_around;  // of vertices

  Numbers(std::size_t faces, std::size_t vertices)
      : deviation(faces), bound_used(faces), vertex_tolerance(vertices), deviation_around(vertices) {}
  // A vertex's deviation is the largest of the faces around it.
  void spread(const std::vector<Face>& faces) {
    for (std::size_t f = 0; f < faces.size(); ++f) {
      for (const std::int32_t v : faces[f]) {
        deviation_around[at(v)] = std::max(deviation_around[at(v)], deviation[f]);
      }
    }
  }
};

// Fills in all but `deviation_around`, band by band of the rows in which triangles begin. Returns the largest
// deviation of all. The tolerance of a vertex is looked up with the first triangle that has it.
Deviation measure(const PlanMesh& mesh, const std::vector<std::int32_t>& number, Originals& originals,
                  Numbers& numbers, const Workers& workers, Progress& progress) {
  constexpr std::int32_t kNobody = PlanMesh::kNone;
  std::vector<std::int32_t> first(numbers.vertex_tolerance.size(), kNobody);
  for (std::int32_t t = 0; at(t) < mesh.triangles(); ++t) {
    for (std::int32_t corner = 4 * t; corner < 4 * t + 3; ++corner) {
      std::int32_t& its = first[at(number[at(mesh.vertex(corner))])];
      if (its == kNobody) its = corner;
    }
  }
  constexpr int kBandRows = 256;
  constexpr std::size_t kTogether = 512;
  const int band_rows = originals.tiles_at_once(kBandRows) * kBandRows;
  struct Band {
    std::vector<std::int32_t> triangles;
    int last_row = 0;
  };
  std::vector<Band> bands(at(originals.rows() / band_rows + 1));
  for (std::int32_t t = 0; at(t) < mesh.triangles(); ++t) {
    const auto [top, bottom] =
        std::minmax({mesh.step_y(mesh.vertex(4 * t)), mesh.step_y(mesh.vertex(4 * t + 1)),
                     mesh.step_y(mesh.vertex(4 * t + 2))});
    Band& band = bands[at(top / kStepsPerCell / band_rows)];
    band.triangles.push_back(t);
    band.last_row = std::max(band.last_row, (bottom - 1) / kStepsPerCell + 1);
  }
  Deviation largest;
  const auto include = [](Deviation& all, const Deviation& one) {
    all = {std::max(all.metres, one.metres), std::max(all.ratio, one.ratio)};
  };
  for (std::size_t b = 0; b < bands.size(); ++b) {
    const std::vector<std::int32_t> triangles = std::move(bands[b].triangles);
    if (triangles.empty()) continue;
    const Originals::Part& part =
        originals.rows_of(static_cast<int>(b) * band_rows, bands[b].last_row, progress);
    std::vector<Deviation> largest_of((triangles.size() - 1) / kTogether + 1);
    workers.for_each(largest_of.size(), [&](std::size_t n) {
      progress.check();
      const std::size_t end = std::min((n + 1) * kTogether, triangles.size());
      for (std::size_t i = n * kTogether; i < end; ++i) {
        const std::int32_t corner = 4 * triangles[i];
        const Deviation off =
            deviation_of(part.original, mesh.place(mesh.vertex(corner)), mesh.place(mesh.vertex(corner + 1)),
                         mesh.place(mesh.vertex(corner + 2)));
        numbers.deviation[at(triangles[i])] = rounded_up(off.metres);
        numbers.bound_used[at(triangles[i])] = rounded_up(off.ratio);
        include(largest_of[n], off);
        for (std::int32_t c = corner; c < corner + 3; ++c) {
          const std::int32_t v = mesh.vertex(c), to = number[at(v)];
          if (first[at(to)] == c)
            numbers.vertex_tolerance[at(to)] =
                static_cast<float>(part.original.tolerance_under(mesh.place(v)));
        }
      }
    });
    for (const Deviation& one : largest_of) include(largest, one);
  }
  return largest;
}

}  // namespace

Tin empty_simplified_tin(const std::string& crs_wkt) {
  Tin tin;
  tin.crs_wkt = crs_wkt;
  tin.vertex_attributes = {{"tolerance", {}}, {"deviation_around", {}}};
  tin.face_attributes = {{"deviation", {}}, {"bound_used", {}}};
  return tin;
}

WrittenTin written_tin(const PlanMesh& mesh, const DemPlace& place, Originals& originals,
                       const Workers& workers, Progress& progress) {
  WrittenTin written;
  SimplifiedTin& result = written.made;
  Tin& tin = result.tin;
  const Geotransform& map = place.geotransform;
  tin = empty_simplified_tin(place.crs_wkt);
  tin.metres_per_unit = place.metres_per_unit;
  const Xy middle = map.of_sample(originals.cols() / 2.0, originals.rows() / 2.0);
  tin.origin = {std::round(middle.x), std::round(middle.y), 0};

  std::vector<std::int32_t> vertices;
  written.number = number_vertices(mesh, vertices);
  const std::vector<std::int32_t>& number = written.number;
  tin.vertices.reserve(vertices.size());
  for (const std::int32_t v : vertices) {
    const Point p = mesh.place(v);
    const Xy in_crs = map.of_sample(p.x, p.y);
    tin.vertices.push_back(tin.from_crs({in_crs.x, in_crs.y, p.z}));
  }
  // Counterclockwise in rows that run down is clockwise on the ground, unless the raster is mirrored.
  const auto& g = map.coefficients();
  const bool mirrored = g[1] * g[5] - g[2] * g[4] > 0;
  tin.faces.reserve(mesh.triangles());
  for (std::int32_t t = 0; at(t) < mesh.triangles(); ++t) {
    if (t % 4096 == 0) progress.check();
    const std::int32_t a = number[at(mesh.vertex(4 * t))], b = number[at(mesh.vertex(4 * t + 1))],
                       c = number[at(mesh.vertex(4 * t + 2))];
    tin.faces.push_back(mirrored ? Face{a, b, c} : Face{a, c, b});
  }

  Numbers numbers(tin.faces.size(), tin.vertices.size());
  const Deviation largest = measure(mesh, number, originals, numbers, workers, progress);
  numbers.spread(tin.faces);
  tin.vertex_attributes[0].values = std::move(numbers.vertex_tolerance);
  tin.vertex_attributes[1].values = std::move(numbers.deviation_around);
  tin.face_attributes[0].values = std::move(numbers.deviation);
  tin.face_attributes[1].values = std::move(numbers.bound_used);
  result.report.faces_after = tin.faces.size();
  result.report.largest_deviation_m = largest.metres;
  result.report.largest_ratio = largest.ratio;
  return written;
}

}  // namespace sightbound
