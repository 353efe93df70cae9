// SPDX-License-Identifier: GPL-3.0-or-later
// Faces that all turn counterclockwise in plan cover each place as often as their border winds round it:
// edges inside cancel. So only border edges are looked at.
//   1. A directed edge used twice: two faces lie on the same side of it and overlap.
//   2. Two border edges that cross: left of both the cover is two more than right of both, so at least two.
//   3. Without crossings the cover left of an edge changes only where another border touches it: it is
//   counted at
//      three places beside each edge, by the border edges above (a vertical ray).
// kPlanOverlap loosens 2 (ends that near to the other edge touch it) and 3 (how far beside an edge is
// looked).
#include "terrain/tin_height_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include <CGAL/box_intersection_d.h>

namespace sightbound {

namespace {

struct Point {
  double x, y;
};
struct Edge {  // the cover is on its left
  Point from, to;
  std::int32_t face;
};

std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }

// Positive beyond the rounding of its evaluation: two differences and a product each side, 4 ulp with margin.
bool looks_up(const Tin& tin, const Face& face) {
  constexpr double kRounding = 0x1p-50;
  const Xyz& a = tin.vertices[index(face[0])];
  const Xyz &b = tin.vertices[index(face[1])], &c = tin.vertices[index(face[2])];
  const double left = (b.x - a.x) * (c.y - a.y), right = (c.x - a.x) * (b.y - a.y);
  return left - right > kRounding * (std::abs(left) + std::abs(right));
}

struct Border {
  std::vector<Edge> edges;
  std::optional<std::int32_t> doubled;  // a face of an edge used twice in one direction
};

// Directed edges without their reverse.
Border border_of(const Tin& tin) {
  Border border;
  std::vector<std::size_t> start(tin.vertices.size() + 1, 0);
  for (const Face& face : tin.faces) {
    for (std::size_t i = 0; i < 3; ++i) ++start[index(std::min(face[i], face[(i + 1) % 3])) + 1];
  }
  for (std::size_t v = 1; v < start.size(); ++v) start[v] += start[v - 1];
  struct Half {
    std::int32_t other, face;
    bool up;  // runs from the lower vertex to the higher
  };
  std::vector<Half> halves(3 * tin.faces.size());
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  for (std::size_t f = 0; f < tin.faces.size(); ++f) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t a = tin.faces[f][i], b = tin.faces[f][(i + 1) % 3];
      halves[next[index(std::min(a, b))]++] = {std::max(a, b), static_cast<std::int32_t>(f), a < b};
    }
  }
  const auto point = [&](std::size_t v) { return Point{tin.vertices[v].x, tin.vertices[v].y}; };
  for (std::size_t v = 0; v + 1 < start.size(); ++v) {
    const auto begin = halves.begin() + static_cast<std::ptrdiff_t>(start[v]);
    const auto end = halves.begin() + static_cast<std::ptrdiff_t>(start[v + 1]);
    std::sort(begin, end, [](const Half& a, const Half& b) {
      return std::tuple(a.other, a.up, a.face) < std::tuple(b.other, b.up, b.face);
    });
    for (auto i = begin; i != end; ++i) {
      const bool again = i + 1 != end && (i + 1)->other == i->other;
      if (again && (i + 1)->up == i->up) {
        border.doubled = i->face;
        return border;
      }
      if (again) {
        ++i;
        if (i + 1 != end && (i + 1)->other == i->other) {  // a third face doubles one of the two directions
          border.doubled = (i + 1)->face;
          return border;
        }
        continue;
      }
      Edge edge{point(v), point(index(i->other)), i->face};
      if (!i->up) std::swap(edge.from, edge.to);
      border.edges.push_back(edge);
    }
  }
  return border;
}

// Distance of p from the line through an edge, positive on its left; 0 for an edge too short to have a side.
double side(const Edge& e, const Point& p) {
  const double dx = e.to.x - e.from.x, dy = e.to.y - e.from.y, long_ = std::hypot(dx, dy);
  return long_ == 0 ? 0 : (dx * (p.y - e.from.y) - dy * (p.x - e.from.x)) / long_;
}

bool apart(double a, double b) {
  return (a > kPlanOverlap && b < -kPlanOverlap) || (a < -kPlanOverlap && b > kPlanOverlap);
}

bool cross_deeply(const Edge& a, const Edge& b) {
  return apart(side(a, b.from), side(a, b.to)) && apart(side(b, a.from), side(b, a.to));
}

std::optional<std::pair<std::int32_t, std::int32_t>> crossing(const std::vector<Edge>& edges) {
  using Box = CGAL::Box_intersection_d::Box_with_handle_d<double, 2, std::vector<Edge>::const_iterator>;
  struct Found {};
  std::vector<Box> boxes;
  boxes.reserve(edges.size());
  for (auto e = edges.begin(); e != edges.end(); ++e) {
    std::array<double, 2> low{std::min(e->from.x, e->to.x), std::min(e->from.y, e->to.y)};
    std::array<double, 2> high{std::max(e->from.x, e->to.x), std::max(e->from.y, e->to.y)};
    boxes.emplace_back(low.data(), high.data(), e);
  }
  std::optional<std::pair<std::int32_t, std::int32_t>> found;
  try {
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& a, const Box& b) {
      if (!cross_deeply(*a.handle(), *b.handle())) return;
      found = std::minmax(a.handle()->face, b.handle()->face);
      throw Found{};  // the only way out
    });
  } catch (const Found&) {
  }
  return found;
}

