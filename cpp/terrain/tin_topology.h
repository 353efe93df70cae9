// SPDX-License-Identifier: GPL-3.0-or-later
// Which faces of a TIN are neighbours, and turning them alike.
//
// Edge i of a face runs from its corner i to its corner (i + 1) % 3. Two faces are neighbours when they alone
// share an edge; an edge of three or more faces joins nobody (non-manifold). Components are what neighbours
// connect. O(faces) time, 16 bytes a face besides the result.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "terrain/tin.h"

namespace sightbound {

struct TinTopology {
  static constexpr std::int32_t kBorder = -1, kNonManifold = -2;

  struct Component {
    std::int32_t first_face = 0;  // the lowest of its faces
    std::size_t faces = 0;
    bool closed = true;      // no edge is border or non-manifold
    bool orientable = true;  // its faces can all be turned alike (no Moebius strip)
  };

  // The face across each edge, kBorder or kNonManifold.
  std::vector<std::array<std::int32_t, 3>> neighbours;
  std::vector<std::int32_t> component;  // of each face; numbered by first face
  std::vector<Component> components;
  std::size_t border_edges = 0, non_manifold_edges = 0;
};

// Needs indices in range and three different corners a face.
TinTopology topology_of(const Tin&);

// Turns faces (corners 1 and 2 swapped, hence edges 0 and 2) so that all of an orientable component agree:
//   closed components outward, but one that lies within another's bounding box stays as its first face is (it
//   may be a cavity); open ones so that their area seen from above is positive, or as the first face is where
//   that is zero.
// Faces of a component that is not orientable stay as they are. `topology` is kept true. Returns how many
// were turned.
std::size_t orient(Tin&, TinTopology&);

}  // namespace sightbound
