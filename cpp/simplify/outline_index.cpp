// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/outline_index.h"

#include <algorithm>

namespace sightbound {

bool OutlineIndex::any_in(const PlanMesh& mesh, std::int32_t a, std::int32_t b, std::int32_t n) const {
  Point p = mesh.place(a), q = mesh.place(b);
  const Point r = mesh.place(n);
  if (area2(p, q, r) < 0) std::swap(p, q);
  const auto inside = [&](const Point& at) {
    return area2(p, q, at) >= 0 && area2(q, r, at) >= 0 && area2(r, p, at) >= 0;
  };
  const auto [left, right] = std::minmax({p.x, q.x, r.x});
  const auto [top, bottom] = std::minmax({p.y, q.y, r.y});
  for (std::int64_t y = step(top); y <= step(bottom); ++y) {
    for (std::int64_t x = step(left); x <= step(right); ++x) {
      const auto found = bins_.find(bin(x, y));
      if (found == bins_.end()) continue;
      for (const std::int32_t v : found->second) {
        if (v == a || v == b || v == n || mesh.corner_of(v) == PlanMesh::kNone) continue;
        if (inside(mesh.place(v))) return true;
      }
    }
  }
  return false;
}

}  // namespace sightbound
