// SPDX-License-Identifier: GPL-3.0-or-later
// The hierarchical walk of a line through the trees of a volume. Private to cpp/volume.
//
// Notation: everything in voxels from the frame's origin; a column of side S is a square of S x S voxels in
// plan, a box of side S one of the cubes it is cut into; t = share of the line.
//
// The line crosses the columns of a level one after the other. Within a column its heights fill an interval,
// and it meets exactly the boxes whose layers this interval meets: it is continuous, and stays within the
// column. So the walk asks for tiles at the coarsest level first, and goes down only where a box has
// children.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "volume/vdb.h"
#include "volume/vdb_block_columns.h"
#include "volume/volume_ray.h"

namespace sightbound {

inline constexpr int kLeaf = 8, kQuarter = 32, kNode = 128, kTop = 4096;  // voxels

inline constexpr double kNeverCrossed = std::numeric_limits<double>::infinity();

// The part of a line within one column, and the heights it takes there.
struct Piece {
  double from = 0, to = 0;  // t
  double low = 0, high = 0;
  bool falls = false;
};

// The line in voxels.
struct Path {
  double x, dx, y, dy, z, dz, drop;
  double turn;            // t where the height is least
  double per_dx, per_dy;  // 1 / dx, 1 / dy

  Path(const VolumeLine& line, double side, double height)
      : x(line.from.x / side),
        dx((line.to.x - line.from.x) / side),
        y(line.from.y / side),
        dy((line.to.y - line.from.y) / side),
        z(line.from.z / height),
        dz((line.to.z - line.from.z) / height),
        drop(line.drop / height),
        turn(drop > 0 ? 0.5 - dz / (2 * drop)
             : dz > 0 ? -kNeverCrossed
                      : kNeverCrossed),
        per_dx(1 / dx),
        per_dy(1 / dy) {}

  double height(double t) const { return z + t * dz - drop * t * (1 - t); }
  Piece piece(double from, double to) const { return piece(from, height(from), to, height(to)); }
  Piece piece(double from, double a, double to, double b) const {  // heights a, b
    Piece piece{from, to, std::min(a, b), std::max(a, b), a > b};
    if (from < turn && turn < to) piece.low = std::min(piece.low, height(turn));
    return piece;
  }
};

// The floor; std::floor is a call on the plainest processors.
inline int whole_below(double value) {
  const int i = static_cast<int>(value);
  return i - (static_cast<double>(i) > value);
}
inline int layer(double z) { return whole_below(z); }
// Sides are powers of two: layers of boxes are those of voxels, shifted.
inline int layer(double z, int side) { return whole_below(z / side); }

// The columns of one side along a path, one after the other. Which border comes next is anyone's guess, so
// the step is free of branches.
template <int kSide>
class Columns {
 public:
  Columns(const Path& path, double t)
      : x_(path.x, path.dx, path.per_dx, t), y_(path.y, path.dy, path.per_dy, t) {}

  int i() const { return x_.index; }
  int j() const { return y_.index; }
  double end() const { return std::min(x_.next, y_.next); }  // t where the column is left
  void step() {
    const int over_x = x_.next <= y_.next;
    x_.advance(over_x);
    y_.advance(1 - over_x);
  }

 private:
  struct Axis {
    double at, per_slope;
    int index, stride, ahead;
    double next;  // t of the border ahead

    Axis(double start, double slope, double per, double t)
        : at(start), per_slope(per), stride(slope > 0 ? 1 : -1), ahead(slope > 0 ? 1 : 0) {
      const double place = (at + t * slope) / kSide;
      index = whole_below(place);
      // A place on the border belongs to the column that the path enters.
      if (place == index && slope < 0) --index;
      if (slope == 0) at = -std::numeric_limits<double>::max(), per_slope = kNeverCrossed;
      advance(0);
    }
    void advance(int columns) {
      index += columns * stride;
      next = (static_cast<double>(index + ahead) * kSide - at) * per_slope;
    }
  };
  Axis x_, y_;
};

// What is walked.
struct WalkedTrees {
  const RatioTree& ratios;
  const BitTree& ambiguous;
  const PlanMask* unknown;  // null = the terrain has no columns to speak of
  double side, height;      // of a voxel, metres
  const BlockColumns& columns;
};

// One walk; `Passed` hears of every voxel or tile passed, in the order of the line:
//   bool voxel(std::int32_t packed, bool ambiguous, double t)   false ends the walk
//   bool unknown(double t)                                      the column has no terrain to speak of
//   bool may_matter(std::int32_t packed) const                  could bounds not below these change anything?
class RayWalk {
 public:
  RayWalk(const WalkedTrees& trees, const VolumeLine& line)
      : unknown_(trees.unknown),
        columns_(trees.columns),
        path_(line, trees.side, trees.height),
        has_ambiguous_(!trees.ambiguous.empty()),
        background_(trees.ratios.background()),
        ratios_(trees.ratios),
        ambiguous_(trees.ambiguous) {}

