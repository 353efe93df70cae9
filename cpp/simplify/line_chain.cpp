// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/line_chain.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/number_text.h"

namespace sightbound {

namespace {

struct Sample {
  int row, col;
};

// The part of a to b on the raster's cells (Liang and Barsky 1984).
std::optional<std::pair<Xy, Xy>> clipped(const Xy& a, const Xy& b, int rows, int cols) {
  double begin = 0, end = 1;
  const auto clip = [&](double from, double step, double last) {
    for (const auto& [out, in] : {std::pair{-step, from + 0.5}, std::pair{step, last + 0.5 - from}}) {
      if (out == 0 && in < 0) end = -1;
      if (out < 0) begin = std::max(begin, in / out);
      if (out > 0) end = std::min(end, in / out);
    }
  };
  clip(a.x, b.x - a.x, cols - 1);
  clip(a.y, b.y - a.y, rows - 1);
  if (begin > end) return {};
  const auto at = [&](double t) { return Xy{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}; };
  return std::pair{at(begin), at(end)};
}

class Chain {
 public:
  Chain(int rows, int cols, std::vector<LineEdge>& edges) : rows_(rows), cols_(cols), edges_(edges) {}

  // One sample for each column (row, where that runs faster), each a neighbour of the one before.
  void follow(const Xy& a, const Xy& b) {
    const double dx = b.x - a.x, dy = b.y - a.y;
    const bool by_columns = std::abs(dx) >= std::abs(dy);
    Sample here = nearest(a);
    const Sample end = nearest(b);
    while (here.row != end.row || here.col != end.col) {
      Sample next = here;
      int& major = by_columns ? next.col : next.row;
      int& minor = by_columns ? next.row : next.col;
      const int last = by_columns ? end.col : end.row;
      if (major == last) {  // only the ends round otherwise than the line
        minor += towards(minor, by_columns ? end.row : end.col);
      } else {
        major += towards(major, last);
        const double t = std::clamp(by_columns ? (major - a.x) / dx : (major - a.y) / dy, 0.0, 1.0);
        const Sample on_line = nearest({a.x + t * dx, a.y + t * dy});
        minor += towards(minor, by_columns ? on_line.row : on_line.col);
      }
      step(here, next, a, b);
      here = next;
    }
  }

 private:
  Sample nearest(const Xy& p) const {
    return {std::clamp(static_cast<int>(std::lround(p.y)), 0, rows_ - 1),
            std::clamp(static_cast<int>(std::lround(p.x)), 0, cols_ - 1)};
  }
  static int towards(int from, int to) { return (to > from) - (to < from); }
  // Neighbours.
  void step(const Sample& p, const Sample& q, const Xy& a, const Xy& b) {
    const int down = q.row - p.row, right = q.col - p.col;
    if (down * right < 0) {
      const Sample one{p.row, q.col}, other{q.row, p.col};
      const auto off = [&](const Sample& s) {
        return std::abs((b.x - a.x) * (s.row - a.y) - (b.y - a.y) * (s.col - a.x));
      };
      const Sample& between = off(one) <= off(other) ? one : other;
      add(p, between);
      add(between, q);
    } else {
      add(p, q);
    }
  }
  void add(const Sample& p, const Sample& q) {
    const LineBits direction = p.row == q.row ? kLineEast : p.col == q.col ? kLineSouth : kLineSouthEast;
    edges_.push_back({std::min(p.row, q.row), std::min(p.col, q.col), direction});
  }

  int rows_, cols_;
  std::vector<LineEdge>& edges_;
};

}  // namespace

std::vector<LineEdge> line_chains(std::span<const std::vector<Xy>> lines, int rows, int cols) {
  std::vector<LineEdge> edges;
  Chain chain(rows, cols, edges);
  for (std::size_t n = 0; n < lines.size(); ++n) {
    for (const Xy& p : lines[n]) {
      if (std::isfinite(p.x) && std::isfinite(p.y)) continue;
      throw InvalidInput("break_lines: line " + std::to_string(n + 1) +
                         " has coordinates that are not finite.");
    }
    for (std::size_t i = 1; i < lines[n].size(); ++i) {
      const auto part = clipped(lines[n][i - 1], lines[n][i], rows, cols);
      if (part) chain.follow(part->first, part->second);
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

Grid<std::uint8_t> line_bits(std::span<const LineEdge> edges, const Window& window) {
  Grid<std::uint8_t> bits;
  const auto first = std::lower_bound(edges.begin(), edges.end(), LineEdge{window.row, window.col});
  for (auto edge = first; edge != edges.end() && edge->row < window.row_end(); ++edge) {
    const int down = edge->direction == kLineEast ? 0 : 1, right = edge->direction == kLineSouth ? 0 : 1;
    if (edge->row + down >= window.row_end() || edge->col < window.col ||
        edge->col + right >= window.col_end())
      continue;
    if (bits.empty()) bits = Grid<std::uint8_t>(window.rows, window.cols, 0);
    std::uint8_t& here = bits.at(edge->row - window.row, edge->col - window.col);
    here = static_cast<std::uint8_t>(here | edge->direction);
  }
  return bits;
}

}  // namespace sightbound
