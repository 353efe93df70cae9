// SPDX-License-Identifier: GPL-3.0-or-later
// A square of target columns, answered coarse to fine. Internal to volume_viewshed.cpp.
//
// A block of columns is asked against boxes of the view tree: a beam between two boxes that is proven hidden,
// or seen, beyond K settles every line in it and is not split. What is left is split, block or box, whichever
// is larger, down to single columns and single places, whose lines are judged one by one. So the answer is
// the one that all the lines would give; only beyond K nothing finer is asked.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/progress.h"
#include "sight/view_tree.h"
#include "sight/volume_viewshed.h"

namespace sightbound {

// What the tiles of a viewshed share.
struct TileQuestion {
  const VolumeSight& sight;
  const VolumeViewshedOptions& options;
  double quantile;  // z(c)
  double most;      // K: beyond, nothing more is told
  Tails tails;
  Xyz target_room;  // half sizes of the box that a target's verdict holds for
  bool monotone;    // who sees a target sees all above it (height fields)
  bool solid;       // no sheet
  const ViewTree& views;
  // Of the tree's places, in their order. `cells` is empty when all of them are points.
  std::vector<EndZone> zones;
  std::vector<EndRoom> rooms, cells;

  const EndRoom& cell(std::size_t place) const { return cells.empty() ? rooms[place] : cells[place]; }
};

class TargetTile {
 public:
  static constexpr int kSide = 16;  // columns

  // Columns from (i, j) of `targets`.
  TargetTile(const TileQuestion&, const TargetLattice& targets, int i, int j, Progress&);

  void see();
  // Of a column in the tile, from its first layer to its last.
  const std::vector<TargetAnswer>& answers(int i, int j) const { return answers_[slot(i, j)]; }
  void put_into(HiddenVolumeBuilder&) const;

 private:
  struct Block {
    int i, j, side;  // columns [i, i + side) x [j, j + side) of the lattice
  };
  using Node = ViewTree::Node;

  template <class Visit>
  void each_column(const Block&, const Visit&) const;
  std::size_t slot(int i, int j) const {
    return static_cast<std::size_t>((j - whole_.j) * kSide + (i - whole_.i));
  }
  bool is_any() const;
  // The verdict of one view that no other can change.
  std::uint8_t settling() const { return is_any() ? kVisible : kHidden; }
  TargetAnswer sure(std::uint8_t verdict) const;  // beyond K
  TargetAnswer hidden_by(double ratio) const;
  TargetAnswer join(const TargetAnswer&, const TargetAnswer&) const;
  bool is_settled(int i, int j) const;
  // The sure answer, to all layers from `bottom` to `top`.
  void give(const Block&, std::uint8_t verdict, int bottom = std::numeric_limits<int>::min(),
            int top = std::numeric_limits<int>::max());

  bool box_of(const Block&, Box3&) const;
  Box3 box_of(int i, int j, int k) const;
  // kHidden or kVisible when proven of every line, kUncertain when not, kNoVerdict when all are too far.
  std::uint8_t verdict_of_all(const Node&, const Box3& targets) const;
  bool is_too_far(const Node&, int i, int j) const;
  std::vector<int> unbeaten(const Node&, int i, int j, const std::vector<int>& layers);
  bool is_beaten(const Node&, TargetAnswer&, const Box3& target, const Xyz& centre) const;
  void split(const Node&, std::vector<const Node*>& into) const;
  void see(const Block&, const std::vector<const Node*>& views);
  void see_column(int i, int j, const std::vector<const Node*>& views);
  void see_from(std::size_t place, int i, int j, const std::vector<int>& layers, EndZone& target);
  TargetAnswer judge(std::size_t place, int i, int j, int k, EndZone& target);
  bool holds_around(std::uint8_t verdict, std::size_t place, const Box3& target) const;
  bool corners_hide(const Box3& views, const Box3& target) const;

  const TileQuestion& ask_;
  const TargetLattice& targets_;
  Progress& progress_;
  Block whole_;
  std::array<std::vector<TargetAnswer>, kSide * kSide> answers_;
  std::size_t hint_;                     // the place that last settled a column
  double closest_ = VolumeRays::kNever;  // share at which the last line was closest to the ground
};

}  // namespace sightbound
