// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/block_joiner.h"

#include <algorithm>

namespace sightbound {

namespace {
std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }
}  // namespace

bool on_rim(const Window& block, int rows, int cols, int row, int col) {
  return (row == block.row && row > 0) || (row == block.row_end() - 1 && row < rows - 1) ||
         (col == block.col && col > 0) || (col == block.col_end() - 1 && col < cols - 1);
}

void BlockJoiner::Rim::clear() {
  std::fill(vertex.begin(), vertex.end(), PlanMesh::kNone);
  std::fill(corner.begin(), corner.end(), PlanMesh::kNone);
}

BlockJoiner::BlockJoiner(PlanMesh& whole, const KindRules& rules)
    : whole_(whole),
      rules_(rules),
      above_(rules.cols),
      below_(rules.cols),
      left_(rules.rows),
      right_(rules.rows) {}

std::vector<std::int32_t> BlockJoiner::add(const PlanMesh& block, const Window& window) {
  begin(window);
  std::vector<std::int32_t> number(block.vertices());
  for (std::int32_t v = 0; at(v) < block.vertices(); ++v) number[at(v)] = number_of(block, v);
  const auto first = static_cast<std::int32_t>(whole_.corners_.size());
  for (const PlanMesh::Corner& corner : block.corners_) {
    const bool marks = corner.vertex == PlanMesh::kNone;
    const bool open = corner.opposite == PlanMesh::kNone;
    whole_.corners_.push_back(marks ? corner
                                    : PlanMesh::Corner{number[at(corner.vertex)],
                                                       open ? PlanMesh::kNone : first + corner.opposite});
  }
  for (std::int32_t c = first; at(c) < whole_.corners_.size(); ++c) {
    if (whole_.vertex(c) != PlanMesh::kNone && whole_.opposite(c) == PlanMesh::kNone) join_edge(c);
  }
  return number;
}

void BlockJoiner::begin(const Window& window) {
  if (window.col == 0 && window.row > 0) {
    std::swap(above_, below_);
    below_.clear();
  }
  std::swap(left_, right_);
  right_.clear();
  window_ = window;
}

// Where a sample is found along the rims.
std::vector<BlockJoiner::Place> BlockJoiner::places_of(int row, int col) {
  std::vector<Place> places;
  if (row == window_.row && row > 0) places.push_back({&above_, at(col)});
  if (row == window_.row_end() - 1 && row < rules_.rows - 1) places.push_back({&below_, at(col)});
  if (col == window_.col && col > 0) places.push_back({&left_, at(row)});
  if (col == window_.col_end() - 1 && col < rules_.cols - 1) places.push_back({&right_, at(row)});
  return places;
}

std::int32_t BlockJoiner::number_of(const PlanMesh& block, std::int32_t v) {
  const auto add = [&] {
    whole_.vertices_.push_back(block.vertices_[at(v)]);
    whole_.vertices_.back().corner += static_cast<std::int32_t>(whole_.corners_.size());
    return static_cast<std::int32_t>(whole_.vertices_.size()) - 1;
  };
  if (block.kind(v) < VertexKind::kFixed) return add();
  const auto places = places_of(block.step_y(v) / kStepsPerCell, block.step_x(v) / kStepsPerCell);
  if (places.empty()) return add();
  std::int32_t number = PlanMesh::kNone;
  for (const Place& place : places) number = std::max(number, place.rim->vertex[place.at]);
  if (number == PlanMesh::kNone) number = add();
  for (const Place& place : places) place.rim->vertex[place.at] = number;
  return number;
}

// Both sides of an edge of the rim come by, one after the other.
void BlockJoiner::join_edge(std::int32_t corner) {
  const std::int32_t a = whole_.vertex(PlanMesh::next(corner)), b = whole_.vertex(PlanMesh::previous(corner));
  if (whole_.kind(a) < VertexKind::kFixed || whole_.kind(b) < VertexKind::kFixed) return;
  const int ax = whole_.step_x(a), ay = whole_.step_y(a), bx = whole_.step_x(b), by = whole_.step_y(b);
  const bool along_row = ay == by, along_col = ax == bx;
  if (!along_row && !along_col) return;
  for (const Place& place : places_of(std::min(ay, by) / kStepsPerCell, std::min(ax, bx) / kStepsPerCell)) {
    if ((place.rim == &above_ || place.rim == &below_) != along_row) continue;
    const int row = std::max(ay, by) / kStepsPerCell, col = std::max(ax, bx) / kStepsPerCell;
    const auto ends = places_of(row, col);
    if (std::none_of(ends.begin(), ends.end(), [&](const Place& end) { return end.rim == place.rim; }))
      continue;
    std::int32_t& other = place.rim->corner[place.at];
    if (other == PlanMesh::kNone) {
      other = corner;
    } else {
      whole_.join(corner, other);
    }
  }
}

std::vector<std::int32_t> BlockJoiner::finish() {
  for (std::int32_t v = 0; at(v) < whole_.vertices(); ++v) {
    if (whole_.kind(v) == VertexKind::kRim) whole_.set_kind(v, kind_of(whole_, v, rules_));
  }
  return whole_.split_touching();
}

}  // namespace sightbound
