// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/block_decimation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"

namespace sightbound {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// Squares of samples along a side, cut into blocks.
int count_blocks(int samples, int block) { return (samples - 2) / block + 1; }

Window block_at(int row, int col, const Originals& originals, int block) {
  Window window{col * block, row * block, 0, 0};
  window.cols = std::min(block, originals.cols() - 1 - window.col) + 1;
  window.rows = std::min(block, originals.rows() - 1 - window.row) + 1;
  return window;
}

// Samples that have to stay, those of the rim for now.
void set_kinds(PlanMesh& mesh, const Originals::Part& part, const Window& window, const KindRules& rules) {
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(mesh.vertices()); ++v) {
    const int r = mesh.step_y(v) / kStepsPerCell, c = mesh.step_x(v) / kStepsPerCell;
    const bool kept =
        !part.dem.keep.empty() && part.dem.keep.at(r - part.window.row, c - part.window.col) != 0;
    if (kept) {
      mesh.set_kind(v, VertexKind::kFixed);
    } else if (on_rim(window, rules.rows, rules.cols, r, c)) {
      mesh.set_kind(v, VertexKind::kRim);
    } else if (mesh.kind(v) == VertexKind::kInside) {
      mesh.set_kind(v, kind_of(mesh, v, rules));
    }
  }
}

// Edges of lines without terrain on either side; those on a rim count in one block only.
std::size_t count_lost(const Grid<std::uint8_t>& lines, const Originals::Part& part, const Window& window,
                       const KindRules& rules) {
  if (lines.empty()) return 0;
  const auto there = [&](int r, int c) {
    const int row = window.row + r - part.window.row, col = window.col + c - part.window.col;
    // What another part of the DEM holds is taken to be there.
    if (row < 0 || row >= part.window.rows) return window.row + r >= 0 && window.row + r < rules.rows;
    return col >= 0 && col < part.window.cols && !std::isnan(part.dem.heights.at(row, col));
  };
  // Each edge, and the third corners of the triangles on its sides.
  struct Sides {
    LineBits bit;
    int down, right;
    std::array<std::array<int, 2>, 2> third;  // rows and columns further
  };
  constexpr std::array<Sides, 3> kEdges{{{kLineEast, 0, 1, {{{1, 1}, {-1, 0}}}},
                                         {kLineSouth, 1, 0, {{{1, 1}, {0, -1}}}},
                                         {kLineSouthEast, 1, 1, {{{0, 1}, {1, 0}}}}}};
  const int rows = window.row_end() == rules.rows ? window.rows : window.rows - 1;
  const int cols = window.col_end() == rules.cols ? window.cols : window.cols - 1;
  std::size_t lost = 0;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) {
      for (const Sides& edge : kEdges) {
        if ((lines.at(r, c) & edge.bit) == 0) continue;
        const bool side = there(r + edge.third[0][0], c + edge.third[0][1]) ||
                          there(r + edge.third[1][0], c + edge.third[1][1]);
        if (!there(r, c) || !there(r + edge.down, c + edge.right) || !side) ++lost;
      }
    }
  }
  return lost;
}

std::size_t most_to_go(std::size_t faces, double least_part) {
  if (least_part <= 0) return kAllCollapses;
  const double stay = std::ceil(least_part * static_cast<double>(faces));
  return (faces - std::min(faces, static_cast<std::size_t>(stay))) / 2;
}

}  // namespace

BlocksDecimated decimate_blocks(Originals& originals, const BlockPlan& plan, const MemoryBudget& budget,
                                const Workers& workers, Progress& progress) {
  BlocksDecimated result;
  Decimation& whole = result.left;
  BlockJoiner joiner(whole.mesh(), plan.kinds);
  const int down = count_blocks(originals.rows(), plan.block),
            across = count_blocks(originals.cols(), plan.block);
  const int at_once = originals.tiles_at_once(plan.block);
  for (int first = 0; first < down; first += at_once) {
    const int end = std::min(first + at_once, down);
    const Originals::Part& part =
        originals.rows_of(first * plan.block, std::min(end * plan.block, originals.rows() - 1), progress);
    const Envelope envelope(part.original);
    struct Done {
      Window window;
      Decimation left;
      std::size_t faces = 0, edges_lost = 0;
    };
    std::vector<Done> done(at((end - first) * across));
    workers.for_each(done.size(), [&](std::size_t n) {
      const int number = static_cast<int>(n);
      const Window window = block_at(first + number / across, number % across, originals, plan.block);
      const Grid<std::uint8_t> lines = line_bits(plan.break_lines, window);
      PlanMesh mesh(part.dem.heights, part.window, window, lines);
      const std::size_t faces = mesh.count_faces(), lost = count_lost(lines, part, window, plan.kinds);
      set_kinds(mesh, part, window, plan.kinds);
      Decimation block(std::move(mesh));
      block.pass(plan.pass, envelope, most_to_go(faces, plan.least_part), progress);
      block.compact();
      done[n] = {window, std::move(block), faces, lost};
      progress.advance(plan.pass.share / (static_cast<double>(down) * across));
    });
    for (Done& one : done) {
      if (whole.mesh().triangles() + one.left.mesh().triangles() > PlanMesh::kMostTriangles) {
        throw OverBudget("More than " + std::to_string(PlanMesh::kMostTriangles) +
                         " triangles are left. Give a larger tolerance, or a part of the DEM.");
      }
      result.faces_before += one.faces;
      result.break_line_edges_lost += one.edges_lost;
      whole.add(std::move(one.left), one.window, joiner);
    }
    whole.expect_of_all(static_cast<double>(end) / down);
    // A third more while a pass's leavings are put together.
    budget.require(whole.bytes() / 3 * 4 + bytes_of_blocks(originals, plan.block, workers.count()),
                   "What is left of the first " + std::to_string(100 * end / down) + " % of the DEM",
                   "Give a larger tolerance, or a part of it.");
  }
  whole.finish(joiner);
  return result;
}

std::size_t bytes_of_blocks(const Originals& originals, int block, int threads) {
  constexpr std::size_t kBytesOfSample = 170;  // mesh 88, quadrics 40, states 12, tiles 8, and growth
  const int rows = originals.rows(), cols = originals.cols();
  const auto blocks = static_cast<std::int64_t>(count_blocks(rows, block)) * count_blocks(cols, block);
  const auto samples = at(std::min(rows, block + 1)) * at(std::min(cols, block + 1));
  return samples * kBytesOfSample * static_cast<std::size_t>(std::min<std::int64_t>(threads, blocks)) +
         originals.bytes(kLargestTile * block);
}

std::size_t count_faces(Originals& originals, int block, Progress& progress) {
  const int down = count_blocks(originals.rows(), block), at_once = originals.tiles_at_once(block);
  std::size_t count = 0;
  for (int first = 0; first < down; first += at_once) {
    const int begin = first * block, end = std::min((first + at_once) * block, originals.rows() - 1);
    const Originals::Part& part = originals.rows_of(begin, end, progress);
    for (int r = begin - part.window.row; r < end - part.window.row; ++r) {
      const float *above = part.dem.heights.row(r), *below = part.dem.heights.row(r + 1);
      for (int c = 0; c + 1 < originals.cols(); ++c) {
        if (std::isnan(above[c]) || std::isnan(below[c + 1])) continue;
        count += std::size_t{!std::isnan(above[c + 1])} + std::size_t{!std::isnan(below[c])};
      }
    }
  }
  return count;
}

}  // namespace sightbound
