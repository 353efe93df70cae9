// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/tin_mesh.h"

#include <algorithm>

namespace sightbound {

TinMesh::TinMesh(const Tin& tin)
    : places_(tin.vertices),
      faces_(tin.faces),
      first_(tin.vertices.size(), kGone),
      next_(3 * tin.faces.size(), kGone),
      previous_(3 * tin.faces.size(), kGone),
      around_(tin.vertices.size()),
      alive_(tin.faces.size()) {
  for (std::int32_t c = 3 * faces() - 1; c >= 0; --c) {  // lists then run upward
    const std::int32_t v = faces_[at(c / 3)][at(c % 3)];
    std::int32_t& first = first_[at(v)];
    next_[at(c)] = first;
    if (first != kGone) previous_[at(first)] = c;
    first = c;
    ++around_[at(v)];
  }
  for (std::int32_t v = 0; v < vertices(); ++v) used_ += has_faces(v);
}

void TinMesh::collapse(std::int32_t gone, std::int32_t kept, const Xyz& to) {
  places_[at(kept)] = to;
  --used_;
  std::int32_t last = kGone;
  for (std::int32_t c = first_[at(gone)], next; c != kGone; c = next) {
    next = next_[at(c)];
    Face& face = faces_[at(c / 3)];
    if (std::find(face.begin(), face.end(), kept) == face.end()) {
      face[at(c % 3)] = kept;
      last = c;
      continue;
    }
    --alive_;
    for (std::int32_t i = 0; i < 3; ++i) unlink(3 * (c / 3) + i, face[at(i)]);
    face[0] = kGone;
  }
  if (last == kGone) return;
  next_[at(last)] = first_[at(kept)];
  if (first_[at(kept)] != kGone) previous_[at(first_[at(kept)])] = last;
  first_[at(kept)] = first_[at(gone)];
  around_[at(kept)] += around_[at(gone)];
  first_[at(gone)] = kGone;
  around_[at(gone)] = 0;
}

void TinMesh::unlink(std::int32_t corner, std::int32_t vertex) {
  const std::int32_t before = previous_[at(corner)], after = next_[at(corner)];
  (before == kGone ? first_[at(vertex)] : next_[at(before)]) = after;
  if (after != kGone) previous_[at(after)] = before;
  --around_[at(vertex)];
}

bool TinMesh::is_edge(std::int32_t a, std::int32_t b) const {
  bool found = false;
  for_each_face(a, [&](std::int32_t f, std::int32_t) {
    found = found || std::find(face(f).begin(), face(f).end(), b) != face(f).end();
  });
  return found;
}

}  // namespace sightbound
