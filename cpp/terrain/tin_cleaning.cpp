// SPDX-License-Identifier: GPL-3.0-or-later
// Vertices are renumbered twice: welded ones to the first of their place, then what faces still use in its
// old order.
#include "terrain/tin_cleaning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/number_text.h"
#include "terrain/tin_topology.h"

namespace sightbound {

namespace {

std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }

std::string counted(std::size_t n, const std::string& one, const std::string& many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

void check_faces(const Tin& tin, const std::string& what) {
  const auto bad = [](double c) { return !(std::abs(c) <= kLargestCoordinate); };
  for (std::size_t f = 0; f < tin.faces.size(); ++f) {
    for (const std::int32_t corner : tin.faces[f]) {
      if (corner < 0 || index(corner) >= tin.vertices.size()) {
        throw InvalidInput(what + ": face " + std::to_string(f) + " (counted from 0) has vertex " +
                           std::to_string(corner) + "; there are vertices 0 to " +
                           std::to_string(tin.vertices.size() - 1) +
                           ". The mesh is damaged: export it again.");
      }
      const Xyz& v = tin.vertices[index(corner)];
      if (bad(v.x) || bad(v.y) || bad(v.z)) {
        throw InvalidInput(
            what + ": vertex " + std::to_string(corner) + " (counted from 0) of face " + std::to_string(f) +
            " lies at (" + number_text(v.x, 6) + ", " + number_text(v.y, 6) + ", " + number_text(v.z, 6) +
            "); coordinates must be finite numbers within 1e9. Remove the vertex and its faces.");
      }
    }
  }
}

std::vector<bool> used_vertices(const Tin& tin) {
  std::vector<bool> used(tin.vertices.size(), false);
  for (const Face& face : tin.faces) {
    for (const std::int32_t corner : face) used[index(corner)] = true;
  }
  return used;
}

// Faces use the first vertex of a place. Returns how many vertices went out of use.
std::size_t weld(Tin& tin) {
  const std::vector<bool> used = used_vertices(tin);
  std::vector<std::int32_t> order;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v]) order.push_back(static_cast<std::int32_t>(v));
  }
  const auto place = [&](std::int32_t v) -> const Xyz& { return tin.vertices[index(v)]; };
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    const Xyz &p = place(a), &q = place(b);
    if (p.x != q.x) return p.x < q.x;
    if (p.y != q.y) return p.y < q.y;
    if (p.z != q.z) return p.z < q.z;
    return a < b;
  });
  std::vector<std::int32_t> first(tin.vertices.size());
  std::iota(first.begin(), first.end(), 0);
  std::size_t welded = 0;
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (place(order[i]) == place(order[i - 1])) {
      first[index(order[i])] = first[index(order[i - 1])];
      ++welded;
    }
  }
  if (welded == 0) return 0;
  for (Face& face : tin.faces) {
    for (std::int32_t& corner : face) corner = first[index(corner)];
  }
  return welded;
}

bool has_area(const Tin& tin, const Face& face) {
  if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) return false;
  double longest = 0;  // squared
  for (std::size_t i = 0; i < 3; ++i) {
    const Xyz edge = tin.vertices[index(face[(i + 1) % 3])] - tin.vertices[index(face[i])];
    longest = std::max(longest, dot(edge, edge));
  }
  return length(normal_of(tin, face)) > kFlatness * longest;
}

// True for every face whose corners an earlier one has.
std::vector<bool> repeated_faces(const Tin& tin) {
  std::vector<bool> repeated(tin.faces.size(), false);
  const auto sorted = [&](std::int32_t f) {
    Face face = tin.faces[index(f)];
    std::sort(face.begin(), face.end());
    return face;
  };
  std::vector<std::size_t> start(tin.vertices.size() + 1, 0);
  const auto lowest = [](const Face& face) { return index(std::min({face[0], face[1], face[2]})); };
  for (const Face& face : tin.faces) ++start[lowest(face) + 1];
  for (std::size_t v = 1; v < start.size(); ++v) start[v] += start[v - 1];
  std::vector<std::int32_t> order(tin.faces.size());
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  for (std::size_t f = 0; f < tin.faces.size(); ++f)
    order[next[lowest(tin.faces[f])]++] = static_cast<std::int32_t>(f);
  for (std::size_t v = 0; v + 1 < start.size(); ++v) {
    const auto begin = order.begin() + static_cast<std::ptrdiff_t>(start[v]);
    const auto end = order.begin() + static_cast<std::ptrdiff_t>(start[v + 1]);
    std::sort(begin, end, [&](std::int32_t a, std::int32_t b) {
      return std::pair(sorted(a), a) < std::pair(sorted(b), b);
    });
    for (auto i = begin; i != end; ++i) {
      if (i != begin && sorted(*i) == sorted(*(i - 1))) repeated[index(*i)] = true;
    }
  }
  return repeated;
}