  template <class Passed>
  void run(double t0, double t1, Passed& passed) {
    Columns<kTop> top(path_, t0);
    for (double t = t0; t < t1; top.step()) {
      const double top_end = std::min(top.end(), t1);
      if (top_end <= t) continue;
      const bool crossed =
          unknown_ == nullptr && passes_tiles<RatioNode4096>(path_.piece(t, top_end), top, passed);
      if (ended_ || (!crossed && !nodes(t, top_end, passed))) return;
      t = top_end;
    }
  }

 private:
  // Columns of 128 within [t0, t1].
  template <class Passed>
  bool nodes(double t0, double t1, Passed& passed) {
    Columns<kNode> columns(path_, t0);
    for (double t = t0; t < t1; columns.step()) {
      const double end = std::min(columns.end(), t1);
      if (end <= t) continue;
      const Piece piece = path_.piece(t, end);
      const PlanState doubt =
          unknown_ != nullptr ? unknown_->of_128(columns.i(), columns.j()) : PlanState::kNone;
      if (doubt == PlanState::kAll) {
        if (!passed.unknown(t)) return false;
      }
      bool crossed = false;
      if (doubt != PlanState::kSome) {
        if (piece.low > columns_.end_128(columns.i(), columns.j())) {
          crossed = true;
          ended_ = !passed.voxel(background_, false, t);
        } else {
          crossed = passes_tiles<RatioNode128>(piece, columns, passed);
        }
      }
      if (ended_ || (!crossed && !quarters(t, end, doubt == PlanState::kSome, passed))) return false;
      t = end;
    }
    return true;
  }

  // Columns of 32: no nodes of the tree, but most of those near the ground lie below a line that clears it.
  // What is told of the next one is fetched while this one is walked: lines wait for memory most of all.
  template <class Passed>
  bool quarters(double t0, double t1, bool some_unknown, Passed& passed) {
    Columns<kQuarter> columns(path_, t0);
    double z = path_.height(t0);
    for (double t = t0; t < t1;) {
      const double end = std::min(columns.end(), t1);
      const BlockColumns::Square& square = columns_.square(columns.i(), columns.j());
      columns.step();
      if (end <= t) continue;
      const double z_end = path_.height(end);
      columns_.prefetch(columns_.square(columns.i(), columns.j()), layer(z_end));
      const bool above = !some_unknown && path_.piece(t, z, end, z_end).low > square.end();
      if (!(above ? passed.voxel(background_, false, t) : leaves(t, end, some_unknown, square, passed)))
        return false;
      t = end, z = z_end;
    }
    return true;
  }

  template <class Passed>
  bool leaves(double t0, double t1, bool may_be_unknown, const BlockColumns::Square& square, Passed& passed) {
    Columns<kLeaf> columns(path_, t0);
    double z = path_.height(t0);
    for (double t = t0; t < t1; columns.step()) {
      const double end = std::min(columns.end(), t1);
      if (end <= t) continue;
      const double z_end = path_.height(end);
      const Piece piece = path_.piece(t, z, end, z_end);
      const PlanState doubt = may_be_unknown ? unknown_->of_8(columns.i(), columns.j()) : PlanState::kNone;
      if (doubt == PlanState::kAll && !passed.unknown(t)) return false;
      const bool some_unknown = doubt == PlanState::kSome;
      if (some_unknown || may_matter(piece, columns, square, passed)) {
        if (!voxels(piece, columns, some_unknown, square, passed)) return false;
      } else if (!passed.voxel(background_, false, t)) {
        return false;
      }
      t = end, z = z_end;
    }
    return true;
  }

  // Could anything in the layers of a piece change what has been passed?
  template <class Passed>
  bool may_matter(const Piece& piece, const Columns<kLeaf>& leaf_column, const BlockColumns::Square& square,
                  const Passed& passed) const {
    const int from = layer(piece.low);
    if (!square.is_told(from)) return true;
    const int to = std::min(layer(piece.high), square.end() - 1);
    const int slot = BlockColumns::slot(leaf_column.i(), leaf_column.j());
    const std::int32_t* least = columns_.least(square, from) + slot;
    for (int k = from; k <= to; ++k, least += BlockColumns::kColumns) {
      if (*least != background_ && passed.may_matter(*least)) return true;
    }
    return false;
  }

