// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/decimation.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <numeric>
#include <utility>

#include "simplify/tile_decimation.h"

namespace sightbound {

namespace {
std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

// Which collapses the tiles may make.
struct Shares {
  std::size_t cost_classes = 0;        // of the cheapest
  std::vector<std::size_t> collapses;  // of each tile
};

// A collapse takes three edges with it. Most of the way is gone in halves, so that what is cheap everywhere
// goes before anything that is dearer.
Shares cheapest_shares(const std::vector<std::vector<std::uint32_t>>& edges, std::size_t collapses) {
  constexpr std::size_t kEdges = 3, kFew = 1000;
  const std::size_t wanted = collapses > kFew ? collapses / 2 : collapses;
  Shares shares;
  std::vector<std::size_t> below(edges.size(), 0);  // edges of a tile in the classes taken
  std::size_t sum = 0;
  for (; shares.cost_classes < kCostClasses && sum < kEdges * wanted; ++shares.cost_classes) {
    for (std::size_t t = 0; t < edges.size(); ++t) {
      below[t] += edges[t][shares.cost_classes];
      sum += edges[t][shares.cost_classes];
    }
  }
  const std::size_t all = std::min(collapses, (sum + kEdges - 1) / kEdges);
  std::size_t before = 0;
  for (const std::size_t one : below) {
    const auto up_to = [&](std::size_t n) { return sum > 0 ? n * all / sum : 0; };
    shares.collapses.push_back(up_to(before + one) - up_to(before));
    before += one;
  }
  return shares;
}

template <class T>
void keep_only(const std::vector<std::int32_t>& numbers, std::vector<T>& values) {
  for (std::size_t n = 0; n < numbers.size(); ++n) values[n] = values[at(numbers[n])];
  values.resize(numbers.size());
  values.shrink_to_fit();
}
}  // namespace

Decimation::Decimation(PlanMesh mesh)
    : mesh_(std::move(mesh)), states_(mesh_.vertices()), quadrics_(mesh_.vertices()) {
  for (std::int32_t t = 0; at(t) < mesh_.triangles(); ++t) {
    const Point a = mesh_.place(mesh_.vertex(4 * t)), b = mesh_.place(mesh_.vertex(4 * t + 1)),
                c = mesh_.place(mesh_.vertex(4 * t + 2));
    quadrics_[at(mesh_.vertex(4 * t))].add_triangle(a, b, c, a);
    quadrics_[at(mesh_.vertex(4 * t + 1))].add_triangle(a, b, c, b);
    quadrics_[at(mesh_.vertex(4 * t + 2))].add_triangle(a, b, c, c);
  }
}

void Decimation::pass(const PassPlan& plan, const Envelope& envelope, std::size_t most_collapses,
                      Progress& progress) {
  ++pass_;
  std::vector<std::int32_t> all(mesh_.vertices());
  std::iota(all.begin(), all.end(), 0);
  TileDecimation(*this, 0, plan, envelope).run(all, most_collapses, progress);
}

std::size_t Decimation::pass(const PassPlan& plan, Originals& originals, const Workers& workers,
                             Progress& progress) {
  const Tiles tiles = begin_pass(plan, originals);
  std::atomic<std::size_t> gone = 0;
  const auto all = [](std::size_t) { return true; };
  for_each_tile(plan, tiles, originals, workers, progress, all, [&](std::size_t t, const Envelope& envelope) {
    TileDecimation tile(*this, static_cast<std::int32_t>(t), plan, envelope);
    if (plan.relax) tile.relax(vertices_of(t), progress);
    gone += tile.run(vertices_of(t), kAllCollapses, progress);
    progress.advance(plan.share * static_cast<double>(vertices_of(t).size()) /
                     static_cast<double>(members_.size()));
  });
  return gone;
}

std::size_t Decimation::pass_of(std::size_t collapses, PassPlan plan, Originals& originals,
                                const Workers& workers, Progress& progress) {
  const Tiles tiles = begin_pass(plan, originals);
  const auto all = [](std::size_t) { return true; };
  std::vector<std::vector<std::uint32_t>> edges(begin_.size() - 1);
  for_each_tile(plan, tiles, originals, workers, progress, all, [&](std::size_t t, const Envelope& envelope) {
    TileDecimation tile(*this, static_cast<std::int32_t>(t), plan, envelope);
    if (plan.relax) tile.relax(vertices_of(t), progress);
    edges[t] = tile.count_costs(vertices_of(t), progress);
  });
  const Shares shares = cheapest_shares(edges, collapses);
  plan.cost_classes = shares.cost_classes;
  std::atomic<std::size_t> gone = 0;
  const auto wanted = [&](std::size_t t) { return shares.collapses[t] > 0; };
  for_each_tile(plan, tiles, originals, workers, progress, wanted,
                [&](std::size_t t, const Envelope& envelope) {
                  TileDecimation tile(*this, static_cast<std::int32_t>(t), plan, envelope);
                  gone += tile.run(vertices_of(t), shares.collapses[t], progress);
                  progress.advance(plan.share * static_cast<double>(vertices_of(t).size()) /
                                   static_cast<double>(members_.size()));
                });
  for (std::size_t t = 0; t < edges.size(); ++t) {
    if (!wanted(t)) leave_to_next_pass(t);
  }
  return gone;
}

void Decimation::leave_to_next_pass(std::size_t tile) {
  for (const std::int32_t v : vertices_of(tile)) {
    if (states_[at(v)].changed + 1 >= pass_) states_[at(v)].changed = pass_;
  }
}

Decimation::Tiles Decimation::begin_pass(const PassPlan& plan, const Originals& originals) {
  ++pass_;
  const Tiles tiles = assign_tiles(plan, originals);
  freeze_seams();
  return tiles;
}

std::span<const std::int32_t> Decimation::vertices_of(std::size_t tile) const {
  return {members_.data() + begin_[tile], at(begin_[tile + 1] - begin_[tile])};
}

void Decimation::for_each_tile(const PassPlan& plan, const Tiles& tiles, Originals& originals,
                               const Workers& workers, Progress& progress,
                               const std::function<bool(std::size_t)>& wanted,
                               const std::function<void(std::size_t, const Envelope&)>& f) {
  const int at_once = originals.tiles_at_once(plan.tile);
  for (int first = 0; first < tiles.down; first += at_once) {
    const int end = std::min(first + at_once, tiles.down);
    std::vector<std::size_t> band;
    for (std::size_t t = at(first * tiles.across); t < at(end * tiles.across); ++t) {
      if (wanted(t)) band.push_back(t);
    }
    if (band.empty()) continue;
    const Originals::Part& part =
        originals.rows_of(std::max(first * plan.tile - plan.shift_y, 0),
                          std::min(end * plan.tile - plan.shift_y, originals.rows() - 1), progress);
    const Envelope envelope(part.original);
    workers.for_each(band.size(), [&](std::size_t n) { f(band[n], envelope); });
  }
}

void Decimation::compact() {
  lead_followed_to_what_stays();
  const std::vector<std::int32_t> old = mesh_.compact();
  keep_only(old, states_);
  keep_only(old, quadrics_);
  // Numbers stay in order.
  for (std::int32_t& v : followed_) {
    v = static_cast<std::int32_t>(std::lower_bound(old.begin(), old.end(), v) - old.begin());
  }
}

void Decimation::forget_what_failed() {
  for (State& state : states_) state.changed = pass_;
}

void Decimation::follow_vertices() {
  followed_.resize(mesh_.vertices());
  std::iota(followed_.begin(), followed_.end(), 0);
}

void Decimation::lead_followed_to_what_stays() {
  if (followed_.empty()) return;
  // What each vertex was drawn into in the end; chains are shortened as they are walked.
  std::vector<std::int32_t> end(mesh_.vertices());
  for (std::int32_t v = 0; at(v) < end.size(); ++v) {
    end[at(v)] = mesh_.corner_of(v) == PlanMesh::kNone ? mesh_.drawn_into(v) : v;
  }
  for (std::int32_t& v : followed_) {
    while (end[at(v)] != v) {
      end[at(v)] = end[at(end[at(v)])];
      v = end[at(v)];
    }
  }
}

std::size_t Decimation::bytes() const {
  return mesh_.bytes() + states_.size() * (sizeof(State) + sizeof(std::int32_t)) +
         quadrics_.size() * sizeof(Quadric);
}

void Decimation::expect_of_all(double part) {
  mesh_.expect_of_all(part);
  make_room(states_, part);
  make_room(quadrics_, part);
}

void Decimation::add(Decimation block, const Window& window, BlockJoiner& joiner) {
  pass_ = block.pass_;
  const std::vector<std::int32_t> number = joiner.add(block.mesh_, window);
  states_.resize(mesh_.vertices());
  quadrics_.resize(mesh_.vertices());
  for (std::size_t v = 0; v < number.size(); ++v) {
    quadrics_[at(number[v])] += block.quadrics_[v];
    const bool rim = block.mesh_.kind(static_cast<std::int32_t>(v)) == VertexKind::kRim;
    states_[at(number[v])].changed = rim ? pass_ : block.states_[v].changed;
  }
}

void Decimation::finish(BlockJoiner& joiner) {
  for (const std::int32_t v : joiner.finish()) {
    states_.push_back(states_[at(v)]);
    quadrics_.push_back(quadrics_[at(v)]);
  }
}

Decimation::Tiles Decimation::assign_tiles(const PassPlan& plan, const Originals& originals) {
  const auto count = static_cast<std::int32_t>(mesh_.vertices());
  const auto tile_at = [&](std::int32_t cell, int shift) { return (cell + shift) / plan.tile; };
  const Tiles tiles{tile_at(originals.cols() - 1, plan.shift_x) + 1,
                    tile_at(originals.rows() - 1, plan.shift_y) + 1};
  begin_.assign(at(tiles.across) * at(tiles.down) + 1, 0);
  for (std::int32_t v = 0; v < count; ++v) {
    if (mesh_.corner_of(v) == PlanMesh::kNone) continue;
    State& state = states_[at(v)];
    state.tile = tile_at(mesh_.step_y(v) / kStepsPerCell, plan.shift_y) * tiles.across +
                 tile_at(mesh_.step_x(v) / kStepsPerCell, plan.shift_x);
    state.frozen = false;
    ++begin_[at(state.tile) + 1];
  }
  for (std::size_t t = 1; t < begin_.size(); ++t) begin_[t] += begin_[t - 1];
  members_.resize(at(begin_.back()));
  std::vector<std::int32_t> end(begin_.begin(), begin_.end() - 1);
  for (std::int32_t v = 0; v < count; ++v) {
    if (mesh_.corner_of(v) != PlanMesh::kNone) members_[at(end[at(states_[at(v)].tile)]++)] = v;
  }
  return tiles;
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
