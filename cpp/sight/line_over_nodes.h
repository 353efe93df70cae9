// SPDX-License-Identifier: GPL-3.0-or-later
// Where a sight line passes over realised terrain (realised_columns.h): its crossings with the half-cell
// lines of nodes, along rows, columns and NW-SE diagonals. Between these terrain is linear, so that a line
// that is clear at all of them is clear. Without any error they hold the judged places of the line.
//
// Cost: O(cells the line crosses).
#pragma once

#include <array>
#include <vector>

#include "sight/sight_line.h"
#include "terrain/grid.h"

namespace sightbound {

// Of the lines of nodes of RealisedColumns: which one, and where on it.
struct NodeId {
  int major = 0, minor = 0;
};

// The ground at a place is the sum of weight x node.
struct NodePlace {
  double share = 0;             // of the line's distance
  double major = 0, minor = 0;  // samples from the observer's base sample
  bool known = true;            // false: unknown ground, and no node
  int nodes = 0;
  std::array<NodeId, 3> node{};
  std::array<float, 3> weight{};
  std::array<int, 3> index{};  // of the node in a list of all, in the order of `lines`
};

// The nodes needed of one line of nodes: `from` to `to`, of which the first has number `first` in the list.
struct NodeLine {
  int major = 0, from = 0, to = -1, first = 0;
};

// Are rows the lines of nodes that the line crosses one by one?
bool is_transposed(const Eye&, const Target&);

struct LineOverNodes {
  // On the grid of `mean`, NaN = unknown.
  LineOverNodes(const Grid<float>& mean, const Eye&, const Target&);

  bool transposed = false;        // lines of nodes are rows
  double distance = 0;            // metres
  double bulge = 0;               // D^2 / 2R, metres
  std::vector<NodePlace> places;  // in order; the first and the last are the ends of the line
  std::vector<int> stops;         // those on the lines of nodes, half a cell apart, and the ends
  std::vector<NodeLine> lines;
  int nodes = 0;  // in the list
};

}  // namespace sightbound
