// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/plan_cells.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/number_text.h"

namespace sightbound {

namespace {

constexpr int kHalvings = 12;         // of the spacing, until a polygon has a place
constexpr double kMostSquares = 1e8;  // looked at within a polygon's box

// Even-odd rule.
bool inside(const Rings& rings, double x, double y) {
  bool in = false;
  for (const std::vector<Xyz>& ring : rings) {
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      const Xyz &a = ring[i], &b = ring[j];
      if ((a.y > y) != (b.y > y) && x < (b.x - a.x) * (y - a.y) / (b.y - a.y) + a.x) in = !in;
    }
  }
  return in;
}

PlanCell square(double i, double j, double side) {
  return {{(i + 0.5) * side, (j + 0.5) * side},
          {{i * side, j * side, 0}, {(i + 1) * side, (j + 1) * side, 0}}};
}
void take_in(Box3& box, const Box3& other) {
  box.low = {std::min(box.low.x, other.low.x), std::min(box.low.y, other.low.y), 0};
  box.high = {std::max(box.high.x, other.high.x), std::max(box.high.y, other.high.y), 0};
}

// The squares of a fixed lattice whose middles lie in the polygons; nothing when there are too many to look
// at.
std::optional<std::vector<PlanCell>> squares_within(const Rings& rings, double side) {
  const Box3 box = box_of(rings);
  const double first_i = std::floor(box.low.x / side), last_i = std::floor(box.high.x / side);
  const double first_j = std::floor(box.low.y / side), last_j = std::floor(box.high.y / side);
  if ((last_i - first_i + 1) * (last_j - first_j + 1) > kMostSquares) return std::nullopt;
  std::vector<PlanCell> found;
  for (double j = first_j; j <= last_j; ++j) {
    for (double i = first_i; i <= last_i; ++i) {
      const PlanCell cell = square(i, j, side);
      if (inside(rings, cell.place.x, cell.place.y)) found.push_back(cell);
    }
  }
  return found;
}

// Numbers of the squares that [from, to] enters; not those it only touches.
struct Squares {
  double first, last;
  Squares(double from, double to, double side)
      : first(std::floor(from / side + kTouch)), last(std::ceil(to / side - kTouch) - 1) {}
  static constexpr double kTouch = 1e-9;
};

// Squares that an edge enters and whose middle is outside hold the rest of the polygon: the nearest cell
// takes each of them in.
void take_in_rims(const Rings& rings, double side, std::vector<PlanCell>& cells) {
  std::set<std::pair<double, double>> rims;
  for (const std::vector<Xyz>& ring : rings) {
    for (std::size_t n = 0, m = ring.size() - 1; n < ring.size(); m = n++) {
      Xyz a = ring[m], b = ring[n];
      if (a.x > b.x) std::swap(a, b);
      const auto y_at = [&](double x) {
        return a.y + (std::clamp(x, a.x, b.x) - a.x) * (b.y - a.y) / (b.x - a.x);
      };
      const Squares columns(a.x, b.x, side);
      for (double i = columns.first; i <= columns.last; ++i) {
        const double y0 = a.x == b.x ? a.y : y_at(i * side), y1 = a.x == b.x ? b.y : y_at((i + 1) * side);
        const Squares rows(std::min(y0, y1), std::max(y0, y1), side);
        for (double j = rows.first; j <= rows.last; ++j) rims.emplace(i, j);
      }
    }
  }
  for (const auto& [i, j] : rims) {
    const PlanCell rim = square(i, j, side);
    if (inside(rings, rim.place.x, rim.place.y)) continue;
    const auto distance = [&](const PlanCell& cell) {
      return std::hypot(cell.place.x - rim.place.x, cell.place.y - rim.place.y);
    };
    take_in(std::ranges::min_element(cells, {}, distance)->box, rim.box);
  }
}

}  // namespace

Box3 box_of(const Rings& rings) {
  Box3 box{rings[0][0], rings[0][0]};
  for (const std::vector<Xyz>& ring : rings) {
    for (const Xyz& corner : ring) {
      box.low = {std::min(box.low.x, corner.x), std::min(box.low.y, corner.y), 0};
      box.high = {std::max(box.high.x, corner.x), std::max(box.high.y, corner.y), 0};
    }
  }
  return box;
}

std::vector<PlanCell> plan_cells(const Rings& rings, double spacing_m, const std::string& name) {
  for (int n = 0; n < kHalvings; ++n) {
    const double side = spacing_m / (1 << n);
    std::optional<std::vector<PlanCell>> found = squares_within(rings, side);
    if (!found && n == 0) {
      throw InvalidInput(name + " is too large for view places " + number_text(spacing_m) +
                         " m apart; give a larger view_spacing.");
    }
    if (!found) break;
    if (found->empty()) continue;
    take_in_rims(rings, side, *found);
    return *found;
  }
  throw InvalidInput(name + " is a polygon without area; give a place or a wider polygon.");
}

}  // namespace sightbound
