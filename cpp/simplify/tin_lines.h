// SPDX-License-Identifier: GPL-3.0-or-later
// The lines of a TIN that stay: its outline, round its holes too, and its break lines; and which of their
// vertices may go.
//
// Vertices of lines never move; some go, and each edge of the simplified line stands for the piece of the
// original one between its ends. All original vertices of the piece stay within the line's tolerance of the
// edge. So does every place of the piece (distance from an edge is a convex function), and every place of the
// edge has one of the piece as near (going along the piece, the nearest place of the edge runs from one end
// to the other). With a tolerance of 0 the piece is straight without rounding. Ends, corners and vertices
// where lines meet stay.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "base/progress.h"
#include "simplify/tin_mesh.h"

namespace sightbound {

// What may become of a vertex.
enum class TinVertexKind : std::uint8_t {
  kInside,   // anything
  kOutline,  // leave the outline
  kBreak,    // leave a break line
  kFixed,    // nothing: where faces are no plain surface, corners and ends of lines, vertices to keep
};

enum class TinEdgeKind : std::uint8_t { kNone, kOutline, kBreak };

// A line turns by more than this at a corner (cosine of 60 degrees).
inline constexpr double kCornerTurn = 0.5;

// Two vertices.
using TinEdge = std::array<std::int32_t, 2>;

struct TinLineRules {
  double outline_tolerance_m = 0, break_tolerance_m = 0;
  bool in_plan = false;  // tolerances and turns are measured in x and y alone
};

class TinLines {
 public:
  // Throws InvalidInput for a break line that is no edge of the mesh, Cancelled.
  TinLines(const TinMesh&, const std::vector<TinEdge>& break_lines, const TinLineRules&, Progress&);

  // Of the original mesh.
  TinVertexKind kind(std::int32_t vertex) const { return kinds_[static_cast<std::size_t>(vertex)]; }
  std::size_t not_manifold() const { return not_manifold_; }  // vertices fixed for that
  void fix(std::int32_t vertex) { kinds_[static_cast<std::size_t>(vertex)] = TinVertexKind::kFixed; }

  // As the lines are now.
  TinEdgeKind edge(std::int32_t a, std::int32_t b) const {
    const auto found = edges_.find(key(a, b));
    return found == edges_.end() ? TinEdgeKind::kNone : found->second;
  }
  // May this vertex of a line be drawn into that neighbour along it?
  bool may_go(std::int32_t gone, std::int32_t kept) const;
  void went(std::int32_t gone, std::int32_t kept);
  // Of a vertex that may go, along the line.
  std::int32_t other_neighbour(std::int32_t vertex, std::int32_t one) const {
    const auto& now = neighbours_.at(vertex).now;
    return now[0] == one ? now[1] : now[0];
  }

 private:
  // Along the line, now and in the original; and how far it may stray there.
  struct Neighbours {
    std::array<std::int32_t, 2> now, original;
    double tolerance = 0;
  };
  using NeighboursOf = std::unordered_map<std::int32_t, std::vector<std::int32_t>>;

  static std::uint64_t key(std::int32_t a, std::int32_t b) {
    const auto [low, high] = a < b ? std::array{a, b} : std::array{b, a};
    return static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high);
  }
  void find_outline(NeighboursOf&, Progress&);
  void add_break_lines(const std::vector<TinEdge>&, NeighboursOf&);
  void decide(const NeighboursOf&);
  bool is_corner(std::int32_t vertex, const std::vector<std::int32_t>& neighbours) const;
  // Of vertices of lines, also of those that went: they never move.
  Xyz place(std::int32_t vertex) const {
    const Xyz& p = mesh_.place(vertex);
    return rules_.in_plan ? Xyz{p.x, p.y, 0} : p;
  }
  bool near(std::int32_t vertex, std::int32_t from, std::int32_t to, double tolerance) const;

  const TinMesh& mesh_;
  TinLineRules rules_;
  std::vector<TinVertexKind> kinds_;
  std::size_t not_manifold_ = 0;
  std::unordered_map<std::uint64_t, TinEdgeKind> edges_;
  std::unordered_set<std::uint64_t> breaks_of_outline_;      // edges of the outline that are break lines too
  std::unordered_map<std::int32_t, Neighbours> neighbours_;  // of kOutline and kBreak vertices
};

}  // namespace sightbound
