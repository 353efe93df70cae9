// SPDX-License-Identifier: GPL-3.0-or-later
// The outline of a TIN, round its holes too, and which of its vertices may go.
//
// Vertices of the outline never move; some go, and each edge of the simplified outline stands for the piece
// of the original one between its ends. All original vertices of the piece stay within `tolerance` of the
// edge. So does every place of the piece (distance from an edge is a convex function), and every place of the
// edge has one of the piece as near (going along the piece, the nearest place of the edge runs from one end
// to the other). With a tolerance of 0 the piece is straight without rounding.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "simplify/tin_mesh.h"

namespace sightbound {

// What may become of a vertex.
enum class TinVertexKind : std::uint8_t {
  kInside,   // anything
  kOutline,  // leave the outline
  kFixed,    // nothing: where faces are no plain surface, corners of the outline, vertices to keep
};

// The outline turns by more than this at a corner (cosine of 60 degrees).
inline constexpr double kCornerTurn = 0.5;

class TinOutline {
 public:
  // `in_plan`: tolerance and turns are measured in x and y alone.
  TinOutline(const TinMesh&, double tolerance_m, bool in_plan);

  // Of the original mesh.
  TinVertexKind kind(std::int32_t vertex) const { return kinds_[static_cast<std::size_t>(vertex)]; }
  std::size_t not_manifold() const { return not_manifold_; }  // vertices fixed for that
  void fix(std::int32_t vertex) { kinds_[static_cast<std::size_t>(vertex)] = TinVertexKind::kFixed; }

  // May this vertex of the outline be drawn into that neighbour along it?
  bool may_go(std::int32_t gone, std::int32_t kept) const;
  void went(std::int32_t gone, std::int32_t kept);
  // Of a vertex of the outline, along it.
  std::int32_t other_neighbour(std::int32_t vertex, std::int32_t one) const {
    const auto& now = outline_.at(vertex).now;
    return now[0] == one ? now[1] : now[0];
  }

 private:
  // The neighbours along the outline, now and in the original.
  struct Neighbours {
    std::array<std::int32_t, 2> now, original;
  };

  // False where the faces around it are no plain surface.
  bool look_at(std::int32_t vertex);
  bool is_corner(std::int32_t vertex, const Neighbours&) const;
  // Of vertices of the outline, also of those that went: they never move.
  Xyz place(std::int32_t vertex) const {
    const Xyz& p = mesh_.place(vertex);
    return in_plan_ ? Xyz{p.x, p.y, 0} : p;
  }
  bool near(std::int32_t vertex, std::int32_t from, std::int32_t to) const;

  const TinMesh& mesh_;
  double tolerance_;
  bool in_plan_;
  std::vector<TinVertexKind> kinds_;
  std::size_t not_manifold_ = 0;
  std::unordered_map<std::int32_t, Neighbours> outline_;  // of kOutline vertices
};

}  // namespace sightbound
