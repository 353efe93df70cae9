// SPDX-License-Identifier: GPL-3.0-or-later
// Points of one place are merged first; the rest are inserted along a space-filling curve, each search
// starting where the last ended.
#include "terrain/triangulate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <utility>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_plus_2.h>
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

#include "base/error.h"
#include "base/number_text.h"
#include "terrain/tin_cleaning.h"

namespace sightbound {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;

// Which point a vertex is; what CGAL makes where constraints cross is none.
struct PointNumber {
  std::int32_t number = Triangulation::kCrossing;
};
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<PointNumber, Kernel>;
using Free = CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase>>;
using ConstrainedBase = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel,
    CGAL::Triangulation_data_structure_2<VertexBase, CGAL::Constrained_triangulation_face_base_2<Kernel>>,
    CGAL::Exact_predicates_tag>;
using Constrained = CGAL::Constrained_triangulation_plus_2<ConstrainedBase>;

std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }

void check(const SurveyedPoints& given, const TriangulationOptions& options) {
  constexpr std::size_t kMost = std::size_t{1} << 30;
  const std::size_t count = given.points.size();
  if (count < 3 || count > kMost) {
    throw InvalidInput("There are " + std::to_string(count) + " points; a TIN needs 3 to 2^30 of them.");
  }
  for (std::size_t p = 0; p < count; ++p) {
    const Xyz& at = given.points[p];
    if (!std::isfinite(at.x) || !std::isfinite(at.y) || !std::isfinite(at.z)) {
      throw InvalidInput("Point " + std::to_string(p) +
                         " (counted from 0) has a coordinate that is not a finite number; leave it out.");
    }
  }
  for (const auto& line : given.breaklines) {
    for (const std::int32_t p : line) {
      if (p < 0 || index(p) >= count) {
        throw InvalidInput("A breakline has point " + std::to_string(p) + "; there are points 0 to " +
                           std::to_string(count - 1) + ".");
      }
    }
  }
  if (!(options.longest_edge > 0)) {
    throw InvalidInput("longest_edge is " + number_text(options.longest_edge, 3) +
                       "; it must be a positive length.");
  }
}

// One point for each place, and its height.
struct Places {
  std::vector<std::int32_t> of_point;  // the first point of its place
  std::vector<double> z;               // of first points
  std::vector<std::int32_t> firsts;    // in the order of the points
  std::vector<std::string> notes;
};

Places merge(const std::vector<Xyz>& points) {
  Places places;
  places.of_point.resize(points.size());
  places.z.resize(points.size());
  std::vector<std::int32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  const auto place = [&](std::int32_t p) { return std::pair(points[index(p)].x, points[index(p)].y); };
  std::sort(order.begin(), order.end(),
            [&](std::int32_t a, std::int32_t b) { return std::pair(place(a), a) < std::pair(place(b), b); });
  std::size_t merged = 0;
  double most_apart = 0;
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i;
    double sum = 0, low = points[index(order[i])].z, high = low;
    for (; end < order.size() && place(order[end]) == place(order[i]); ++end) {
      const double z = points[index(order[end])].z;
      places.of_point[index(order[end])] = order[i];
      sum += z;
      low = std::min(low, z);
      high = std::max(high, z);
    }
    // A lone point's height stays to the last bit.
    places.z[index(order[i])] = low == high ? low : sum / static_cast<double>(end - i);
    merged += end - i - 1;
    most_apart = std::max(most_apart, high - low);
    i = end;
  }
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (places.of_point[p] == static_cast<std::int32_t>(p))
      places.firsts.push_back(static_cast<std::int32_t>(p));
  }
  if (merged > 0) {
    places.notes.push_back(
        std::to_string(merged) + " points lie where another does and were merged with it" +
        (most_apart > 0 ? ", at the mean height (up to " + number_text(most_apart, 3) + " apart)." : "."));
  }
  return places;
}

template <class T>
std::vector<typename T::Vertex_handle> insert_points(T& triangulation, const std::vector<Xyz>& points,
                                                     std::vector<std::int32_t> order, Progress& progress) {
  constexpr std::size_t kPointsPerReport = 4096;
  std::vector<Point> plan;
  plan.reserve(points.size());
  for (const Xyz& p : points) plan.emplace_back(p.x, p.y);
  const auto place_of = CGAL::make_property_map(plan);
  using Traits = CGAL::Spatial_sort_traits_adapter_2<Kernel, decltype(place_of)>;
  std::vector<std::size_t> along(order.begin(), order.end());
  CGAL::spatial_sort(along.begin(), along.end(), Traits(place_of));

  std::vector<typename T::Vertex_handle> handles(points.size());
  typename T::Face_handle hint;
  for (std::size_t i = 0; i < along.size(); ++i) {
    const auto vertex = triangulation.insert(plan[along[i]], hint);
    vertex->info().number = static_cast<std::int32_t>(along[i]);
    handles[along[i]] = vertex;
    hint = vertex->face();
    if ((i + 1) % kPointsPerReport == 0) progress.advance(kPointsPerReport);
  }
  progress.advance(static_cast<double>(along.size() % kPointsPerReport + (points.size() - along.size())));
  return handles;
}

void insert_breaklines(Constrained& triangulation, const std::vector<Constrained::Vertex_handle>& handles,
                       const SurveyedPoints& given, const Places& places, Progress& progress) {
  for (const auto& line : given.breaklines) {
    for (std::size_t i = 1; i < line.size(); ++i) {
      const std::int32_t from = places.of_point[index(line[i - 1])], to = places.of_point[index(line[i])];
      if (from != to) triangulation.insert_constraint(handles[index(from)], handles[index(to)]);
    }
    progress.check();
  }
}

