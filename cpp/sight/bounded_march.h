// SPDX-License-Identifier: GPL-3.0-or-later
// What is the same in all realisations, found before any is drawn.
//
// No draw is farther from 0 than some number of standard deviations. So every place of the ground has a
// lowest and a highest height, and every ray a lowest and a highest horizon on its way outward: most targets
// are hidden, or seen, in all realisations, and most of the ground can neither hide nor show any of the
// others. It need not be drawn: the same is seen without it. Cost: some 15 ns for each line that a ray
// crosses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "sight/fine_ground.h"
#include "sight/ray_fan.h"
#include "sight/realised_columns.h"

namespace sightbound {

// Bit l: the target of height l. There are at most 16 of them.
using Layers = std::uint16_t;
inline constexpr int kMostLayers = 16;

// How finely ground is drawn near the ends of the lines of sight.
struct Refinement {
  Fineness nearest = Fineness::kNone, near = Fineness::kNone, at_target = Fineness::kNone;
  bool crossings = false;                                  // rays depart from the line between two nodes
  static constexpr int kNearestLines = 2, kNearLines = 8;  // from the eye

  static Refinement none() { return {}; }
  static Refinement end_zones() {
    return {Fineness::kQuarters, Fineness::kHalves, Fineness::kQuarters, true};
  }
  Fineness from_eye(int line) const {
    return line < kNearestLines ? nearest : (line < kNearLines ? near : Fineness::kNone);
  }
};

class BoundedMarch {
 public:
  struct Target {
    int line, ray, minor;         // samples
    int row, col;                 // on the terrain's grid
    Layers open, seen;            // neither in all realisations; in all realisations
    bool behind_unknown = false;  // nodata lies before it: never seen for sure
  };

  // `wanted`: the layers that matter of a cell; `eye`: heights of the eye itself; `heights`: of the targets
  // above the ground.
  BoundedMarch(const RayFan&, const RealisedColumns&, const FineGround&, const Refinement&,
               const HeightRange& eye, const std::vector<float>& heights);

  // Along each ray only to `last_lines` (empty: to the end).
  using Wanted = std::function<Layers(int row, int col)>;
  void run(const Wanted&, const ProbableEye&, const std::vector<int>& last_lines);

  // Those that are not hidden in all realisations, line by line.
  const std::vector<Target>& targets() const { return targets_; }
  // Whether what a ray crosses there may decide about one that is open.
  bool may_decide(int line, int ray) const { return marks_[mark_at(line, ray)] != 0; }
  bool any_may_decide(int line) const { return marked_[static_cast<std::size_t>(line)] != 0; }
  // Line of each ray's last open target, or -1.
  std::vector<int> last_lines() const;
  int widest() const { return widest_; }  // nodes of a line that were looked at

 private:
  struct Horizon {
    float low, high;
    RayPlace place;  // last crossing
    HeightRange ground;
    int line = -1;  // of the last crossing
    bool behind_unknown = false;
  };
  // A crossing that may be higher than all before.
  struct Peak {
    int line;
    float high;
  };
  std::size_t mark_at(int line, int ray) const {
    return static_cast<std::size_t>(line) * static_cast<std::size_t>(fan_.rays()) +
           static_cast<std::size_t>(ray);
  }
  bool look_at(int line, const std::vector<int>& last_lines);
  void ask_targets(int line, const Wanted&, const ProbableEye&, const std::vector<int>& last_lines);
  void judge(const Target&, const HeightRange& ground, const ProbableEye&);
  HeightRange ground_at(const RayPlace&, const NodeStep&, double part, const HeightRange& a,
                        const HeightRange& b) const;
  void cross(int ray, int line);
  void keep_what_may_hide(int ray, float lowest_target);
  void mark(int line, int ray);

  const RayFan& fan_;
  const RealisedColumns& columns_;
  const FineGround& fine_;
  const Refinement refinement_;
  const HeightRange eye_;
  const std::vector<float>& heights_;

  std::vector<Horizon> horizons_;         // of the rays
  std::vector<std::vector<Peak>> peaks_;  // of the rays: not yet known to matter or not
  std::vector<double> minors_;            // where the rays cross the line at hand
  struct NodeRanges {
    std::vector<HeightRange> ranges;
    int first = 0;
    const HeightRange& at(int node) const { return ranges[static_cast<std::size_t>(node - first)]; }
  };
  NodeRanges nodes_, nodes_before_;  // of the line at hand and the one before
  int widest_ = 0;

  std::vector<Target> targets_;
  std::vector<std::uint8_t> marks_;  // line by line, ray by ray
  std::vector<int> marked_;          // of each line
};

}  // namespace sightbound
