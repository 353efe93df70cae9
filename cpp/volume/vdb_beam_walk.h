// SPDX-License-Identifier: GPL-3.0-or-later
// The walk of a beam - every line from one box to another - through the trees of a volume. Private to
// cpp/volume.
//
// Notation: everything in voxels from the frame's origin; t = share of a line. The beam runs along x or y,
// whichever its boxes lie farther apart in, and is cut across into slabs of 128, 8 or 1 voxels. What all
// lines together may pass within a slab lies in a box, the section; a line that crosses the slab passes some
// voxels of its section and no others. So voxels that are all clear let every line pass, and voxels that are
// all solid stop every line that crosses the slab.
#pragma once

#include <algorithm>
#include <cmath>

#include "volume/vdb_ray_walk.h"

namespace sightbound {

struct Span {
  double low = 0, high = 0;
};

// The part of a beam within one slab.
struct Section {
  double begin = 0, end = 0;  // t; no line is in the slab before or after
  Span across, heights;
  bool empty() const { return begin > end; }
};

class BeamPath {
 public:
  BeamPath(const VolumeBeam& beam, double side, double height)
      : from_x_(over(beam.from.low.x, beam.from.high.x, side)),
        to_x_(over(beam.to.low.x, beam.to.high.x, side)),
        from_y_(over(beam.from.low.y, beam.from.high.y, side)),
        to_y_(over(beam.to.low.y, beam.to.high.y, side)),
        from_z_(over(beam.from.low.z, beam.from.high.z, height)),
        to_z_(over(beam.to.low.z, beam.to.high.z, height)),
        drop_{beam.least_drop / height, beam.most_drop / height},
        along_x_(apart(from_x_, to_x_) >= apart(from_y_, to_y_)) {
    if (!along_x_) {
      std::swap(from_x_, from_y_);
      std::swap(to_x_, to_y_);
    }
    forwards_ = from_x_.low < to_x_.low;
  }

  // Only where the boxes lie apart can anything be said.
  bool runs() const { return apart(from_x_, to_x_) > 0; }
  bool along_x() const { return along_x_; }
  bool forwards() const { return forwards_; }

  // Where lines may be at [begin, end], along the beam.
  Span reach(double begin, double end) const {
    const Span a = between(from_x_, to_x_, begin), b = between(from_x_, to_x_, end);
    return {std::min(a.low, b.low), std::max(a.high, b.high)};
  }
  // Of the slab [index, index + 1] * side, as if the lines went on beyond their ends.
  Section slab(int index, int side) const {
    const double near = static_cast<double>(index) * side, far = near + side;
    const double at_low = (far - from_x_.low) / (to_x_.low - from_x_.low),
                 at_high = (near - from_x_.high) / (to_x_.high - from_x_.high);
    return forwards_ ? Section{at_high, at_low, {}, {}} : Section{at_low, at_high, {}, {}};
  }
  void clip(Section& section, double begin, double end) const {
    section.begin = std::max(section.begin, begin);
    section.end = std::min(section.end, end);
    if (section.empty()) return;
    const Span y0 = between(from_y_, to_y_, section.begin), y1 = between(from_y_, to_y_, section.end);
    section.across = {std::min(y0.low, y1.low) - kRounding, std::max(y0.high, y1.high) + kRounding};
    section.heights = {lowest(section.begin, section.end) - kRounding,
                       std::max(highest(section.begin), highest(section.end)) + kRounding};
  }

 private:
  static constexpr double kRounding = 1e-6;  // voxels

  static Span over(double low, double high, double size) { return {low / size, high / size}; }
  static double apart(const Span& a, const Span& b) { return std::max(a.low - b.high, b.low - a.high); }
  static Span between(const Span& a, const Span& b, double t) {
    return {a.low + t * (b.low - a.low), a.high + t * (b.high - a.high)};
  }
  // Both are convex in t.
  double highest(double t) const { return between(from_z_, to_z_, t).high - drop_.low * t * (1 - t); }
  double lowest(double t) const { return between(from_z_, to_z_, t).low - drop_.high * t * (1 - t); }
  double lowest(double begin, double end) const {
    double least = std::min(lowest(begin), lowest(end));
    if (drop_.high > 0) {
      const double turn = 0.5 - (to_z_.low - from_z_.low) / (2 * drop_.high);
      if (begin < turn && turn < end) least = std::min(least, lowest(turn));
    }
    return least;
  }

  Span from_x_, to_x_, from_y_, to_y_, from_z_, to_z_;  // x is the way along, y the way across
  Span drop_;
  bool along_x_, forwards_ = true;
};

// A voxel of a section, or a layer of a block of 8 x 8 columns.
struct BeamVoxel {
  RatioInterval ratio;
  bool known;  // the column has terrain all over
};
struct BeamBlock {
  RatioInterval least, most;  // the smallest and the largest bounds of its voxels
  bool known;
};

enum class Found { kNo, kMaybe, kYes };
// Which of the voxels above one another tell all where k grows with height.
enum class Telling { kLowest, kHighest };

class BeamWalk {
 public:
  // `monotone`: k grows with height (height fields), so that the lowest and the highest voxels of a section
  // tell all.
  BeamWalk(const WalkedTrees& trees, const VolumeBeam& beam, float beyond, bool monotone)
      : unknown_(trees.unknown),
        columns_(trees.columns),
        path_(beam, trees.side, trees.height),
        monotone_(monotone),
        beyond_(beyond),
        background_(trees.ratios.background()),
        ratios_(trees.ratios) {}

