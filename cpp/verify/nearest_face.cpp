// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/nearest_face.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace sightbound {

namespace {

constexpr std::uint32_t kLeaf = 4;  // triangles

double squared(const Xyz& a) { return dot(a, a); }

double squared_distance(const Box3& box, const Xyz& p) {
  const auto gap = [](double low, double high, double v) { return std::max({low - v, v - high, 0.0}); };
  return squared(
      {gap(box.low.x, box.high.x, p.x), gap(box.low.y, box.high.y, p.y), gap(box.low.z, box.high.z, p.z)});
}

Xyz nearest_on_edge(const Xyz& a, const Xyz& b, const Xyz& p) {
  const Xyz along = b - a;
  const double long2 = squared(along);
  const double t = long2 > 0 ? std::clamp(dot(p - a, along) / long2, 0.0, 1.0) : 0;
  return a + t * along;
}

Box3 box_of(const Triangle3& t) {
  Box3 box{t[0], t[0]};
  for (const Xyz& p : t) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
  }
  return box;
}

}  // namespace

// Above the inside of the triangle when the barycentric weights of the projection are all positive; else
// nearest to one of its edges.
Xyz nearest_place(const Triangle3& triangle, const Xyz& p) {
  const auto& [a, b, c] = triangle;
  const Xyz ab = b - a, ac = c - a, ap = p - a;
  const double bb = dot(ab, ab), bc = dot(ab, ac), cc = dot(ac, ac);
  const double whole = bb * cc - bc * bc;
  const double v = cc * dot(ab, ap) - bc * dot(ac, ap), w = bb * dot(ac, ap) - bc * dot(ab, ap);
  if (whole > 0 && v >= 0 && w >= 0 && v + w <= whole) return a + (v / whole) * ab + (w / whole) * ac;
  Xyz best = nearest_on_edge(a, b, p);
  for (const Xyz& other : {nearest_on_edge(b, c, p), nearest_on_edge(c, a, p)}) {
    if (squared(other - p) < squared(best - p)) best = other;
  }
  return best;
}

NearestFace::NearestFace(std::vector<Triangle3> triangles)
    : triangles_(std::move(triangles)), order_(triangles_.size()) {
  std::iota(order_.begin(), order_.end(), 0U);
  nodes_.reserve(triangles_.size());
  grow(0, static_cast<std::uint32_t>(order_.size()));
}

// Halves by the middles of the triangles' boxes, across the longest side of their box.
std::uint32_t NearestFace::grow(std::uint32_t first, std::uint32_t last) {
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  Box3 box = box_of(triangles_[order_[first]]);
  for (std::uint32_t n = first; n < last; ++n) {
    const Box3 one = box_of(triangles_[order_[n]]);
    box.low = {std::min(box.low.x, one.low.x), std::min(box.low.y, one.low.y),
               std::min(box.low.z, one.low.z)};
    box.high = {std::max(box.high.x, one.high.x), std::max(box.high.y, one.high.y),
                std::max(box.high.z, one.high.z)};
  }
  nodes_[number] = {box, first, last, 0, 0};
  if (last - first <= kLeaf) return number;
  const Xyz size = box.high - box.low;
  double Xyz::*axis = size.x >= size.y && size.x >= size.z ? &Xyz::x : size.y >= size.z ? &Xyz::y : &Xyz::z;
  const auto middle = [&](std::uint32_t n) {
    const auto& [a, b, c] = triangles_[n];
    return std::min({a.*axis, b.*axis, c.*axis}) + std::max({a.*axis, b.*axis, c.*axis});
  };
  const std::uint32_t half = first + (last - first) / 2;
  std::nth_element(
      order_.begin() + first, order_.begin() + half, order_.begin() + last,
      [&](std::uint32_t a, std::uint32_t b) { return std::pair(middle(a), a) < std::pair(middle(b), b); });
  const std::uint32_t lower = grow(first, half), upper = grow(half, last);
  nodes_[number].lower = lower;
  nodes_[number].upper = upper;
  return number;
}

NearestFace::Found NearestFace::nearest(const Xyz& p) const {
  struct Ahead {
    double squared_distance;
    std::uint32_t node;
  };
  std::array<Ahead, 128> ahead;  // two a level of a halving tree of at most 2^32
  std::size_t count = 0;
  ahead[count++] = {0, 0};
  double best = std::numeric_limits<double>::infinity();
  Found found;
  while (count > 0) {
    const Ahead next = ahead[--count];
    if (next.squared_distance > best) continue;
    const Node& node = nodes_[next.node];
    if (node.lower != 0) {
      Ahead a{squared_distance(nodes_[node.lower].box, p), node.lower},
          b{squared_distance(nodes_[node.upper].box, p), node.upper};
      if (a.squared_distance < b.squared_distance) std::swap(a, b);
      ahead[count++] = a;
      ahead[count++] = b;
      continue;
    }
    for (std::uint32_t n = node.first; n < node.last; ++n) {
      const std::size_t face = order_[n];
      const Xyz place = nearest_place(triangles_[face], p);
      const double d = squared(place - p);
      if (d < best || (d == best && face < found.face)) {
        best = d;
        found = {0, face, place};
      }
    }
  }
  found.distance = std::sqrt(best);
  return found;
}

}  // namespace sightbound
