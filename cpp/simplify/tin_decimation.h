// SPDX-License-Identifier: GPL-3.0-or-later
// The collapses of a TIN, cheapest first. Internal to cpp/simplify.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "base/progress.h"
#include "simplify/bucket_queue.h"
#include "simplify/containment.h"
#include "simplify/tin_lines.h"
#include "simplify/tin_mesh.h"
#include "simplify/tin_quadric.h"

namespace sightbound {

class TinDecimation {
 public:
  // `in_plan`: the shape of faces counts in x and y alone, and the heights of new vertices are free.
  TinDecimation(TinMesh& mesh, TinLines& lines, Containment& containment, bool in_plan);

  // Tries all edges that have changed since they were tried, until it is enough. How many faces went.
  // Advances `progress` by `share`.
  std::size_t pass(const std::function<bool()>& enough, double share, Progress& progress);

 private:
  struct Edge {
    std::int32_t a, b;
    std::uint32_t change_a, change_b;  // stale when these are no longer the vertices'
  };
  struct Collapse {
    std::int32_t gone, kept;
    Xyz to;
  };
  // Faces around an edge.
  struct Star {
    std::vector<std::int32_t> a, b, both;
    std::vector<std::int32_t> ring_a, ring_b;  // neighbours of a and of b, other than these
  };

  void add_quadrics();
  std::vector<Collapse> candidates(std::int32_t a, std::int32_t b) const;  // cheapest first
  double cost(const Collapse&) const;
  void push(std::int32_t a, std::int32_t b);
  bool try_edge(std::int32_t a, std::int32_t b);
  void look_around(std::int32_t a, std::int32_t b);
  bool between_lines(std::int32_t a, std::int32_t b) const;  // no end is inside
  bool topology_stays() const;
  // Tests all, and makes it when it may be.
  bool make_if_allowed(Collapse);
  StarChange change_of(const Collapse&) const;
  bool well_shaped(const std::array<Xyz, 3>& before, const std::array<Xyz, 3>& after) const;
  bool same_surface(const Collapse&) const;
  void make(const Collapse&);

  std::array<Xyz, 3> corners(std::int32_t face) const;

  TinMesh& mesh_;
  TinLines& lines_;
  Containment& containment_;
  bool in_plan_;
  std::vector<TinQuadric> quadrics_;    // of each vertex, seen from it
  std::vector<std::uint32_t> changes_;  // of each vertex
  std::vector<std::uint8_t> worth_;     // trying: something around the vertex has changed since
  BucketQueue<Edge> queue_;
  Star star_;
  std::int32_t a_ = 0, b_ = 0;  // whose star it is
};

}  // namespace sightbound
