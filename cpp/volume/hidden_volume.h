// SPDX-License-Identifier: GPL-3.0-or-later
// The answer of a volume viewshed (paper section 5.2): for every target of a lattice what is claimed and with
// what confidence it is visible.
//
//   verdict  kHidden: surely hidden, the core (every line goes through and below the terrain);
//            kUncertain: not surely visible;
//            kVisible: a claim at the confidence of the viewshed (error_model/verdict.h).
//            The hidden volume is all that is not visible.
//   p        proven pointwise confidence of visibility in [0, 1], kept as a half float, rounded towards 1/2:
//            it never says more than what was proven.
// Targets within a column's range may have no verdict (inside a solid): they count as not asked.
// Held by an OpenVDB tree whose uniform parts are tiles: airspace that is wholly seen costs next to nothing.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "error_model/verdict.h"
#include "volume/target_lattice.h"

namespace sightbound {

struct TargetAnswer {
  float p = 0.5f;
  std::uint8_t verdict = kNoVerdict;

  friend bool operator==(const TargetAnswer&, const TargetAnswer&) = default;
};

// Seen from either, from both. One without a verdict does not count.
inline TargetAnswer better_of(const TargetAnswer& a, const TargetAnswer& b) {
  if (a.verdict == kNoVerdict) return b;
  if (b.verdict == kNoVerdict) return a;
  return {std::max(a.p, b.p), std::max(a.verdict, b.verdict)};
}
inline TargetAnswer worse_of(const TargetAnswer& a, const TargetAnswer& b) {
  if (a.verdict == kNoVerdict) return b;
  if (b.verdict == kNoVerdict) return a;
  return {std::min(a.p, b.p), std::min(a.verdict, b.verdict)};
}

// What the file tells of how it was made.
struct HiddenVolumeInfo {
  double confidence = 0.95;             // of the claims
  std::vector<std::string> observers;   // JSON text each: points, boxes, polygons with their heights
  std::string error_model;              // JSON text
  std::string made_by;                  // version of Sightbound; save() fills it in when empty
  std::vector<std::string> operations;  // set operations that led here, oldest first
};

// Targets by verdict, m3.
struct VerdictVolumes {
  double hidden_m3 = 0, uncertain_m3 = 0, visible_m3 = 0;
};

class HiddenVolume {
 public:
  struct Trees;  // volume/vdb_hidden.h

  // Written by save(). Throws IoError for what cannot be read or is damaged, InvalidInput for a .vdb that is
  // no hidden volume.
  static HiddenVolume open(const std::string& path, Progress&);
  // Grids "p" (half floats) and "verdict" of the targets, "ground", "first" and "last" of the columns (k =
  // 0); readable by any OpenVDB tool; open() gives the same volume, bit by bit. Same bytes for the same
  // volume. The file appears under its name when whole. Throws IoError, Cancelled.
  void save(const std::string& path, Progress&) const;

  HiddenVolume(HiddenVolume&&) noexcept;
  HiddenVolume& operator=(HiddenVolume&&) noexcept;
  ~HiddenVolume();

  const TargetLattice& lattice() const { return *lattice_; }
  std::shared_ptr<const TargetLattice> shared_lattice() const { return lattice_; }
  const HiddenVolumeInfo& info() const { return info_; }
  HiddenVolumeInfo& info() { return info_; }
  std::size_t bytes() const;  // in memory

  // Any thread.
  TargetAnswer at(int i, int j, int k) const;
  // Of a column's layers from first to last; answers.size() == lattice().column(i, j).size().
  void column(int i, int j, std::span<TargetAnswer> answers) const;

  VerdictVolumes volumes() const;

  // Same lattice, verdicts and p; info is not compared.
  friend bool operator==(const HiddenVolume&, const HiddenVolume&);

 private:
  friend class HiddenVolumeBuilder;
  HiddenVolume(std::shared_ptr<const TargetLattice>, std::shared_ptr<const Trees>, HiddenVolumeInfo);

  std::shared_ptr<const TargetLattice> lattice_;
  std::shared_ptr<const Trees> trees_;
  HiddenVolumeInfo info_;
};

// Takes answers column by column, in any order and from any threads (each column from one of them), 4 bytes a
// target. Columns never set have no verdict.
class HiddenVolumeBuilder {
 public:
  explicit HiddenVolumeBuilder(std::shared_ptr<const TargetLattice> lattice);

  const TargetLattice& lattice() const { return *lattice_; }
  // From the column's first layer to its last. answers.size() == lattice().column(i, j).size(); p in [0, 1].
  void set_column(int i, int j, std::span<const TargetAnswer> answers);
  // Same volume whatever the order and the number of threads. Leaves the builder empty.
  HiddenVolume finish(HiddenVolumeInfo info, const Workers&);

  // Bytes that building takes at its peak, the finished volume included, about.
  static std::size_t bytes_needed(const TargetLattice&);

 private:
  std::shared_ptr<const TargetLattice> lattice_;
  std::vector<std::size_t> begins_;  // of columns in packed_
  std::vector<std::int32_t> packed_;
};

// Set operations, target by target; both on the same lattice (InvalidInput). Where only one has a verdict it
// counts alone in the union; elsewhere there is no verdict. Observers and operations are put together.
//   union_of_seen         seen from a or from b: the better verdict, the larger p. What is left hidden is a's
//                         hidden volume with b's view subtracted.
//   intersection_of_seen  seen from a and from b: the worse verdict, the smaller p.
//   difference_of_seen    what b sees and a does not claim to see: where a is visible kHidden and p = 0, else
//   b.
HiddenVolume union_of_seen(const HiddenVolume& a, const HiddenVolume& b);
HiddenVolume intersection_of_seen(const HiddenVolume& a, const HiddenVolume& b);
HiddenVolume difference_of_seen(const HiddenVolume& a, const HiddenVolume& b);

}  // namespace sightbound