// Edges above one another: a static tree of intervals in x, each node with those that hold its middle.
class EdgesAbove {
 public:
  explicit EdgesAbove(const std::vector<Edge>& edges) : edges_(edges) {
    std::vector<std::uint32_t> all(edges.size());
    std::iota(all.begin(), all.end(), 0U);
    root_ = build(std::move(all));
  }

  // How often faces cover p: edges above p that run west less those that run east.
  int cover(const Point& p) const {
    int cover = 0;
    for (std::int32_t n = root_; n >= 0;) {
      const Node& node = nodes_[index(n)];
      // Sorted by their western ends (and eastern ones): the first that begins beyond p ends the search.
      if (p.x < node.middle) {
        for (const std::uint32_t e : node.by_west) {
          if (west(e) > p.x) break;
          cover += above(e, p);
        }
        n = node.west;
      } else {
        for (const std::uint32_t e : node.by_east) {
          if (east(e) <= p.x) break;
          cover += above(e, p);
        }
        n = node.east;
      }
    }
    return cover;
  }

 private:
  struct Node {
    double middle = 0;
    std::vector<std::uint32_t> by_west, by_east;
    std::int32_t west = -1, east = -1;
  };

  double west(std::uint32_t e) const { return std::min(edges_[e].from.x, edges_[e].to.x); }
  double east(std::uint32_t e) const { return std::max(edges_[e].from.x, edges_[e].to.x); }

  // Half-open in x, so that a ray through a corner meets one of its two edges.
  int above(std::uint32_t e, const Point& p) const {
    if (west(e) > p.x || east(e) <= p.x) return 0;
    const Edge& edge = edges_[e];
    const bool eastward = edge.to.x > edge.from.x;
    const double left = side(edge, p);
    if (eastward ? left >= 0 : left <= 0) return 0;  // p is not below it
    return eastward ? -1 : 1;
  }

  std::int32_t build(std::vector<std::uint32_t> edges) {
    if (edges.empty()) return -1;
    std::vector<double> ends;
    for (const std::uint32_t e : edges) ends.push_back(west(e));
    const auto half = ends.begin() + static_cast<std::ptrdiff_t>(ends.size() / 2);
    std::nth_element(ends.begin(), half, ends.end());
    Node node;
    node.middle = *half;
    std::vector<std::uint32_t> to_west, to_east;
    for (const std::uint32_t e : edges) {
      if (east(e) < node.middle) {
        to_west.push_back(e);
      } else if (west(e) > node.middle) {
        to_east.push_back(e);
      } else {
        node.by_west.push_back(e);
      }
    }
    edges = {};
    node.by_east = node.by_west;
    std::sort(node.by_west.begin(), node.by_west.end(), [&](auto a, auto b) { return west(a) < west(b); });
    std::sort(node.by_east.begin(), node.by_east.end(), [&](auto a, auto b) { return east(a) > east(b); });
    const auto place = static_cast<std::int32_t>(nodes_.size());
    nodes_.push_back(std::move(node));
    const std::int32_t w = build(std::move(to_west)), e = build(std::move(to_east));
    nodes_[index(place)].west = w;
    nodes_[index(place)].east = e;
    return place;
  }

  const std::vector<Edge>& edges_;
  std::vector<Node> nodes_;
  std::int32_t root_ = -1;
};

// A face beside whose border edge others lie as well.
std::optional<std::int32_t> covered_twice(const std::vector<Edge>& edges) {
  constexpr std::array<double, 3> kPlaces{1.0 / 64, 0.5, 63.0 / 64};
  const EdgesAbove above(edges);
  for (const Edge& e : edges) {
    const double dx = e.to.x - e.from.x, dy = e.to.y - e.from.y, long_ = std::hypot(dx, dy);
    for (const double t : kPlaces) {
      const Point beside{e.from.x + t * dx - kPlanOverlap * dy / long_,
                         e.from.y + t * dy + kPlanOverlap * dx / long_};
      if (above.cover(beside) > 1) return e.face;
    }
  }
  return {};
}

std::string face_text(std::int32_t face) { return "face " + std::to_string(face) + " (counted from 0)"; }

}  // namespace

HeightFieldTest height_field_test(const Tin& tin) {
  std::size_t others = 0;
  std::int32_t first = 0;
  for (std::size_t f = tin.faces.size(); f-- > 0;) {
    if (looks_up(tin, tin.faces[f])) continue;
    first = static_cast<std::int32_t>(f);
    ++others;
  }
  if (others == 1) return {false, face_text(first) + " is vertical or looks down"};
  if (others > 1) {
    return {false, std::to_string(others) + " faces are vertical or look down, " + face_text(first) +
                       " is the first"};
  }
  const Border border = border_of(tin);
  if (border.doubled)
    return {false, face_text(*border.doubled) + " overlaps a face that shares an edge with it"};
  if (const auto pair = crossing(border.edges)) {
    return {false, "the borders of faces " + std::to_string(pair->first) + " and " +
                       std::to_string(pair->second) + " cross in plan"};
  }
  if (const auto face = covered_twice(border.edges)) {
    return {false, "other faces lie above or below " + face_text(*face)};
  }
  return {true, ""};
}

}  // namespace sightbound
