// SPDX-License-Identifier: GPL-3.0-or-later
// How far a TIN is from another by brute force, and what holds it together: no code of the core but Xyz.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <vector>

#include "terrain/tin.h"

namespace sightbound::testing {

inline double distance_to_triangle(const std::array<Xyz, 3>& t, const Xyz& p) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const Xyz edge = t[(i + 1) % 3] - t[i];
    const double along = std::clamp(dot(p - t[i], edge) / dot(edge, edge), 0.0, 1.0);
    best = std::min(best, length(t[i] + along * edge - p));
  }
  const Xyz normal = cross(t[1] - t[0], t[2] - t[0]);
  const Xyz foot = p - (dot(p - t[0], normal) / dot(normal, normal)) * normal;
  bool inside = true;
  for (std::size_t i = 0; i < 3; ++i)
    inside = inside && dot(cross(t[(i + 1) % 3] - t[i], foot - t[i]), normal) >= 0;
  return inside ? std::min(best, length(foot - p)) : best;
}

inline std::array<Xyz, 3> triangle_of(const Tin& tin, const Face& f) {
  const auto at = [&](std::int32_t v) { return tin.vertices[static_cast<std::size_t>(v)]; };
  return {at(f[0]), at(f[1]), at(f[2])};
}

inline double distance_to_tin(const Tin& tin, const Xyz& p) {
  double best = std::numeric_limits<double>::infinity();
  for (const Face& f : tin.faces) best = std::min(best, distance_to_triangle(triangle_of(tin, f), p));
  return best;
}

// Places of a triangle in a net of so many steps a side, corners and edges included.
template <class F>
void for_places(const std::array<Xyz, 3>& t, int steps, const F& f) {
  for (int u = 0; u <= steps; ++u) {
    for (int v = 0; u + v <= steps; ++v)
      f(t[0] + (double(u) / steps) * (t[1] - t[0]) + (double(v) / steps) * (t[2] - t[0]));
  }
}

// The largest distance of places of `from`, in a net, to `to`.
inline double furthest(const Tin& from, const Tin& to, int steps = 8) {
  double most = 0;
  for (const Face& f : from.faces)
    for_places(triangle_of(from, f), steps,
               [&](const Xyz& p) { most = std::max(most, distance_to_tin(to, p)); });
  return most;
}

// What a simplification must not change.
struct Shape {
  long euler = 0;                // vertices - edges + faces
  std::size_t outlines = 0;      // pieces of border
  std::size_t non_manifold = 0;  // edges of three and more faces
  std::size_t components = 0;
  friend bool operator==(const Shape&, const Shape&) = default;
};

inline Shape shape_of(const Tin& tin) {
  std::map<std::array<std::int32_t, 2>, std::size_t> edges;
  std::set<std::int32_t> used;
  std::map<std::int32_t, std::int32_t> faces_parent, border_parent;
  const auto root = [](std::map<std::int32_t, std::int32_t>& parent, std::int32_t v) {
    parent.emplace(v, v);
    while (parent[v] != v) v = parent[v];
    return v;
  };
  for (const Face& f : tin.faces) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t a = f[i], b = f[(i + 1) % 3];
      ++edges[{std::min(a, b), std::max(a, b)}];
      used.insert(a);
      faces_parent[root(faces_parent, a)] = root(faces_parent, b);
    }
  }
  Shape shape;
  shape.euler = static_cast<long>(used.size() + tin.faces.size()) - static_cast<long>(edges.size());
  for (const auto& [edge, count] : edges) {
    shape.non_manifold += count > 2;
    if (count == 1) border_parent[root(border_parent, edge[0])] = root(border_parent, edge[1]);
  }
  for (const auto& [v, p] : faces_parent) shape.components += v == p;
  for (const auto& [v, p] : border_parent) shape.outlines += v == p;
  return shape;
}

}  // namespace sightbound::testing
