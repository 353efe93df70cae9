// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/check_input.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/number_text.h"

namespace sightbound {

void check_tin(const Tin& tin, const std::string& name) {
  check_sizes(tin, name);
  for (std::size_t n = 0; n < tin.vertices.size(); ++n) {
    const Xyz& p = tin.vertices[n];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      throw InvalidInput(name + ": vertex " + std::to_string(n) + " is not finite.");
  }
  for (std::size_t n = 0; n < tin.faces.size(); ++n) {
    for (const std::int32_t corner : tin.faces[n]) {
      if (corner < 0 || static_cast<std::size_t>(corner) >= tin.vertices.size()) {
        throw InvalidInput(name + ": face " + std::to_string(n) + " has a corner " + std::to_string(corner) +
                           "; there are " + std::to_string(tin.vertices.size()) + " vertices.");
      }
    }
  }
}

void check_tolerance(const Tolerance& tolerance, const std::vector<bool>& used) {
  if (std::ranges::none_of(used, [](bool u) { return u; })) throw InvalidInput("original has no face.");
  if (tolerance.of_vertices.empty()) {
    if (tolerance.metres > 0 && tolerance.metres <= 1e6) return;  // false for a NaN
    throw InvalidInput("tolerance is " + number_text(tolerance.metres, 6) +
                       "; allowed is more than 0, to 1000000 m.");
  }
  if (tolerance.of_vertices.size() != used.size()) {
    throw InvalidInput("tolerance has " + std::to_string(tolerance.of_vertices.size()) +
                       " values; original has " + std::to_string(used.size()) +
                       " vertices. Give one number, or one for each vertex.");
  }
  for (std::size_t n = 0; n < used.size(); ++n) {
    const auto metres = static_cast<double>(tolerance.of_vertices[n]);
    if (used[n] && !(metres > 0 && metres <= 1e6)) {
      throw InvalidInput("tolerance of vertex " + std::to_string(n) + " is " + number_text(metres, 6) +
                         "; allowed is more than 0, to 1000000 m.");
    }
  }
}

}  // namespace sightbound
