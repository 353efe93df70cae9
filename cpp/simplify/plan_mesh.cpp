// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/plan_mesh.h"

#include <algorithm>
#include <cmath>

namespace sightbound {

PlanMesh::PlanMesh(const Grid<float>& heights, const Window& held, const Window& window,
                   const Grid<std::uint8_t>& lines) {
  const int rows = window.rows, cols = window.cols;
  const auto height = [&](int r, int c) {
    return heights.at(window.row - held.row + r, window.col - held.col + c);
  };
  const auto there = [&](int r, int c) { return !std::isnan(height(r, c)); };
  std::vector<std::int32_t> number(window.cells(), kNone);
  const auto vertex_at = [&](int r, int c) {
    std::int32_t& n =
        number[static_cast<std::size_t>(r) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(c)];
    if (n == kNone) {
      n = static_cast<std::int32_t>(vertices_.size());
      vertices_.push_back({height(r, c), (window.col + c) * kStepsPerCell, (window.row + r) * kStepsPerCell});
    }
    return n;
  };
  // A square's triangles: NW, NE, SE and NW, SE, SW. The lower ones of the row above wait for their
  // neighbours.
  std::vector<std::int32_t> above(static_cast<std::size_t>(cols), kNone);
  for (int r = 0; r + 1 < rows; ++r) {
    std::int32_t left = kNone;  // the upper triangle of the square to the left
    for (int c = 0; c + 1 < cols; ++c) {
      const bool ends = there(r, c) && there(r + 1, c + 1);
      const auto add = [&](int r1, int c1, int r2, int c2, std::int32_t marks) {
        const auto corner = static_cast<std::int32_t>(corners_.size());
        for (const std::int32_t v : {vertex_at(r, c), vertex_at(r1, c1), vertex_at(r2, c2)}) {
          vertices_[at(v)].corner = static_cast<std::int32_t>(corners_.size());
          corners_.push_back({v, kNone});
        }
        corners_.push_back({kNone, marks});
        return corner;
      };
      const auto mark = [&](int corner, int row, int col, LineBits bit) {
        return !lines.empty() && (lines.at(row, col) & bit) != 0 ? kBreakLine << line_shift(corner) : 0;
      };
      std::int32_t upper = kNone, lower = kNone;
      if (ends && there(r, c + 1)) {
        upper = add(r, c + 1, r + 1, c + 1,
                    mark(0, r, c + 1, kLineSouth) | mark(1, r, c, kLineSouthEast) | mark(2, r, c, kLineEast));
      }
      if (ends && there(r + 1, c)) {
        lower = add(r + 1, c + 1, r + 1, c,
                    mark(0, r + 1, c, kLineEast) | mark(1, r, c, kLineSouth) | mark(2, r, c, kLineSouthEast));
      }
      std::int32_t& over = above[at(c)];
      if (upper != kNone && lower != kNone) join(upper + 1, lower + 2);
      if (upper != kNone && over != kNone) join(upper + 2, over);
      if (lower != kNone && left != kNone) join(left, lower + 1);
      left = upper;
      over = lower;
    }
  }
  split_touching();
}

std::size_t PlanMesh::count_faces() const {
  std::size_t count = 0;
  for (std::size_t c = 0; c < corners_.size(); c += 4) count += corners_[c].vertex != kNone ? 1 : 0;
  return count;
}

std::vector<std::int32_t> PlanMesh::compact() {
  std::vector<std::int32_t> old, number(vertices_.size(), kNone);
  for (std::int32_t v = 0; at(v) < vertices_.size(); ++v) {
    if (corner_of(v) == kNone) continue;
    number[at(v)] = static_cast<std::int32_t>(old.size());
    vertices_[old.size()] = vertices_[at(v)];
    old.push_back(v);
  }
  vertices_.resize(old.size());
  vertices_.shrink_to_fit();
  std::vector<std::int32_t> triangle(triangles(), kNone);
  std::int32_t left = 0;
  for (std::int32_t t = 0; at(t) < triangles(); ++t) {
    if (alive(t)) triangle[at(t)] = left++;
  }
  const auto moved = [&](std::int32_t corner) {
    return corner == kNone ? kNone : 4 * triangle[at(corner / 4)] + corner % 4;
  };
  for (std::int32_t c = 0; at(c) < corners_.size(); ++c) {
    if (triangle[at(c / 4)] == kNone) continue;
    const Corner corner = corners_[at(c)];
    const bool marks = (c & 3) == 3;
    corners_[at(moved(c))] = marks ? corner : Corner{number[at(corner.vertex)], moved(corner.opposite)};
  }
  corners_.resize(4 * at(left));
  corners_.shrink_to_fit();
  for (Vertex& v : vertices_) v.corner = moved(v.corner);
  return old;
}

std::int32_t PlanMesh::first_corner(std::int32_t vertex) const {
  const std::int32_t start = corner_of(vertex);
  for (std::int32_t corner = start;;) {
    const std::int32_t before = clockwise(corner);
    if (before == kNone) return corner;
    if (before == start) return start;
    corner = before;
  }
}

std::int32_t PlanMesh::corner_towards(std::int32_t a, std::int32_t b) const {
  const std::int32_t start = first_corner(a);
  std::int32_t corner = start;
  do {
    if (vertex(next(corner)) == b) return corner;
    corner = counterclockwise(corner);
  } while (corner != kNone && corner != start);
  return kNone;
}

void PlanMesh::collapse(std::int32_t corner, std::int32_t kept) {
  const std::int32_t gone = vertex(corner) == kept ? vertex(next(corner)) : vertex(corner);
  const std::int32_t left = previous(corner),
                     right = opposite(previous(corner));  // right: apex of the other triangle
  const std::int32_t first = first_corner(gone);
  for (std::int32_t c = first;;) {
    const std::int32_t after = counterclockwise(c);
    corners_[at(c)].vertex = kept;
    if (after == kNone || after == first) break;
    c = after;
  }
  vertices_[at(gone)].corner = kNone;
  vertices_[at(gone)].x = kept;
  remove_triangle(left);
  if (right != kNone) remove_triangle(right);
}

// The triangle's edge opposite to `apex` has become a point: its two other edges become one.
void PlanMesh::remove_triangle(std::int32_t apex) {
  const std::int32_t tip = vertex(apex), kept = vertex(next(apex));
  const std::int32_t one = opposite(next(apex)), other = opposite(previous(apex));
  const LineEdgeState a = line(next(apex)), b = line(previous(apex));
  if (one != kNone) corners_[at(one)].opposite = other;
  if (other != kNone) corners_[at(other)].opposite = one;
  // Across the edge from tip to kept, seen from `one` and `other`.
  const std::int32_t beside = one != kNone ? one : other;
  const bool turned = vertex(next(beside)) == tip;
  vertices_[at(tip)].corner = turned ? next(beside) : previous(beside);
  vertices_[at(kept)].corner = turned ? previous(beside) : next(beside);
  set_line(beside, {a.break_line || b.break_line, std::max(a.strayed, b.strayed)});
  for (const std::int32_t c : {apex, next(apex), previous(apex)}) corners_[at(c)] = {};
  corners_[at(apex | 3)] = {kNone, 0};
}

void PlanMesh::set_line(std::int32_t corner, const LineEdgeState& state) {
  set_line_here(corner, state);
  if (opposite(corner) != kNone) set_line_here(opposite(corner), state);
}

void PlanMesh::set_line_here(std::int32_t corner, const LineEdgeState& state) {
  constexpr std::int32_t kAll = kBreakLine | kMostStrayed;
  std::int32_t& marks = corners_[at(corner | 3)].opposite;
  const std::int32_t bits = state.strayed | (state.break_line ? kBreakLine : 0);
  marks = (marks & ~(kAll << line_shift(corner))) | (bits << line_shift(corner));
}

void PlanMesh::join(std::int32_t a, std::int32_t b) {
  corners_[at(a)].opposite = b;
  corners_[at(b)].opposite = a;
}

// A sample of several fans of triangles becomes a vertex of each, and none of them moves.
std::vector<std::int32_t> PlanMesh::split_touching() {
  std::vector<std::int32_t> twins;
  std::vector<std::uint8_t> corners(vertices_.size(), 0);
  for (const Corner& corner : corners_) {
    if (corner.vertex != kNone) ++corners[at(corner.vertex)];
  }
  const auto for_fan = [&](std::int32_t vertex, const auto& f) {
    const std::int32_t first = first_corner(vertex);
    std::int32_t c = first;
    do {
      const std::int32_t after = counterclockwise(c);
      f(c);
      c = after;
    } while (c != kNone && c != first);
  };
  const std::size_t samples = vertices_.size();
  for (std::size_t v = 0; v < samples; ++v) {
    for_fan(static_cast<std::int32_t>(v), [&](std::int32_t) { --corners[v]; });
  }
  for (std::size_t c = 0; c < corners_.size(); ++c) {
    const std::int32_t v = corners_[c].vertex;
    if (v == kNone || at(v) >= samples || corners[at(v)] == 0) continue;
    bool of_first_fan = false;
    for_fan(v, [&](std::int32_t k) { of_first_fan |= k == static_cast<std::int32_t>(c); });
    if (of_first_fan) continue;
    const auto twin = static_cast<std::int32_t>(vertices_.size());
    twins.push_back(v);
    set_kind(v, VertexKind::kFixed);
    vertices_.push_back(vertices_[at(v)]);
    vertices_.back().corner = static_cast<std::int32_t>(c);
    for_fan(twin, [&](std::int32_t k) { corners_[at(k)].vertex = twin; });
  }
  return twins;
}

}  // namespace sightbound
