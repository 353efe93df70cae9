// SPDX-License-Identifier: GPL-3.0-or-later
// Who is seen in how many realisations: counted for the cells that are not the same in all of them, each
// until it is settled.
#pragma once

#include <cstdint>
#include <vector>

#include "base/memory_budget.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "jobs/early_stop.h"
#include "sight/probable_view.h"

namespace sightbound {

class CellsInDoubt {
 public:
  // On the terrain's grid; `layers`: heights of targets.
  CellsInDoubt(int rows, int cols, int layers);

  // A cell counts as seen when one of the views sees it. O(cells) memory, and some 36 bytes for each height
  // of a cell in doubt, which must be left of the budget: `taken` is needed besides.
  void count(std::vector<ProbableView>&, const EarlyStop&, const MemoryBudget&, std::size_t taken,
             const Workers&, Progress&, double share);
  // Seen in all realisations.
  void add_seen(int row, int col) { cells_.seen.at(row, col) = all_; }

  // What is the same in all realisations is known of all that could be drawn.
  struct Answer {
    double share;
    int realisations;
    bool proven;
  };
  Answer answer(int row, int col, int layer, int most) const;

 private:
  struct Tally {
    std::uint16_t seen, realisations, settled;
  };
  void list(const MemoryBudget&, std::size_t taken);
  void draw(std::vector<ProbableView>&, const Draws&, int lanes, const Workers&, Progress&, double share);
  void settle(const EarlyStop&, const Look&, bool last, const Workers&);

  const int layers_;
  const Layers all_;
  CellLayers cells_;
  std::vector<Tally> tallies_;  // of the cells that were in doubt, layer by layer
  std::vector<std::uint16_t> bits_;
};

}  // namespace sightbound
