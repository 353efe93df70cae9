// SPDX-License-Identifier: GPL-3.0-or-later
// A triangle mesh over the raster's plane that shrinks in place.
//
// Places in plan are columns and rows in steps of 1/1024, whole numbers: differences and cross products of
// doubles made of them are exact on rasters up to 2^20 cells a side, so that no orientation is ever in doubt.
//
// A corner table: triangle t has the corners 4 t, 4 t + 1, 4 t + 2, counterclockwise where columns run right
// and rows run up. opposite(c) is the corner across the edge that lies opposite to c. What would be the
// fourth corner tells which edges belong to lines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "terrain/grid.h"

namespace sightbound {

inline constexpr int kStepsPerCell = 1024;
inline constexpr int kMostCells = 1 << 20;  // a side

// What may become of a vertex; each may do what those after it may.
enum class VertexKind : std::uint8_t {
  kInside,   // anything
  kOutline,  // move along the straight outline, or leave it
  kOnLine,   // leave its line, within the line's tolerance, or take another height
  kCorner,   // take another height
  kFixed,    // nothing
  kRim,      // nothing, until its block is joined to the next
};

// Edges of the regular TIN that break lines run along, at the sample in the northwest.
enum LineBits : std::uint8_t { kLineEast = 1, kLineSouth = 2, kLineSouthEast = 4 };

struct Point {
  double x = 0, y = 0, z = 0;  // columns, rows, metres
};

inline double cross(double ax, double ay, double bx, double by) { return ax * by - ay * bx; }
// Twice the plan area of a, b, c; positive when counterclockwise.
inline double area2(const Point& a, const Point& b, const Point& c) {
  return cross(b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y);
}

// For values of which so much of all is there: vectors that grow by copying would take half as much again.
// Room that is not used takes no memory.
template <class T>
void make_room(std::vector<T>& values, double part) {
  constexpr double kSpare = 1.25;
  const double all = static_cast<double>(values.size()) / part;
  if (all > static_cast<double>(values.capacity())) values.reserve(static_cast<std::size_t>(kSpare * all));
}

class PlanMesh {
 public:
  static constexpr std::int32_t kNone = -1;
  static constexpr std::size_t kMostTriangles =
      (std::size_t{1} << 29) - 1;  // corners are numbered in 31 bits

  PlanMesh() = default;
  // The regular TIN of a window of a DEM; `heights` are those of a window that holds it, `lines` the LineBits
  // of the window's samples, or empty. All vertices are inside, but where parts touch in one sample only: it
  // becomes a vertex of each, and none of them moves.
  PlanMesh(const Grid<float>& heights, const Window& held, const Window& window,
           const Grid<std::uint8_t>& lines);

  std::size_t vertices() const { return vertices_.size(); }  // removed ones included
  std::size_t triangles() const { return corners_.size() / 4; }
  std::size_t count_faces() const;  // those not removed

  static std::int32_t next(std::int32_t corner) { return (corner & 3) == 2 ? corner - 2 : corner + 1; }
  static std::int32_t previous(std::int32_t corner) { return (corner & 3) == 0 ? corner + 2 : corner - 1; }
  std::int32_t vertex(std::int32_t corner) const { return corners_[at(corner)].vertex; }
  std::int32_t opposite(std::int32_t corner) const { return corners_[at(corner)].opposite; }
  // Of the edge opposite to a corner: does it belong to a break line, and by how many steps has it strayed
  // from where its line or the outline was (line_rules.h)?
  struct LineEdgeState {
    bool break_line = false;
    std::int32_t strayed = 0;
  };
  LineEdgeState line(std::int32_t corner) const {
    const std::int32_t bits = corners_[at(corner | 3)].opposite >> line_shift(corner);
    return {(bits & kBreakLine) != 0, bits & kMostStrayed};
  }
  void set_line(std::int32_t corner, const LineEdgeState&);  // seen from both sides
  // Some corner at a vertex; kNone = removed.
  std::int32_t corner_of(std::int32_t vertex) const { return vertices_[at(vertex)].corner; }
  bool alive(std::int32_t triangle) const { return corners_[at(4 * triangle)].vertex != kNone; }
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
  bool on_outline(std::int32_t first_corner) const { return opposite(previous(first_corner)) == kNone; }
  // A corner at one of a and b whose next is at the other; kNone = they are no neighbours.
  std::int32_t edge(std::int32_t a, std::int32_t b) const {
    const std::int32_t corner = corner_towards(a, b);
    return corner != kNone ? corner : corner_towards(b, a);
  }

  std::int32_t step_x(std::int32_t vertex) const { return vertices_[at(vertex)].x; }
  std::int32_t step_y(std::int32_t vertex) const { return vertices_[at(vertex)].y; }
  Point place(std::int32_t vertex) const {
    constexpr double kCell = 1.0 / kStepsPerCell;
    const Vertex& v = vertices_[at(vertex)];
    return {v.x * kCell, v.y * kCell, v.z};
  }
  VertexKind kind(std::int32_t vertex) const { return vertices_[at(vertex)].kind; }
  void set_kind(std::int32_t vertex, VertexKind kind) { vertices_[at(vertex)].kind = kind; }

  // To a place on the lattice of steps.
  void move(std::int32_t vertex, const Point& to) {
    Vertex& v = vertices_[at(vertex)];
    v.x = static_cast<std::int32_t>(to.x * kStepsPerCell);
    v.y = static_cast<std::int32_t>(to.y * kStepsPerCell);
    v.z = to.z;
  }
  // Makes room, this being so much of what there will be.
  void expect_of_all(double part) {
    make_room(vertices_, part);
    make_room(corners_, part);
  }
  std::size_t bytes() const { return vertices_.size() * sizeof(Vertex) + corners_.size() * sizeof(Corner); }
  // Forgets what was removed, in the same order. Returns the old numbers of the vertices.
  std::vector<std::int32_t> compact();
  // Draws the edge from a corner's vertex to its next's together: `kept` is one of the two, the other goes.
  void collapse(std::int32_t corner, std::int32_t kept);
  // Of a vertex that went, until compact(): the one it was drawn into.
  std::int32_t drawn_into(std::int32_t gone) const { return vertices_[at(gone)].x; }

  static constexpr std::int32_t kMostStrayed = (1 << 9) - 1;

 private:
  friend class BlockJoiner;

  struct Corner {
    std::int32_t vertex = kNone, opposite = kNone;
  };
  struct Vertex {
    double z;
    std::int32_t x, y;  // steps
    std::int32_t corner = kNone;
    VertexKind kind = VertexKind::kInside;
  };

  static std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }
  static constexpr std::int32_t kBreakLine = 1 << 9;
  static int line_shift(std::int32_t corner) { return 10 * (corner & 3); }
  void set_line_here(std::int32_t corner, const LineEdgeState&);
  void join(std::int32_t a, std::int32_t b);
  void remove_triangle(std::int32_t apex);
  // Returns whose twins the vertices are that it appends.
  std::vector<std::int32_t> split_touching();

  std::vector<Corner> corners_;
  std::vector<Vertex> vertices_;
};

}  // namespace sightbound
