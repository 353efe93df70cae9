// SPDX-License-Identifier: GPL-3.0-or-later
// Notation: h, v = major and minor coordinate in half cells from the base sample; H, J = whole ones.
#include "sight/line_over_nodes.h"

#include <algorithm>
#include <cmath>

#include "sight/stencil.h"

namespace sightbound {

namespace {

// A line that leaves the raster's rim by less than this follows the rim.
constexpr double kRim = 2 * kFrameTolerance;
// Half cells. Places are rounded to this, so that a line draws the same seen from either end.
constexpr double kSnap = 0x1p-13;

double snapped(double half_cells) { return std::round(half_cells / kSnap) * kSnap / 2; }

class Crossings {
 public:
  Crossings(const Grid<float>& mean, const Eye& eye, const Target& target, LineOverNodes& out)
      : mean_(mean),
        out_(out),
        base_major_(2 * (out.transposed ? eye.base_row : eye.base_col)),
        base_minor_(2 * (out.transposed ? eye.base_col : eye.base_row)),
        last_major_(2 * ((out.transposed ? mean.rows() : mean.cols()) - 1)),
        last_minor_(2 * ((out.transposed ? mean.cols() : mean.rows()) - 1)),
        from_(2 * (out.transposed ? eye.frame->row() : eye.frame->col())),
        to_(2 * (out.transposed ? target.row : target.col)),
        path_(eye.frame_to(target.col, target.row).path_to(target.col, target.row, out.transposed)) {}

  void find() {
    Stop here = stop(from_);
    add_end(here);
    const int sign = to_ > from_ ? 1 : -1;
    for (int h = sign > 0 ? whole(from_) + 1 : -(whole(-from_) + 1); sign * (to_ - h) > 0; h += sign) {
      const Stop next = stop(h);
      between(here, next);
      add_column(next);
      here = next;
    }
    const Stop end = stop(to_);
    between(here, end);
    add_end(end);
    number_nodes();
  }

 private:
  struct Stop {
    double h, v;
    bool outside;
  };
  double share(double h) const { return path_.share((h - from_) / (to_ - from_)); }

  Stop stop(double h) const {
    const double v = 2 * path_.minor((h - from_) / (to_ - from_));
    const double low = -base_minor_, high = last_minor_ - base_minor_;
    return {h, std::clamp(v, low, high), v < low - kRim || v > high + kRim};
  }

  NodePlace place(const Stop& at) const { return {share(at.h), snapped(at.h), snapped(at.v)}; }

  // An end: on the triangle of nodes around it.
  void add_end(const Stop& at) {
    const int h = std::min(whole(at.h), last_major_ - 1 - base_major_),
              v = std::min(whole(at.v), last_minor_ - 1 - base_minor_);
    const double fh = at.h - h, fv = at.v - v;
    NodePlace end = place(at);
    add(end, h, v, 1 - std::max(fh, fv));
    add(end, fh >= fv ? h + 1 : h, fh >= fv ? v : v + 1, std::abs(fh - fv));
    add(end, h + 1, v + 1, std::min(fh, fv));
    finish(end);
    out_.stops.push_back(static_cast<int>(out_.places.size()) - 1);
  }

  void add_column(const Stop& at) {
    NodePlace column = place(at);
    const int h = whole(at.h), v = whole(at.v);
    add(column, h, v, 1 - (at.v - v));
    add(column, h, v + 1, at.v - v);
    column.known = !at.outside;
    finish(column);
    out_.stops.push_back(static_cast<int>(out_.places.size()) - 1);
  }

  // Rows (v whole) and diagonals (v - h whole) strictly between two stops, on the chord.
  void between(const Stop& a, const Stop& b) {
    if (a.outside || b.outside) return;
    const int h0 = whole(std::min(a.h, b.h));
    std::vector<NodePlace> found;
    for (const bool diagonal : {false, true}) {
      const double g_a = diagonal ? a.v - a.h : a.v, g_b = diagonal ? b.v - b.h : b.v;
      for (int g = whole(std::min(g_a, g_b)) + 1; g < std::max(g_a, g_b); ++g) {
        const double h = a.h + (g - g_a) / (g_b - g_a) * (b.h - a.h), part = h - h0;
        if (!(part > 0 && part < 1)) continue;
        NodePlace crossing = place({h, diagonal ? g + h : g, false});
        add(crossing, h0, diagonal ? g + h0 : g, 1 - part);
        add(crossing, h0 + 1, diagonal ? g + h0 + 1 : g, part);
        found.push_back(crossing);
      }
    }
    std::sort(found.begin(), found.end(),
              [](const NodePlace& one, const NodePlace& other) { return one.share < other.share; });
    for (NodePlace& one : found) finish(one);
  }

