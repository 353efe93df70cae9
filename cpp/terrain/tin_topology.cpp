// SPDX-License-Identifier: GPL-3.0-or-later
// Edges are counted into buckets by their lower vertex and sorted within by the other: no hashing, the same
// order everywhere.
#include "terrain/tin_topology.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sightbound {

namespace {

struct HalfEdge {
  std::int32_t other;  // the higher vertex
  std::int32_t face;
  std::int8_t edge;
};

std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }

// Calls f(begin, end) for the half-edges of each edge.
template <class F>
void for_each_edge(const Tin& tin, const F& f) {
  std::vector<std::size_t> start(tin.vertices.size() + 1, 0);
  const auto low_of = [&](const Face& face, std::size_t i) {
    return index(std::min(face[i], face[(i + 1) % 3]));
  };
  for (const Face& face : tin.faces) {
    for (std::size_t i = 0; i < 3; ++i) ++start[low_of(face, i) + 1];
  }
  for (std::size_t v = 1; v < start.size(); ++v) start[v] += start[v - 1];
  std::vector<HalfEdge> halves(3 * tin.faces.size());
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  for (std::size_t k = 0; k < tin.faces.size(); ++k) {
    const Face& face = tin.faces[k];
    for (std::size_t i = 0; i < 3; ++i) {
      halves[next[low_of(face, i)]++] = {std::max(face[i], face[(i + 1) % 3]), static_cast<std::int32_t>(k),
                                         static_cast<std::int8_t>(i)};
    }
  }
  for (std::size_t v = 0; v + 1 < start.size(); ++v) {
    HalfEdge* const end = halves.data() + start[v + 1];
    HalfEdge* from = halves.data() + start[v];
    std::sort(from, end, [](const HalfEdge& a, const HalfEdge& b) {
      return std::pair(a.other, a.face) < std::pair(b.other, b.face);
    });
    while (from != end) {
      HalfEdge* to = from + 1;
      while (to != end && to->other == from->other) ++to;
      f(from, to);
      from = to;
    }
  }
}

// Do two neighbours run along their common edge in opposite directions, as faces turned alike do?
bool agree(const Tin& tin, std::size_t a, std::size_t edge_of_a, std::size_t b) {
  const std::int32_t from = tin.faces[a][edge_of_a];
  for (std::size_t i = 0; i < 3; ++i) {
    if (tin.faces[b][i] == from) return tin.faces[b][(i + 1) % 3] != tin.faces[a][(edge_of_a + 1) % 3];
  }
  return true;
}

void turn(Tin& tin, TinTopology& topology, std::size_t face) {
  std::swap(tin.faces[face][1], tin.faces[face][2]);
  std::swap(topology.neighbours[face][0], topology.neighbours[face][2]);
}

// Components, and for each face whether it must be turned to agree with the first of its component.
std::vector<bool> spread(const Tin& tin, TinTopology& topology) {
  const std::size_t count = tin.faces.size();
  std::vector<bool> turned(count, false);
  topology.component.assign(count, -1);
  topology.components.clear();
  std::vector<std::size_t> open;
  for (std::size_t seed = 0; seed < count; ++seed) {
    if (topology.component[seed] >= 0) continue;
    const auto number = static_cast<std::int32_t>(topology.components.size());
    TinTopology::Component component;
    component.first_face = static_cast<std::int32_t>(seed);
    topology.component[seed] = number;
    open.assign(1, seed);
    while (!open.empty()) {
      const std::size_t face = open.back();
      open.pop_back();
      ++component.faces;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t across = topology.neighbours[face][i];
        if (across < 0) {
          component.closed = false;
          continue;
        }
        const std::size_t other = index(across);
        const bool wanted = agree(tin, face, i, other) ? turned[face] : !turned[face];
        if (topology.component[other] < 0) {
          topology.component[other] = number;
          turned[other] = wanted;
          open.push_back(other);
        } else if (turned[other] != wanted) {
          component.orientable = false;
        }
      }
    }
    topology.components.push_back(component);
  }
  return turned;
}

