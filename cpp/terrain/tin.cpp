// SPDX-License-Identifier: GPL-3.0-or-later
#include "terrain/tin.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace sightbound {

double length(const Xyz& a) { return std::sqrt(dot(a, a)); }

Xyz Tin::to_crs(const Xyz& local) const {
  return {origin.x + local.x / metres_per_unit, origin.y + local.y / metres_per_unit, origin.z + local.z};
}

Xyz Tin::from_crs(const Xyz& crs) const {
  return {(crs.x - origin.x) * metres_per_unit, (crs.y - origin.y) * metres_per_unit, crs.z - origin.z};
}

Xyz normal_of(const Tin& tin, const Face& face) {
  const auto at = [&](int corner) {
    return tin.vertices[static_cast<std::size_t>(face[static_cast<std::size_t>(corner)])];
  };
  const Xyz a = at(0);
  return cross(at(1) - a, at(2) - a);
}

Box3 bounds_of(const Tin& tin) {
  if (tin.vertices.empty()) throw InvalidInput("The TIN has no vertices; give at least three.");
  Box3 box{tin.vertices.front(), tin.vertices.front()};
  for (const Xyz& v : tin.vertices) {
    box.low = {std::min(box.low.x, v.x), std::min(box.low.y, v.y), std::min(box.low.z, v.z)};
    box.high = {std::max(box.high.x, v.x), std::max(box.high.y, v.y), std::max(box.high.z, v.z)};
  }
  return box;
}

double median_edge(const Tin& tin) {
  constexpr std::size_t kMostFaces = 1000000;
  if (tin.faces.empty()) throw InvalidInput("The TIN has no faces; give at least one.");
  const std::size_t step = 1 + (tin.faces.size() - 1) / kMostFaces;
  std::vector<double> lengths;
  lengths.reserve(3 * (tin.faces.size() / step + 1));
  for (std::size_t f = 0; f < tin.faces.size(); f += step) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Xyz& from = tin.vertices[static_cast<std::size_t>(tin.faces[f][i])];
      const Xyz& to = tin.vertices[static_cast<std::size_t>(tin.faces[f][(i + 1) % 3])];
      lengths.push_back(length(to - from));
    }
  }
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

void set_origin(Tin& tin, double metres_per_unit) {
  const Box3 box = bounds_of(tin);
  tin.origin = {std::round(box.low.x + (box.high.x - box.low.x) / 2),
                std::round(box.low.y + (box.high.y - box.low.y) / 2), 0};
  tin.metres_per_unit = metres_per_unit;
  for (Xyz& v : tin.vertices) v = tin.from_crs(v);
}

void check_sizes(const Tin& tin, const std::string& what) {
  constexpr std::size_t kMost = static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()) - 1;
  if (tin.vertices.empty()) throw InvalidInput(what + " has no vertices; it needs at least three.");
  if (tin.faces.empty()) throw InvalidInput(what + " has no faces; it needs at least one triangle.");
  if (tin.vertices.size() > kMost || tin.faces.size() > kMost) {
    throw InvalidInput(what + " has " + std::to_string(tin.vertices.size()) + " vertices and " +
                       std::to_string(tin.faces.size()) + " faces; at most " + std::to_string(kMost) +
                       " of each are possible. Split it into tiles.");
  }
  const auto check = [&](const std::string& name, std::size_t found, std::size_t wanted) {
    if (found == wanted) return;
    throw InvalidInput(what + ": " + name + " has " + std::to_string(found) + " values; it must have " +
                       std::to_string(wanted) + ", one each.");
  };
  if (!tin.sigma_v.empty()) check("sigma_v", tin.sigma_v.size(), tin.vertices.size());
  for (const TinAttribute& one : tin.vertex_attributes) {
    check("vertex attribute '" + one.name + "'", one.values.size(), tin.vertices.size());
  }
  for (const TinAttribute& one : tin.face_attributes) {
    check("face attribute '" + one.name + "'", one.values.size(), tin.faces.size());
  }
}

}  // namespace sightbound
