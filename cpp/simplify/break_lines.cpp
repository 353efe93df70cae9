// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/break_lines.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/number_text.h"
#include "volume/box_tree.h"

namespace sightbound {

namespace {

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

struct Piece {
  Xyz from, to;

  double part_at(const Xyz& p) const {  // 0 at one end, 1 at the other
    const Xyz along = to - from;
    return std::clamp(dot(p - from, along) / dot(along, along), 0.0, 1.0);
  }
  bool passes(const Xyz& p) const { return length(from + part_at(p) * (to - from) - p) <= kNearLine; }
  // May it pass a place in the box? (Slabs.)
  bool meets(const Box3& box) const {
    double first = 0, last = 1;
    const auto cut = [&](double start, double end, double low, double high) {
      low -= kNearLine;
      high += kNearLine;
      if (start == end) return low <= start && start <= high;
      const double a = (low - start) / (end - start), b = (high - start) / (end - start);
      first = std::max(first, std::min(a, b));
      last = std::min(last, std::max(a, b));
      return first <= last;
    };
    return cut(from.x, to.x, box.low.x, box.high.x) && cut(from.y, to.y, box.low.y, box.high.y) &&
           cut(from.z, to.z, box.low.z, box.high.z);
  }
};

class EdgeFinder {
 public:
  EdgeFinder(const Tin& tin, bool in_plan) : tin_(tin), in_plan_(in_plan), mesh_(tin) {
    vertices_ = BoxTree(tin.vertices.size(), [this](std::size_t v) {
      const Xyz p = seen(tin_.vertices[v]);
      return Box3{p, p};
    });
  }

  Xyz seen(const Xyz& p) const { return in_plan_ ? Xyz{p.x, p.y, 0} : p; }

  // False when no chain of edges runs along the piece.
  bool add(const Piece& piece, std::vector<TinEdge>& edges) const {
    std::vector<std::pair<double, std::int32_t>> on;
    vertices_.visit([&](const Box3& box) { return piece.meets(box); },
                    [&](std::size_t v) {
                      const Xyz p = seen(tin_.vertices[v]);
                      if (piece.passes(p)) on.emplace_back(piece.part_at(p), static_cast<std::int32_t>(v));
                    });
    std::sort(on.begin(), on.end());
    if (on.size() < 2) return false;
    const auto is_at = [&](std::int32_t v, const Xyz& end) {
      return length(seen(tin_.vertices[at(v)]) - end) <= kNearLine;
    };
    if (!is_at(on.front().second, piece.from) || !is_at(on.back().second, piece.to)) return false;
    const std::size_t before = edges.size();
    for (std::size_t i = 1; i < on.size(); ++i) {
      const TinEdge edge{on[i - 1].second, on[i].second};
      if (!mesh_.is_edge(edge[0], edge[1])) {
        edges.resize(before);
        return false;
      }
      edges.push_back(edge);
    }
    return true;
  }

 private:
  const Tin& tin_;
  bool in_plan_;
  TinMesh mesh_;
  BoxTree vertices_;
};

std::string text_of(const Tin& tin, const Xyz& local) {
  const Xyz p = tin.to_crs(local);
  return "(" + number_text(p.x, 12) + ", " + number_text(p.y, 12) + ")";
}

}  // namespace

std::vector<TinEdge> edges_along(const Tin& tin, const std::vector<std::vector<Xyz>>& lines, bool in_plan,
                                 Progress& progress) {
  if (lines.empty()) return {};
  const EdgeFinder finder(tin, in_plan);
  std::vector<TinEdge> edges;
  std::size_t pieces = 0, missing = 0;
  std::string first;
  for (const std::vector<Xyz>& line : lines) {
    for (std::size_t i = 1; i < line.size(); ++i) {
      progress.check();
      const Piece piece{finder.seen(line[i - 1]), finder.seen(line[i])};
      if (length(piece.to - piece.from) <= kNearLine) continue;
      ++pieces;
      if (finder.add(piece, edges)) continue;
      if (missing++ == 0) first = text_of(tin, line[i - 1]) + " to " + text_of(tin, line[i]);
    }
  }
  if (missing > 0) {
    throw InvalidInput("break_lines has " + std::to_string(pieces) + " pieces, of which " +
                       std::to_string(missing) + " do not run along edges of the TIN (the first from " +
                       first + "); their vertices must be vertices of the TIN, to a millimetre.");
  }
  return edges;
}

}  // namespace sightbound