struct Shape {
  double plan_area = 0, volume = 0;
  Xyz low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};

  // `apex`: a vertex of the component, so that far coordinates do not drown its volume.
  void add(const Tin& tin, const Face& face, const Xyz& apex) {
    const Xyz normal = normal_of(tin, face);
    plan_area += normal.z;
    volume += dot(tin.vertices[index(face[0])] - apex, normal);
    for (const std::int32_t corner : face) {
      const Xyz& v = tin.vertices[index(corner)];
      low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
      high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
    }
  }
  bool within(const Shape& other) const {
    return low.x >= other.low.x && low.y >= other.low.y && low.z >= other.low.z && high.x <= other.high.x &&
           high.y <= other.high.y && high.z <= other.high.z;
  }
};

// Closed components that lie in the box of another closed one.
std::vector<bool> perhaps_cavities(const TinTopology& topology, const std::vector<Shape>& shapes) {
  // Beyond so many bodies (a town) the quadratic search is left out: they are buildings, not cavities.
  constexpr std::size_t kMostBodies = 2000;
  std::vector<bool> found(shapes.size(), false);
  std::vector<std::size_t> closed;
  for (std::size_t c = 0; c < shapes.size(); ++c) {
    if (topology.components[c].closed && topology.components[c].orientable) closed.push_back(c);
  }
  if (closed.size() > kMostBodies) return found;
  for (const std::size_t a : closed) {
    found[a] = std::any_of(closed.begin(), closed.end(), [&](std::size_t b) {
      return b != a && shapes[a].within(shapes[b]) && !shapes[b].within(shapes[a]);
    });
  }
  return found;
}

}  // namespace

TinTopology topology_of(const Tin& tin) {
  TinTopology topology;
  topology.neighbours.assign(tin.faces.size(),
                             {TinTopology::kBorder, TinTopology::kBorder, TinTopology::kBorder});
  for_each_edge(tin, [&](const HalfEdge* begin, const HalfEdge* end) {
    const auto across = [&](const HalfEdge& half) -> std::int32_t& {
      return topology.neighbours[index(half.face)][static_cast<std::size_t>(half.edge)];
    };
    switch (end - begin) {
      case 1:
        ++topology.border_edges;
        break;
      case 2:
        across(begin[0]) = begin[1].face;
        across(begin[1]) = begin[0].face;
        break;
      default:
        ++topology.non_manifold_edges;
        for (const HalfEdge* half = begin; half != end; ++half) across(*half) = TinTopology::kNonManifold;
    }
  });
  spread(tin, topology);
  return topology;
}

std::size_t orient(Tin& tin, TinTopology& topology) {
  std::vector<bool> turned = spread(tin, topology);
  std::size_t count = 0;
  const auto turn_all = [&](auto&& wanted) {
    for (std::size_t face = 0; face < tin.faces.size(); ++face) {
      const std::size_t component = index(topology.component[face]);
      if (!topology.components[component].orientable || !wanted(face, component)) continue;
      turn(tin, topology, face);
    }
  };
  turn_all([&](std::size_t face, std::size_t) { return turned[face]; });

  std::vector<Shape> shapes(topology.components.size());
  for (std::size_t face = 0; face < tin.faces.size(); ++face) {
    const std::size_t component = index(topology.component[face]);
    const Face& first = tin.faces[index(topology.components[component].first_face)];
    shapes[component].add(tin, tin.faces[face], tin.vertices[index(first[0])]);
  }
  const std::vector<bool> cavity = perhaps_cavities(topology, shapes);
  const auto inside_out = [&](std::size_t component) {
    if (cavity[component]) return false;
    return topology.components[component].closed ? shapes[component].volume < 0
                                                 : shapes[component].plan_area < 0;
  };
  turn_all([&](std::size_t, std::size_t component) { return inside_out(component); });
  for (std::size_t face = 0; face < tin.faces.size(); ++face) {
    const std::size_t component = index(topology.component[face]);
    count += topology.components[component].orientable && turned[face] != inside_out(component);
  }
  return count;
}

}  // namespace sightbound