  // Voxel by voxel within a column of leaves.
  template <class Passed>
  bool voxels(const Piece& piece, const Columns<kLeaf>& leaf_column, bool some_unknown,
              const BlockColumns::Square& square, Passed& passed) {
    const int i8 = leaf_column.i() * kLeaf, j8 = leaf_column.j() * kLeaf;
    const LeafColumn column{square, BlockColumns::slot(leaf_column.i(), leaf_column.j()), i8, j8};
    const int k8 = layer(piece.low, kLeaf), k8_end = layer(piece.high, kLeaf);
    bool any_leaf = some_unknown;
    for (int k = k8; k <= k8_end && !any_leaf; ++k) any_leaf = is_leaf(column, k * kLeaf);
    if (!any_leaf) {
      for (int k = k8; k <= k8_end; ++k) {
        if (!passed.voxel(value(column, {i8, j8, k * kLeaf}), false, piece.from)) return false;
      }
      return true;
    }
    Columns<1> columns(path_, piece.from);
    double z = path_.height(piece.from);
    for (double t = piece.from; t < piece.to; columns.step()) {
      const double end = std::min(columns.end(), piece.to);
      if (end <= t) continue;
      const double z_end = path_.height(end);
      const int i = columns.i() - i8, j = columns.j() - j8;
      // Rounding may see the path a hair outside: there is nothing left to walk.
      if (i < 0 || j < 0 || i >= kLeaf || j >= kLeaf) {
        t = end, z = z_end;
        continue;
      }
      if (some_unknown && unknown_->at(columns.i(), columns.j()) && !passed.unknown(t)) return false;
      const Piece part = path_.piece(t, z, end, z_end);
      const int k_low = layer(part.low), k_high = layer(part.high);
      for (int n = k_low; n <= k_high; ++n) {
        const openvdb::Coord place(columns.i(), columns.j(), part.falls ? k_low + k_high - n : n);
        const bool two_sided = has_ambiguous_ && ambiguous_.isValueOn(place);
        if (!passed.voxel(value(column, place), two_sided, t)) return false;
      }
      t = end, z = z_end;
    }
    return true;
  }

  struct LeafColumn {
    const BlockColumns::Square& square;
    int slot;    // in it
    int i8, j8;  // its first voxel
  };

  bool is_leaf(const LeafColumn& column, int k) const {
    if (column.square.is_irregular()) return ratios_.probeConstLeaf({column.i8, column.j8, k}) != nullptr;
    return column.square.tells(k) && columns_.leaf(column.square, k)[column.slot] != nullptr;
  }

  std::int32_t value(const LeafColumn& column, const openvdb::Coord& place) const {
    const int k = place.z();
    if (!column.square.tells(k)) return column.square.is_told(k) ? background_ : ratios_.getValue(place);
    const std::int32_t* leaf = columns_.leaf(column.square, k)[column.slot];
    if (leaf == nullptr) return columns_.least(column.square, k)[column.slot];
    return leaf[(place.x() - column.i8) * kLeaf * kLeaf + (place.y() - column.j8) * kLeaf +
                (k & (kLeaf - 1))];
  }

  // Passes the boxes of a piece when none of them has children; false when one does and nothing was passed.
  template <class Node, int side, class Passed>
  bool passes_tiles(const Piece& piece, const Columns<side>& column, Passed& passed) {
    const int from = layer(piece.low, side), to = layer(piece.high, side);
    for (int k = from; k <= to; ++k) {
      if (ratios_.template probeConstNode<Node>({column.i() * side, column.j() * side, k * side}) != nullptr)
        return false;
    }
    for (int k = from; k <= to; ++k) {
      if (!passed.voxel(ratios_.getValue({column.i() * side, column.j() * side, k * side}), false,
                        piece.from)) {
        ended_ = true;
        return true;
      }
    }
    return true;
  }

  const PlanMask* unknown_;
  const BlockColumns& columns_;
  Path path_;
  bool has_ambiguous_, ended_ = false;
  std::int32_t background_;
  openvdb::tree::ValueAccessor<const RatioTree, false> ratios_;
  openvdb::tree::ValueAccessor<const BitTree, false> ambiguous_;
};

}  // namespace sightbound
