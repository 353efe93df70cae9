// SPDX-License-Identifier: GPL-3.0-or-later
// Small TINs for tests.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "terrain/tin.h"

namespace sightbound::testing {

inline Tin tin_of(std::vector<Xyz> vertices, std::vector<Face> faces) {
  Tin tin;
  tin.vertices = std::move(vertices);
  tin.faces = std::move(faces);
  return tin;
}

// One face.
inline Tin triangle(double lift = 0) {
  return tin_of({{0, 0, lift}, {10, 0, lift}, {0, 10, lift}}, {{0, 1, 2}});
}

// All faces outward: 0 1 2 3 are the floor, counterclockwise from above, 4 5 6 7 above them.
inline Tin box(const Xyz& low, const Xyz& high) {
  return tin_of({{low.x, low.y, low.z},
                 {high.x, low.y, low.z},
                 {high.x, high.y, low.z},
                 {low.x, high.y, low.z},
                 {low.x, low.y, high.z},
                 {high.x, low.y, high.z},
                 {high.x, high.y, high.z},
                 {low.x, high.y, high.z}},
                {{0, 2, 1},
                 {0, 3, 2},
                 {4, 5, 6},
                 {4, 6, 7},
                 {0, 1, 5},
                 {0, 5, 4},
                 {1, 2, 6},
                 {1, 6, 5},
                 {2, 3, 7},
                 {2, 7, 6},
                 {3, 0, 4},
                 {3, 4, 7}});
}

// Both, side by side or whatever their coordinates say.
inline Tin together(Tin a, const Tin& b) {
  const auto shift = static_cast<std::int32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Face& f : b.faces) a.faces.push_back({f[0] + shift, f[1] + shift, f[2] + shift});
  return a;
}

inline std::string all_notes(const Tin& tin) {
  std::string text;
  for (const std::string& note : tin.notes) text += note + "\n";
  return text;
}

}  // namespace sightbound::testing
