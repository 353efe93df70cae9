// SPDX-License-Identifier: GPL-3.0-or-later
// Any TIN with few triangles, nowhere but where a surface may be: overhangs, bridges, buildings too.
//
//   1 Every triangle that is made is where the containment says that it may be (containment.h), edges and
//     interior included, or in the very planes of those it replaces, covering the same places; all others are
//     the original's. In the inner cover of an error volume: at every point of the result |k| <= z(c).
//   2 The topology stays: components, holes, handles; where the surface is not manifold it stays as it is.
//   3 At each collapse a face turns by less than kMostTurn and none loses its width; with `height_field`
//     none is turned over in plan.
//   4 The outline keeps to its tolerance, both ways (tin_lines.h), and so do break lines, along which edges
//     still run; ends, corners and meeting places of these lines stay.
//   5 Where nothing is allowed only what is coplanar goes (decided without rounding).
//   6 The same bytes every time: one thread.
// That every place of the original has the result near follows for height fields, which keep their footprint;
// for others BothWays (both_ways.h) asks for it. Without it, what is thinner than the tolerance may vanish.
// Method: docs/algorithms/simplify.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "simplify/containment.h"
#include "simplify/simplify.h"
#include "simplify/tin_lines.h"
#include "terrain/tin.h"

namespace sightbound {

inline constexpr double kMostTurn = 0.25;  // cosine (75 degrees)

struct TinSimplifyOptions {
  bool height_field = false;         // plan decides: outline, turned faces; new vertices go up and down
  double outline_tolerance_m = 0;    // 0: only vertices within straight pieces go
  std::vector<TinEdge> break_lines;  // edges; break_lines.h finds them
  double break_tolerance_m = 0;
  std::vector<std::uint8_t> keep;  // vertices that stay where they are where not 0; empty = none
  // Stop as soon as there are no more faces, or as vertices and faces take no more bytes, cheapest collapses
  // first. 0 = until nothing can be removed.
  std::int64_t target_faces = 0;
  SimplifyOptions::Bytes target_bytes;
};

struct TinSimplified {
  // Without the original's attributes: new vertices have none. Where the containment knows it: face attribute
  // "deviation", the largest on that face, metres, rounded up; and the largest of all, and of its ratio to
  // the tolerance.
  Tin tin;
  std::optional<double> largest_deviation_m, largest_ratio;
  std::size_t faces_before = 0;
  std::size_t fixed_vertices = 0;  // where the surface is not manifold
};

// Bytes that it takes besides the containment.
std::size_t simplify_tin_memory(const Tin&);

// The Tin must be clean (tin.h). Throws InvalidInput (sizes that do not agree, a tolerance that is negative
// or not finite), Cancelled. Advances `progress` by 1 in all.
TinSimplified simplify_tin(const Tin&, Containment&, const TinSimplifyOptions&, Progress&);

}  // namespace sightbound