  bool runs() const { return path_.runs(); }

  // Calls judge(section, whole, index) for the slabs of 8 between the shares, in order; `whole` is the
  // section without regard to the shares. Slabs wholly above a height field are left out. False ends the
  // walk; true when it came to the end.
  template <class Judge>
  bool blocks(double begin, double end, const Judge& judge) {
    return slabs(kNode, path_.reach(begin, end), [&](int index) {
      Section section = path_.slab(index, kNode);
      path_.clip(section, begin, end);
      if (section.empty() || (monotone_ && is_above(section, index))) return true;
      const Span part = path_.reach(section.begin, section.end);
      const double near = static_cast<double>(index) * kNode;
      return slabs(kLeaf, {std::max(part.low, near), std::min(part.high, near + kNode - 1)}, [&](int at) {
        Section leaf = path_.slab(at, kLeaf);
        const Section whole = leaf;
        path_.clip(leaf, begin, end);
        return leaf.empty() || judge(leaf, whole, at);
      });
    });
  }
  // The same for the slabs of 1 within a slab of 8.
  template <class Judge>
  bool voxels(int index8, double begin, double end, const Judge& judge) {
    const double near = static_cast<double>(index8) * kLeaf;
    return slabs(1, {near, near + kLeaf - 1}, [&](int at) {
      Section section = path_.slab(at, 1);
      const Section whole = section;
      path_.clip(section, begin, end);
      return section.empty() || judge(section, whole, at);
    });
  }

  // Do all blocks of a section satisfy `yes`? No, surely, when in one of them nothing `may`.
  template <class Yes, class May>
  Found of_blocks(const Section& section, int index, Telling telling, const Yes& yes, const May& may) {
    const Span layers = telling_layers(section.heights, telling);
    const int low = layer(layers.low), high = layer(layers.high), last = layer(section.across.high, kLeaf);
    Found found = Found::kYes;
    for (int across = layer(section.across.low, kLeaf); across <= last; ++across) {
      const int i8 = path_.along_x() ? index : across, j8 = path_.along_x() ? across : index;
      const bool known = unknown_ == nullptr || unknown_->of_8(i8, j8) == PlanState::kNone;
      bool possible = false;
      for (int k = low; k <= high; ++k) {
        const BeamBlock block = of_block(i8, j8, k, known);
        if (!yes(block)) found = Found::kMaybe;
        possible = possible || may(block);
      }
      if (!possible) return Found::kNo;
    }
    return found;
  }

  // Do all voxels?
  template <class Yes>
  bool of_voxels(const Section& section, int index, Telling telling, const Yes& yes) {
    const Span layers = telling_layers(section.heights, telling);
    const int low = layer(layers.low), high = layer(layers.high), last = layer(section.across.high);
    for (int across = layer(section.across.low); across <= last; ++across) {
      const int i = path_.along_x() ? index : across, j = path_.along_x() ? across : index;
      const bool known = unknown_ == nullptr || !unknown_->at(i, j);
      for (int k = low; k <= high; ++k) {
        if (!yes(BeamVoxel{unpack(ratios_.getValue({i, j, k})), known})) return false;
      }
    }
    return true;
  }

 private:
  // Slabs in the order of the lines.
  template <class Visit>
  bool slabs(int side, const Span& reach, const Visit& visit) {
    const int first = layer(reach.low, side), last = layer(reach.high, side);
    for (int n = 0; n <= last - first; ++n) {
      if (!visit(path_.forwards() ? first + n : last - n)) return false;
    }
    return true;
  }
  bool is_above(const Section& section, int index) const {
    const int last = layer(section.across.high, kNode);
    for (int across = layer(section.across.low, kNode); across <= last; ++across) {
      const int i = path_.along_x() ? index : across, j = path_.along_x() ? across : index;
      if (unknown_ != nullptr && unknown_->of_128(i, j) != PlanState::kNone) return false;
      if (!(section.heights.low > columns_.end_128(i, j))) return false;
    }
    return true;
  }
  Span telling_layers(const Span& heights, Telling telling) const {
    if (!monotone_) return heights;
    const double z = telling == Telling::kLowest ? heights.low : heights.high;
    return {z, z};
  }
  BeamBlock of_block(int i8, int j8, int k, bool known) {
    const BlockColumns::Square& square = columns_.square(i8 >> 2, j8 >> 2);
    if (square.is_told(k)) {
      if (k >= square.end()) return of_tile(background_, known);
      const int slot = BlockColumns::slot(i8, j8);
      return {unpack(columns_.least(square, k)[slot]), unpack(columns_.largest(square, k)[slot]), known};
    }
    const openvdb::Coord place(i8 * kLeaf, j8 * kLeaf, k);
    if (ratios_.probeConstLeaf(place) != nullptr) return {{-beyond_, -beyond_}, {beyond_, beyond_}, known};
    return of_tile(ratios_.getValue(place), known);
  }
  static BeamBlock of_tile(std::int32_t packed, bool known) {
    const RatioInterval k = unpack(packed);
    return {k, k, known};
  }

  const PlanMask* unknown_;
  const BlockColumns& columns_;
  BeamPath path_;
  bool monotone_;
  float beyond_;
  std::int32_t background_;
  openvdb::tree::ValueAccessor<const RatioTree, false> ratios_;
};

}  // namespace sightbound
