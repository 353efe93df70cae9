// SPDX-License-Identifier: GPL-3.0-or-later
// The first pass, block by block: the regular TIN is never there in whole, and what is left of a block is a
// small part of it.
#pragma once

#include <cstddef>
#include <span>

#include "base/memory_budget.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "simplify/decimation.h"
#include "simplify/line_chain.h"
#include "simplify/originals.h"
#include "simplify/vertex_kinds.h"

namespace sightbound {

struct BlockPlan {
  int block = 256;  // squares of samples a side; a function of nothing else, as the result is
  KindRules kinds;
  std::span<const LineEdge> break_lines;
  double least_part = 0;  // of its faces that a block keeps
  PassPlan pass;          // of each block
};

struct BlocksDecimated {
  Decimation left;
  std::size_t faces_before = 0, break_line_edges_lost = 0;
};

// Throws OverBudget as soon as what is left does not fit. Advances `progress` by the pass's share.
BlocksDecimated decimate_blocks(Originals& originals, const BlockPlan& plan, const MemoryBudget& budget,
                                const Workers& workers, Progress& progress);

inline constexpr int kLargestTile = 4;  // blocks a side, in the passes to come

// Bytes at most, those of the passes to come included, what is left of the blocks excepted.
std::size_t bytes_of_blocks(const Originals& originals, int block, int threads);

// Triangles of the regular TIN.
std::size_t count_faces(Originals& originals, int block, Progress& progress);

}  // namespace sightbound
