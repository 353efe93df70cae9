// SPDX-License-Identifier: GPL-3.0-or-later
// The collapses of one tile in one pass.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/progress.h"
#include "simplify/bucket_queue.h"
#include "simplify/decimation.h"
#include "simplify/outline_index.h"
#include "simplify/placement.h"

namespace sightbound {

class TileDecimation {
 public:
  TileDecimation(Decimation& all, std::int32_t tile, const PassPlan& plan, const Envelope& envelope)
      : all_(all), mesh_(all.mesh_), envelope_(envelope), tile_(tile), plan_(plan) {}

  // `vertices` are those of the tile.
  void relax(std::span<const std::int32_t> vertices, Progress& progress);
  // Returns how many faces went, by so many collapses at most.
  std::size_t run(std::span<const std::int32_t> vertices, std::size_t most_collapses, Progress& progress);
  // How many edges run() would try, by class of their costs.
  std::vector<std::uint32_t> count_costs(std::span<const std::int32_t> vertices, Progress& progress);

 private:
  struct Edge {
    std::int32_t a, b;
    std::int32_t corner;  // where the edge was then
    std::uint32_t moves;  // of both ends when it was put in: it is out of date when they have moved since
  };

  static std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }
  Decimation::State& state(std::int32_t v) { return all_.states_[at(v)]; }
  bool in_tile(std::int32_t v) { return state(v).tile == tile_; }
  bool stays(std::int32_t v) { return state(v).frozen || mesh_.kind(v) >= VertexKind::kFixed; }

  void move_to_room(std::int32_t v);
  void has_changed(std::int32_t v);
  void push_untested_edges(std::int32_t v);
  void push_all_edges(std::int32_t v);
  void push(std::int32_t corner, std::int32_t v, std::int32_t w);
  bool pop(Edge& edge);
  bool up_to_date(const Edge& edge);
  void keep_untested();
  QuadricSum quadrics(std::int32_t v, std::int32_t w);
  Freedom freedom(std::int32_t a, bool outline_edge);
  std::int32_t corner_of(const Edge& edge) const;
  void try_collapse(std::int32_t corner);
  bool try_collapse_of(std::int32_t corner, bool next_stays);
  std::optional<LineRules::Edge> line_without_b();
  void index_outline(std::int32_t v);
  void collapse(const Point& to, const QuadricSum& quadric);

  Decimation& all_;
  PlanMesh& mesh_;
  const Envelope& envelope_;
  const std::int32_t tile_;
  const PassPlan& plan_;
  BucketQueue<Edge> queue_;
  OutlineIndex outline_;  // where it moves, of the tile's vertices
  EdgeStar star_;
  std::size_t faces_gone_ = 0, collapses_ = 0;
};

}  // namespace sightbound