// Height at p of a breakline's piece from a to b.
double height_along(const Point& p, const Xyz& a, const Xyz& b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double t = std::clamp(((p.x() - a.x) * dx + (p.y() - a.y) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
  return a.z + t * (b.z - a.z);
}

// Where breaklines cross: a vertex at the mean of their heights.
void add_crossings(Constrained& triangulation, const SurveyedPoints& given, const Places& places,
                   Triangulation& made) {
  std::size_t crossings = 0;
  double most_apart = 0;
  for (auto v = triangulation.finite_vertices_begin(); v != triangulation.finite_vertices_end(); ++v) {
    if (v->info().number != Triangulation::kCrossing) continue;
    double sum = 0, low = INFINITY, high = -INFINITY;
    int lines = 0;
    auto around = triangulation.incident_vertices(v), first = around;
    do {
      if (triangulation.is_infinite(around) || !triangulation.is_subconstraint(v, around)) continue;
      for (auto context = triangulation.contexts_begin(v, around);
           context != triangulation.contexts_end(v, around); ++context) {
        const auto end = [&](Constrained::Vertex_handle h) {
          const std::int32_t p = h->info().number;
          const Xyz& at = given.points[index(p)];
          return Xyz{at.x, at.y, places.z[index(p)]};
        };
        auto last = context->vertices_end();
        --last;
        const double z = height_along(v->point(), end(*context->vertices_begin()), end(*last));
        sum += z;
        low = std::min(low, z);
        high = std::max(high, z);
        ++lines;
      }
    } while (++around != first);
    if (lines == 0) throw BrokenGuarantee("a vertex that is neither a point nor on a breakline");
    v->info().number = static_cast<std::int32_t>(-2 - static_cast<std::int64_t>(crossings));
    made.tin.vertices.push_back({v->point().x(), v->point().y(), sum / lines});
    made.points.push_back(Triangulation::kCrossing);
    ++crossings;
    most_apart = std::max(most_apart, high - low);
  }
  if (crossings > 0) {
    made.tin.notes.push_back("Breaklines cross at " + std::to_string(crossings) +
                             " places: a vertex at the mean of their heights was added there (up to " +
                             number_text(most_apart, 3) + " apart).");
  }
}

// Plan edge too long, or corners on a line but for rounding (hulls of gridded points in a rotated CRS).
bool left_out(const Tin& tin, const Face& face, double longest_allowed) {
  double longest = 0;  // squared
  for (std::size_t i = 0; i < 3; ++i) {
    const Xyz edge = tin.vertices[index(face[(i + 1) % 3])] - tin.vertices[index(face[i])];
    longest = std::max(longest, edge.x * edge.x + edge.y * edge.y);
  }
  return std::sqrt(longest) > longest_allowed || !(normal_of(tin, face).z > kFlatness * longest);
}

// `vertex_of`: of a point's number, or of a crossing's (-2, -3 ...).
template <class T, class F>
void add_faces(const T& triangulation, const F& vertex_of, double longest_edge, Tin& tin) {
  tin.faces.reserve(triangulation.number_of_faces());
  for (auto f = triangulation.finite_faces_begin(); f != triangulation.finite_faces_end(); ++f) {
    Face face{vertex_of(f->vertex(0)->info().number), vertex_of(f->vertex(1)->info().number),
              vertex_of(f->vertex(2)->info().number)};
    if (left_out(tin, face, longest_edge)) continue;
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    tin.faces.push_back(face);
  }
  std::sort(tin.faces.begin(), tin.faces.end());
}

}  // namespace

Triangulation triangulate(const SurveyedPoints& given, const TriangulationOptions& options,
                          Progress& progress) {
  check(given, options);
  Places places = merge(given.points);
  Triangulation made;
  made.tin.notes = places.notes;
  std::vector<std::int32_t> vertex_of_point(given.points.size(), -1);
  for (const std::int32_t p : places.firsts) {
    vertex_of_point[index(p)] = static_cast<std::int32_t>(made.tin.vertices.size());
    made.tin.vertices.push_back({given.points[index(p)].x, given.points[index(p)].y, places.z[index(p)]});
    made.points.push_back(p);
  }
  const auto first_crossing = static_cast<std::int32_t>(made.tin.vertices.size());
  const auto vertex_of = [&](std::int32_t number) {
    return number >= 0 ? vertex_of_point[index(number)] : first_crossing + (-2 - number);
  };

  if (given.breaklines.empty()) {
    Free triangulation;
    insert_points(triangulation, given.points, places.firsts, progress);
    add_faces(triangulation, vertex_of, options.longest_edge, made.tin);
  } else {
    Constrained triangulation;
    const auto handles = insert_points(triangulation, given.points, places.firsts, progress);
    insert_breaklines(triangulation, handles, given, places, progress);
    add_crossings(triangulation, given, places, made);
    add_faces(triangulation, vertex_of, options.longest_edge, made.tin);
  }
  if (made.tin.faces.empty()) {
    throw InvalidInput(
        "The points make no triangle: they lie on a line, or all their triangles have an edge longer than "
        "longest_edge (" +
        number_text(options.longest_edge, 3) + "). Give points around an area, or a larger longest_edge.");
  }
  return made;
}

}  // namespace sightbound
