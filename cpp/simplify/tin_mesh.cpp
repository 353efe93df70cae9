// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/tin_mesh.h"

#include <algorithm>

namespace sightbound {

TinMesh::TinMesh(const Tin& tin)
    : places_(tin.vertices),
      faces_(tin.faces),
      first_(tin.vertices.size(), kGone),
      next_(3 * tin.faces.size(), kGone),
      alive_(tin.faces.size()) {
  for (std::int32_t c = 3 * faces() - 1; c >= 0; --c) {  // lists then run upward
    std::int32_t& first = first_[at(faces_[at(c / 3)][at(c % 3)])];
    next_[at(c)] = first;
    first = c;
  }
  for (std::int32_t v = 0; v < vertices(); ++v) used_ += has_faces(v);
}

void TinMesh::collapse(std::int32_t gone, std::int32_t kept, const Xyz& to) {
  places_[at(kept)] = to;
  --used_;
  std::int32_t last = kGone;
  for (std::int32_t c = first_[at(gone)]; c != kGone; c = next_[at(c)]) {
    Face& face = faces_[at(c / 3)];
    last = c;
    if (std::find(face.begin(), face.end(), kept) == face.end()) {
      face[at(c % 3)] = kept;
      continue;
    }
    --alive_;
    const Face dead = face;
    face[0] = kGone;
    for (const std::int32_t v : dead) {
      if (v != gone && v != kept) drop_dead(v);
    }
  }
  if (last != kGone) {
    next_[at(last)] = first_[at(kept)];
    first_[at(kept)] = first_[at(gone)];
  }
  first_[at(gone)] = kGone;
  drop_dead(kept);
}

bool TinMesh::is_edge(std::int32_t a, std::int32_t b) const {
  bool found = false;
  for_each_face(a, [&](std::int32_t f, std::int32_t) {
    found = found || std::find(face(f).begin(), face(f).end(), b) != face(f).end();
  });
  return found;
}

void TinMesh::drop_dead(std::int32_t vertex) {
  std::int32_t* link = &first_[at(vertex)];
  while (*link != kGone) {
    std::int32_t& next = next_[at(*link)];
    if (alive(*link / 3)) {
      link = &next;
    } else {
      *link = next;
    }
  }
}

}  // namespace sightbound
