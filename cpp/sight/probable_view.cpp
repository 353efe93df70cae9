// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/probable_view.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sight/fine_ground.h"

namespace sightbound {

ProbableView::ProbableView(const OpenTerrain& terrain, const ProbableEye& eye, std::vector<float> heights,
                           double bend, const Refinement& refinement)
    : terrain_(terrain),
      eye_(eye),
      heights_(std::move(heights)),
      bend_(bend),
      refinement_(refinement),
      columns_{{terrain, false}, {terrain, true}} {
  for (const RayBlock& rays : ray_blocks(eye)) blocks_.push_back({rays, {}});
}

// The ground in the eye's place: between the four nodes around, or those that are known beside a hole. Visits
// each with its part.
template <class Visit>
void ProbableView::nodes_at_eye(const Visit& visit) const {
  const double col = 2 * eye_.frame->col(), row = 2 * eye_.frame->row();
  const int c = 2 * eye_.base_col + static_cast<int>(col), r = 2 * eye_.base_row + static_cast<int>(row);
  const int c1 = std::min(c + 1, columns_[0].majors() - 1), r1 = std::min(r + 1, columns_[0].minors() - 1);
  const auto u = static_cast<float>(col - std::floor(col)), v = static_cast<float>(row - std::floor(row));
  struct Part {
    int line, node;
    float part;
  };
  std::vector<Part> parts;
  std::vector<HeightRange> one;
  float sum = 0;
  for (const auto& [line, along] : {std::pair{c, 1 - u}, std::pair{c1, u}}) {
    for (const auto& [node, across] : {std::pair{r, 1 - v}, std::pair{r1, v}}) {
      if (along * across == 0) continue;
      columns_[0].ranges(line, node, node, one);
      if (std::isnan(one[0].low)) continue;
      parts.push_back({line, node, along * across});
      sum += along * across;
    }
  }
  const bool all = parts.size() == 4 || sum == 1;
  for (const Part& each : parts) visit(each.line, each.node, all ? each.part : each.part / sum);
}

HeightRange ProbableView::eye_range() const {
  HeightRange sum{0, 0};
  std::vector<HeightRange> one;
  nodes_at_eye([&](int line, int node, float part) {
    columns_[0].ranges(line, node, node, one);
    sum.low += part * one[0].low;
    sum.high += part * one[0].high;
  });
  const Departure own = departure_at_eye();
  const float most = terrain_.largest_draw * own.spread, lift = own.rise + static_cast<float>(eye_.height);
  return {sum.low - most + lift, sum.high + most + lift};
}

// Of the ground there from what lies between the nodes.
Departure ProbableView::departure_at_eye() const {
  const double col = eye_.frame->col(), row = eye_.frame->row();
  const auto share = [](double place) { return 2 * place - std::floor(2 * place); };
  const FineGround fine(terrain_, false, eye_.base_row, eye_.base_col, refinement_.crossings);
  return fine.inside({col, row, 0}, share(col), share(row));
}

SixteenEyes ProbableView::eyes(std::uint32_t first_realisation) const {
  SixteenEyes eyes{};
  nodes_at_eye([&](int line, int node, float part) {
    const Lanes height = columns_[0].heights(line, node, first_realisation);
    for (int l = 0; l < kLanes; ++l) eyes.ground.v[l] += part * height.v[l];
  });
  const Lanes between_nodes = eyes.ground;
  draw_about(
      departure_at_eye(), first_realisation, [&](int l) { return between_nodes.v[l]; }, eyes.ground);
  for (int l = 0; l < kLanes; ++l) eyes.eye.v[l] = eyes.ground.v[l] + static_cast<float>(eye_.height);
  return eyes;
}

// A coin for each realisation, whoever looks.
std::uint16_t ProbableView::open_holes(std::uint32_t first_realisation) const {
  return sightbound::open_holes(terrain_.seed, first_realisation);
}

void ProbableView::bound(std::size_t number, CellLayers& cells) {
  Block& block = blocks_[number];
  const RayFan fan(terrain_, eye_, bend_, block.rays);
  const FineGround fine(terrain_, block.rays.transposed, eye_.base_row, eye_.base_col, refinement_.crossings);
  BoundedMarch march(fan, columns_[block.rays.transposed ? 1 : 0], fine, refinement_, eye_range(), heights_);
  march.run([&](int, int) { return all_layers(); }, eye_, {});
  for (const BoundedMarch::Target& target : march.targets()) {
    Layers &open = cells.open.at(target.row, target.col), &seen = cells.seen.at(target.row, target.col);
    open = static_cast<Layers>(open | target.open);
    seen = static_cast<Layers>(seen | target.seen);
  }
  block.last_lines = march.last_lines();
}

void ProbableView::look(std::size_t number, const CellLayers& cells, const Draws& draws,
                        const SeenBits& seen) {
  Block& block = blocks_[number];
  if (std::ranges::all_of(block.last_lines, [](int line) { return line < 0; })) return;
  const RayFan fan(terrain_, eye_, bend_, block.rays);
  const FineGround fine(terrain_, block.rays.transposed, eye_.base_row, eye_.base_col, refinement_.crossings);
  const RealisedColumns& columns = columns_[block.rays.transposed ? 1 : 0];
  BoundedMarch march(fan, columns, fine, refinement_, eye_range(), heights_);
  march.run([&](int row, int col) { return cells.open.at(row, col); }, eye_, block.last_lines);
  block.last_lines = march.last_lines();
  const SightPlan plan = write_plan(march, fan, columns, fine, refinement_,
                                    [&](int row, int col) { return cells.item.at(row, col); });
  PlanRunner runner;
  for (int i = 0; i < draws.sixteens; ++i) {
    const std::uint32_t first = draws.first + static_cast<std::uint32_t>(i * kLanes);
    runner.run(plan, eyes(first), heights_, first, open_holes(first), {seen.bits + i, seen.stride});
  }
}

}  // namespace sightbound
