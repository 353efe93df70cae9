// SPDX-License-Identifier: GPL-3.0-or-later
// The polygon is looked at along an axis of space, so that no coordinate changes; its rings are the
// constraints of a Delaunay triangulation, and a triangle is inside when an odd number of rings surrounds it.
#include "terrain/triangulate_polygon.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

namespace sightbound {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

struct Corner {
  std::int32_t number = -1;  // stays where CGAL adds a vertex: the rings cross
};
struct Depth {
  int rings = -1;  // around the triangle; -1 = not known yet
};
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Corner, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<Depth, Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Rings = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>, CGAL::Exact_predicates_tag>;

// Newell: the sum of the cross products of neighbouring corners, from the first one.
Xyz normal_of_ring(const std::vector<Xyz>& ring) {
  Xyz sum;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i)
    sum = sum + cross(ring[i] - ring[0], ring[i + 1] - ring[0]);
  return sum;
}

// Two coordinates of three, so that a ring with this normal appears counterclockwise.
class View {
 public:
  explicit View(const Xyz& n) {
    const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
    axis_ = z >= x && z >= y ? 2 : x >= y ? 0 : 1;
    mirrored_ = (axis_ == 2 ? n.z : axis_ == 0 ? n.x : n.y) < 0;
  }
  Kernel::Point_2 of(const Xyz& p) const {
    const double u = axis_ == 2 ? p.x : axis_ == 0 ? p.y : p.z;
    const double v = axis_ == 2 ? p.y : axis_ == 0 ? p.z : p.x;
    return mirrored_ ? Kernel::Point_2(v, u) : Kernel::Point_2(u, v);
  }

 private:
  int axis_;
  bool mirrored_;
};

// Counts rings inward from the infinite face; constraints separate n from n + 1.
void count_rings(Rings& rings) {
  std::vector<std::pair<Rings::Face_handle, int>> border{{rings.infinite_face(), 0}};
  while (!border.empty()) {
    const auto [start, depth] = border.back();
    border.pop_back();
    if (start->info().rings >= 0) continue;
    std::vector<Rings::Face_handle> open{start};
    start->info().rings = depth;
    std::vector<Rings::Face_handle> beyond;
    while (!open.empty()) {
      const auto face = open.back();
      open.pop_back();
      for (int i = 0; i < 3; ++i) {
        const auto next = face->neighbor(i);
        if (next->info().rings >= 0) continue;
        if (face->is_constrained(i)) {
          beyond.push_back(next);
        } else {
          next->info().rings = depth;
          open.push_back(next);
        }
      }
    }
    for (const auto& face : beyond) border.emplace_back(face, depth + 1);
  }
}

}  // namespace

std::array<Face, 2> split_quad(const std::array<Xyz, 4>& q) {
  const std::array<Face, 2> by_02{{{0, 1, 2}, {0, 2, 3}}}, by_13{{{0, 1, 3}, {1, 2, 3}}};
  // Inside: the two triangles look to the same side.
  const auto inside = [&](const std::array<Face, 2>& pair) {
    const auto normal = [&](const Face& f) {
      const Xyz& a = q[static_cast<std::size_t>(f[0])];
      return cross(q[static_cast<std::size_t>(f[1])] - a, q[static_cast<std::size_t>(f[2])] - a);
    };
    return dot(normal(pair[0]), normal(pair[1])) > 0;
  };
  const Xyz d02 = q[2] - q[0], d13 = q[3] - q[1];
  const bool shorter_13 = dot(d13, d13) < dot(d02, d02);
  const auto& first = shorter_13 ? by_13 : by_02;
  const auto& second = shorter_13 ? by_02 : by_13;
  return inside(first) || !inside(second) ? first : second;
}

std::optional<std::vector<Face>> triangulate_polygon(const std::vector<std::vector<Xyz>>& rings) {
  if (rings.empty() || rings.front().size() < 3) return {};
  for (const auto& ring : rings) {
    for (const Xyz& p : ring) {
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return {};
    }
  }
  if (rings.size() == 1 && rings[0].size() == 3) return std::vector<Face>{{0, 1, 2}};
  if (rings.size() == 1 && rings[0].size() == 4) {
    const auto pair = split_quad({rings[0][0], rings[0][1], rings[0][2], rings[0][3]});
    return std::vector<Face>{pair.begin(), pair.end()};
  }
  const Xyz normal = normal_of_ring(rings.front());
  if (!(dot(normal, normal) > 0)) return {};
  const View view(normal);

  Rings seen;
  std::int32_t number = 0;
  for (const auto& ring : rings) {
    std::vector<Rings::Vertex_handle> handles;
    for (const Xyz& p : ring) {
      const auto vertex = seen.insert(view.of(p));
      if (vertex->info().number < 0) vertex->info().number = number;
      handles.push_back(vertex);
      ++number;
    }
    for (std::size_t i = 0; i < handles.size(); ++i) {
      const auto to = handles[(i + 1) % handles.size()];
      if (handles[i] != to) seen.insert_constraint(handles[i], to);
    }
  }
  if (seen.dimension() < 2) return {};
  count_rings(seen);
  std::vector<Face> faces;
  for (auto f = seen.finite_faces_begin(); f != seen.finite_faces_end(); ++f) {
    const Face face{f->vertex(0)->info().number, f->vertex(1)->info().number, f->vertex(2)->info().number};
    if (std::min({face[0], face[1], face[2]}) < 0) return {};
    if (f->info().rings % 2 == 1) faces.push_back(face);
  }
  if (faces.empty()) return {};
  for (Face& face : faces) std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
  std::sort(faces.begin(), faces.end());
  return faces;
}

}  // namespace sightbound