template <class T>
void keep_only(std::vector<T>& values, const std::vector<bool>& keep) {
  std::size_t to = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (keep[i]) values[to++] = values[i];
  }
  values.resize(to);
}

void keep_faces(Tin& tin, const std::vector<bool>& keep) {
  keep_only(tin.faces, keep);
  for (TinAttribute& one : tin.face_attributes) keep_only(one.values, keep);
}

void keep_vertices(Tin& tin, const std::vector<bool>& keep) {
  std::vector<std::int32_t> number(tin.vertices.size(), -1);
  std::int32_t next = 0;
  for (std::size_t v = 0; v < keep.size(); ++v) {
    if (keep[v]) number[v] = next++;
  }
  for (Face& face : tin.faces) {
    for (std::int32_t& corner : face) corner = number[index(corner)];
  }
  keep_only(tin.vertices, keep);
  if (!tin.sigma_v.empty()) keep_only(tin.sigma_v, keep);
  for (TinAttribute& one : tin.vertex_attributes) keep_only(one.values, keep);
}

std::size_t count_false(const std::vector<bool>& flags) {
  return static_cast<std::size_t>(std::count(flags.begin(), flags.end(), false));
}

void drop_faces(Tin& tin, const std::string& what) {
  std::vector<bool> keep(tin.faces.size());
  for (std::size_t f = 0; f < keep.size(); ++f) keep[f] = has_area(tin, tin.faces[f]);
  if (const std::size_t flat = count_false(keep); flat > 0) {
    if (flat == keep.size()) {
      throw InvalidInput(what + " has no face with an area: the corners of all " +
                         counted(flat, "face", "faces") + " lie on a line.");
    }
    keep_faces(tin, keep);
    tin.notes.push_back(counted(flat, "face", "faces") + " without area left out.");
  }
  keep = repeated_faces(tin);
  keep.flip();
  if (const std::size_t repeated = count_false(keep); repeated > 0) {
    keep_faces(tin, keep);
    tin.notes.push_back(counted(repeated, "repeated face", "repeated faces") + " left out.");
  }
}

void turn_faces(Tin& tin) {
  TinTopology topology = topology_of(tin);
  if (const std::size_t turned = orient(tin, topology); turned > 0) {
    tin.notes.push_back(counted(turned, "face", "faces") +
                        " turned, so that neighbours agree and look up or outward.");
  }
  if (topology.non_manifold_edges > 0) {
    tin.notes.push_back(counted(topology.non_manifold_edges, "edge", "edges") +
                        " shared by more than two faces: the faces there count as ends of separate sheets.");
  }
  const auto twisted = std::count_if(topology.components.begin(), topology.components.end(),
                                     [](const TinTopology::Component& c) { return !c.orientable; });
  if (twisted > 0) {
    tin.notes.push_back(
        counted(static_cast<std::size_t>(twisted), "connected part has", "connected parts have") +
        " no two sides (like a Moebius strip): nothing is surely hidden by it.");
  }
}

}  // namespace

Tin clean(Tin tin, const std::string& what) {
  check_sizes(tin, what);
  check_faces(tin, what);
  const std::size_t unused_before = count_false(used_vertices(tin));
  const std::size_t welded = weld(tin);
  drop_faces(tin, what);
  const std::vector<bool> used = used_vertices(tin);
  const std::size_t unused = count_false(used);
  if (unused > 0) keep_vertices(tin, used);
  if (welded > 0) {
    tin.notes.push_back(counted(welded, "vertex", "vertices") +
                        " joined with another at exactly the same place.");
  }
  if (unused_before > 0)
    tin.notes.push_back(counted(unused_before, "vertex", "vertices") + " of no face left out.");
  turn_faces(tin);
  return tin;
}

}  // namespace sightbound
