// SPDX-License-Identifier: GPL-3.0-or-later
// A triangle mesh in space that shrinks in place: faces, and for each vertex a list of the corners there.
//
// Any faces, non-manifold ones too: nothing here asks how they lie. Corner 3 f + i is corner i of face f.
// 36 bytes a face besides vertices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "terrain/tin.h"

namespace sightbound {

class TinMesh {
 public:
  explicit TinMesh(const Tin&);

  std::int32_t vertices() const { return static_cast<std::int32_t>(places_.size()); }  // with removed ones
  std::int32_t faces() const { return static_cast<std::int32_t>(faces_.size()); }
  std::size_t count_faces() const { return alive_; }
  std::size_t count_vertices() const { return used_; }

  bool alive(std::int32_t face) const { return faces_[at(face)][0] != kGone; }
  const Face& face(std::int32_t face) const { return faces_[at(face)]; }
  const Xyz& place(std::int32_t vertex) const { return places_[at(vertex)]; }

  // Calls f(face, corner 0..2) for every face at a vertex.
  template <class F>
  void for_each_face(std::int32_t vertex, const F& f) const {
    for (std::int32_t c = first_[at(vertex)]; c != kGone; c = next_[at(c)]) f(c / 3, c % 3);
  }
  bool is_edge(std::int32_t a, std::int32_t b) const;
  bool has_faces(std::int32_t vertex) const { return first_[at(vertex)] != kGone; }

  std::int32_t faces_around(std::int32_t vertex) const { return around_[at(vertex)]; }

  // Draws two neighbours together at a place: `gone` goes, and with it the faces of both. O(faces of `gone`).
  void collapse(std::int32_t gone, std::int32_t kept, const Xyz& to);

 private:
  static constexpr std::int32_t kGone = -1;
  static std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }
  void unlink(std::int32_t corner, std::int32_t vertex);

  std::vector<Xyz> places_;
  std::vector<Face> faces_;
  std::vector<std::int32_t> first_, next_, previous_;  // corners
  std::vector<std::int32_t> around_;                   // faces at each vertex
  std::size_t alive_ = 0, used_ = 0;                   // faces, vertices with faces
};

}  // namespace sightbound
