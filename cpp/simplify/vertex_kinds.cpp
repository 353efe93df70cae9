// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/vertex_kinds.h"

namespace sightbound {

namespace {

bool is_straight(const PlanMesh& mesh, std::int32_t v, std::int32_t a, std::int32_t b) {
  const Point p = mesh.place(v), p_a = mesh.place(a), p_b = mesh.place(b);
  const bool ahead = (p_a.x - p.x) * (p_b.x - p.x) + (p_a.y - p.y) * (p_b.y - p.y) < 0;
  return ahead && area2(p, p_a, p_b) == 0;
}

bool is_corner_of_raster(const PlanMesh& mesh, std::int32_t v, const KindRules& rules) {
  const int row = mesh.step_y(v) / kStepsPerCell, col = mesh.step_x(v) / kStepsPerCell;
  return (row == 0 || row == rules.rows - 1) && (col == 0 || col == rules.cols - 1);
}

// Of an end, a junction, or where a line meets the outline.
constexpr VertexKind kEndOfLine = VertexKind::kCorner;

}  // namespace

VertexKind kind_of(const PlanMesh& mesh, std::int32_t v, const KindRules& rules) {
  const std::int32_t first = mesh.first_corner(v);
  const bool outline = mesh.on_outline(first);
  int lines = 0, strayed = 0;  // edges
  const auto look_at = [&](std::int32_t across) {
    lines += mesh.line(across).break_line ? 1 : 0;
    strayed += mesh.line(across).strayed > 0 ? 1 : 0;
  };
  std::int32_t last = first, corner = first;
  do {
    look_at(PlanMesh::previous(corner));
    last = corner;
    corner = mesh.counterclockwise(corner);
  } while (corner != PlanMesh::kNone && corner != first);
  if (!outline) {
    if (lines == 0) return VertexKind::kInside;
    return lines == 2 ? VertexKind::kOnLine : kEndOfLine;
  }
  look_at(PlanMesh::next(last));
  if (rules.keep_border) return VertexKind::kFixed;
  // A break line may run along the outline; where it leaves it or bends with it, it stays.
  const bool along = lines == 2 && mesh.line(PlanMesh::previous(first)).break_line &&
                     mesh.line(PlanMesh::next(last)).break_line;
  if (lines > 0 && !along) return kEndOfLine;
  const std::int32_t a = mesh.vertex(PlanMesh::next(first)), b = mesh.vertex(PlanMesh::previous(last));
  if (strayed == 0 && is_straight(mesh, v, a, b)) return VertexKind::kOutline;
  const bool may_leave = rules.border_moves && lines == 0 && !is_corner_of_raster(mesh, v, rules);
  return may_leave ? VertexKind::kOnLine : VertexKind::kCorner;
}

}  // namespace sightbound
