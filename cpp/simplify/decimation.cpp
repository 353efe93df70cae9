// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/decimation.h"

#include <algorithm>
#include <array>
#include <atomic>

#include "simplify/tile_decimation.h"

namespace sightbound {

namespace {
std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }
}  // namespace

Decimation::Decimation(PlanMesh& mesh, const Envelope& envelope)
    : mesh_(mesh), envelope_(envelope), states_(mesh.vertices()), quadrics_(mesh.vertices()) {
  for (std::int32_t t = 0; at(t) < mesh_.triangles(); ++t) {
    const Point a = mesh.place(mesh.vertex(4 * t)), b = mesh.place(mesh.vertex(4 * t + 1)),
                c = mesh.place(mesh.vertex(4 * t + 2));
    quadrics_[at(mesh.vertex(4 * t))].add_triangle(a, b, c, a);
    quadrics_[at(mesh.vertex(4 * t + 1))].add_triangle(a, b, c, b);
    quadrics_[at(mesh.vertex(4 * t + 2))].add_triangle(a, b, c, c);
  }
}

std::size_t Decimation::pass(const PassPlan& plan, const Workers& workers, Progress& progress) {
  ++pass_;
  assign_tiles(plan);
  freeze_seams();
  std::atomic<std::size_t> gone = 0;
  workers.for_each(begin_.size() - 1, [&](std::size_t t) {
    TileDecimation tile(*this, static_cast<std::int32_t>(t), plan);
    gone += tile.run({members_.data() + begin_[t], at(begin_[t + 1] - begin_[t])}, progress);
    progress.advance(plan.share * (begin_[t + 1] - begin_[t]) / static_cast<double>(members_.size()));
  });
  return gone;
}

void Decimation::assign_tiles(const PassPlan& plan) {
  const auto count = static_cast<std::int32_t>(mesh_.vertices());
  const auto tile_at = [&](std::int32_t step, int shift) {
    return (step / kStepsPerCell + shift) / plan.tile;
  };
  std::int32_t tiles_x = 0, tiles_y = 0;
  for (std::int32_t v = 0; v < count; ++v) {
    if (mesh_.corner_of(v) == PlanMesh::kNone) continue;
    tiles_x = std::max(tiles_x, tile_at(mesh_.step_x(v), plan.shift_x) + 1);
    tiles_y = std::max(tiles_y, tile_at(mesh_.step_y(v), plan.shift_y) + 1);
  }
  begin_.assign(at(tiles_x * tiles_y) + 1, 0);
  for (std::int32_t v = 0; v < count; ++v) {
    if (mesh_.corner_of(v) == PlanMesh::kNone) continue;
    State& state = states_[at(v)];
    state.tile = tile_at(mesh_.step_y(v), plan.shift_y) * tiles_x + tile_at(mesh_.step_x(v), plan.shift_x);
    state.frozen = false;
    ++begin_[at(state.tile) + 1];
  }
  for (std::size_t t = 1; t < begin_.size(); ++t) begin_[t] += begin_[t - 1];
  members_.resize(at(begin_.back()));
  std::vector<std::int32_t> end(begin_.begin(), begin_.end() - 1);
  for (std::int32_t v = 0; v < count; ++v) {
    if (mesh_.corner_of(v) != PlanMesh::kNone) members_[at(end[at(states_[at(v)].tile)]++)] = v;
  }
}

// The corners of triangles that reach over a tile's edge. What had to be tested of them still has to.
void Decimation::freeze_seams() {
  for (std::int32_t t = 0; at(t) < mesh_.triangles(); ++t) {
    if (!mesh_.alive(t)) continue;
    const std::array<State*, 3> corners{&states_[at(mesh_.vertex(4 * t))],
                                        &states_[at(mesh_.vertex(4 * t + 1))],
                                        &states_[at(mesh_.vertex(4 * t + 2))]};
    if (corners[0]->tile == corners[1]->tile && corners[0]->tile == corners[2]->tile) continue;
    for (State* state : corners) {
      state->frozen = true;
      if (state->changed + 1 >= pass_) state->changed = pass_;
    }
  }
}

}  // namespace sightbound
