// SPDX-License-Identifier: GPL-3.0-or-later
// A triangle mesh over the raster's plane that shrinks in place.
//
// Places in plan are columns and rows in steps of 1/1024, whole numbers: differences and cross products of
// doubles made of them are exact on rasters up to 65,536 cells a side, so that no orientation is ever in
// doubt.
//
// A corner table: triangle t has the corners 3 t, 3 t + 1, 3 t + 2, counterclockwise where columns run right
// and rows run up. opposite(c) is the corner across the edge that lies opposite to c.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "terrain/grid.h"

namespace sightbound {

inline constexpr int kStepsPerCell = 1024;
inline constexpr int kMostCells = 65536;  // a side

// What may become of a vertex; each may do what those after it may.
enum class VertexKind : std::uint8_t {
  kInside,   // anything
  kOutline,  // move along the straight outline, or leave it
  kCorner,   // take another height
  kFixed,    // nothing
};

class PlanMesh {
 public:
  static constexpr std::int32_t kNone = -1;

  // The regular TIN of a DEM. Where parts touch in one sample only, it becomes a vertex of each.
  explicit PlanMesh(const Grid<float>& heights);

  std::size_t vertices() const { return z_.size(); }  // removed ones included
  std::size_t triangles() const { return vertex_.size() / 3; }
  std::size_t count_faces() const;  // those not removed

  static std::int32_t next(std::int32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
  static std::int32_t previous(std::int32_t corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }
  std::int32_t vertex(std::int32_t corner) const { return vertex_[at(corner)]; }
  std::int32_t opposite(std::int32_t corner) const { return opposite_[at(corner)]; }
  // Some corner at a vertex; kNone = removed.
  std::int32_t corner_of(std::int32_t vertex) const { return corner_[at(vertex)]; }
  bool alive(std::int32_t triangle) const { return vertex_[at(3 * triangle)] != kNone; }
  // The next corner round the same vertex; kNone = the outline lies between.
  std::int32_t counterclockwise(std::int32_t corner) const {
    const std::int32_t across = opposite(next(corner));
    return across == kNone ? kNone : next(across);
  }
  std::int32_t clockwise(std::int32_t corner) const {
    const std::int32_t across = opposite(previous(corner));
    return across == kNone ? kNone : previous(across);
  }
  // The corner at a vertex from which counterclockwise() reaches all others.
  std::int32_t first_corner(std::int32_t vertex) const;
  // The corner at a whose next is b, kNone = there is none.
  std::int32_t corner_towards(std::int32_t a, std::int32_t b) const;

  // The vertex at the very same place that a touching part has of it; itself as a rule.
  std::int32_t twin_of(std::int32_t vertex) const;

  std::int32_t step_x(std::int32_t vertex) const { return x_[at(vertex)]; }
  std::int32_t step_y(std::int32_t vertex) const { return y_[at(vertex)]; }
  double x(std::int32_t vertex) const { return x_[at(vertex)] * (1.0 / kStepsPerCell); }
  double y(std::int32_t vertex) const { return y_[at(vertex)] * (1.0 / kStepsPerCell); }
  double z(std::int32_t vertex) const { return z_[at(vertex)]; }
  VertexKind kind(std::int32_t vertex) const { return kind_[at(vertex)]; }
  void set_kind(std::int32_t vertex, VertexKind kind) { kind_[at(vertex)] = kind; }

  void move(std::int32_t vertex, std::int32_t step_x, std::int32_t step_y, double z) {
    x_[at(vertex)] = step_x, y_[at(vertex)] = step_y, z_[at(vertex)] = z;
  }
  // Draws the edge from a corner's vertex to its next's together: `kept` is one of the two, the other goes.
  void collapse(std::int32_t corner, std::int32_t kept);

 private:
  static std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }
  void join(std::int32_t a, std::int32_t b);
  void remove_triangle(std::int32_t apex);
  void split_touching();
  void find_kinds();
  bool on_outline(std::int32_t first_corner) const { return opposite(previous(first_corner)) == kNone; }

  std::vector<std::int32_t> vertex_, opposite_;  // of corners
  std::vector<std::int32_t> corner_, x_, y_;     // of vertices
  std::vector<double> z_;
  std::vector<VertexKind> kind_;
  std::int32_t first_twin_ = 0;      // vertices from here on are
  std::vector<std::int32_t> twins_;  // those of these
};

}  // namespace sightbound