  // Nodes beyond the rim have no terrain, and rounding gives them a weight at most.
  void add(NodePlace& at, int h, int v, double weight) const {
    const NodeId id{h + base_major_, v + base_minor_};
    const bool inside = id.major >= 0 && id.minor >= 0 && id.major <= last_major_ && id.minor <= last_minor_;
    if (weight <= 0 || !inside) return;
    const auto n = static_cast<std::size_t>(at.nodes++);
    at.node[n] = id;
    at.weight[n] = static_cast<float>(weight);
  }

  bool is_known(const NodeId& id) const {
    const auto known = [&](int major, int minor) {
      return !std::isnan(out_.transposed ? mean_.at(major, minor) : mean_.at(minor, major));
    };
    return known(id.major / 2, id.minor / 2) && known((id.major + 1) / 2, (id.minor + 1) / 2);
  }

  // Slivers of unknown ground are given up, and the weights add up to 1.
  void finish(NodePlace& at) {
    float sum = 0;
    int kept = 0;
    for (int n = 0; n < at.nodes && at.known; ++n) {
      const auto i = static_cast<std::size_t>(n), to = static_cast<std::size_t>(kept);
      if (!is_known(at.node[i])) {
        at.known = at.weight[i] <= static_cast<float>(kSliver);
        continue;
      }
      at.node[to] = at.node[i];
      at.weight[to] = at.weight[i];
      sum += at.weight[to];
      ++kept;
    }
    at.known = at.known && kept > 0;
    at.nodes = at.known ? kept : 0;
    for (int n = 0; n < at.nodes; ++n) at.weight[static_cast<std::size_t>(n)] /= sum;
    out_.places.push_back(at);
  }

  void number_nodes() {
    const int first = std::min(whole(from_), whole(to_)) + base_major_;
    const int last = std::min(std::max(whole(from_), whole(to_)) + 1 + base_major_, last_major_);
    std::vector<NodeLine>& lines = out_.lines;
    for (int major = first; major <= last; ++major) lines.push_back({major, last_minor_ + 1, -1, 0});
    const auto line_of = [&](const NodeId& id) -> NodeLine& {
      return lines[static_cast<std::size_t>(id.major - first)];
    };
    for (const NodePlace& at : out_.places) {
      for (int n = 0; n < at.nodes; ++n) {
        const NodeId& id = at.node[static_cast<std::size_t>(n)];
        NodeLine& line = line_of(id);
        line.from = std::min(line.from, id.minor);
        line.to = std::max(line.to, id.minor);
      }
    }
    for (NodeLine& line : lines) {
      line.first = out_.nodes;
      out_.nodes += std::max(line.to - line.from + 1, 0);
    }
    for (NodePlace& at : out_.places) {
      for (std::size_t n = 0; n < static_cast<std::size_t>(at.nodes); ++n) {
        const NodeLine& line = line_of(at.node[n]);
        at.index[n] = line.first + at.node[n].minor - line.from;
      }
    }
  }

  const Grid<float>& mean_;
  LineOverNodes& out_;
  const int base_major_, base_minor_, last_major_, last_minor_;  // half cells
  const double from_, to_;
  const GeodesicPath path_;
};

}  // namespace

bool is_transposed(const Eye& eye, const Target& target) {
  return std::abs(target.row - eye.frame->row()) > std::abs(target.col - eye.frame->col());
}

LineOverNodes::LineOverNodes(const Grid<float>& mean, const Eye& eye, const Target& target)
    : transposed(is_transposed(eye, target)) {
  const FramePlace place = eye.frame_to(target.col, target.row).at(target.col, target.row);
  distance = place.distance();
  bulge = place.bulge;
  if (target.row != eye.frame->row() || target.col != eye.frame->col())
    Crossings(mean, eye, target, *this).find();
}

}  // namespace sightbound
