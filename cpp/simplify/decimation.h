// SPDX-License-Identifier: GPL-3.0-or-later
// Edge collapses within the envelope, cheapest first, tile by tile.
//
// A pass cuts the plane into square tiles; vertices of triangles that reach over a tile's edge stay as they
// are, so that tiles do not see each other. The next pass has its tiles elsewhere.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "simplify/block_joiner.h"
#include "simplify/bucket_queue.h"
#include "simplify/envelope.h"
#include "simplify/line_rules.h"
#include "simplify/originals.h"
#include "simplify/plan_mesh.h"
#include "simplify/quadric.h"

namespace sightbound {

struct PassPlan {
  int tile = 256;                           // cells a side
  int shift_x = 0, shift_y = 0;             // of the tiles, cells
  bool relax = false;                       // move vertices to where they have most room before anything else
  std::size_t cost_classes = kCostClasses;  // collapses that cost more are left to other passes
  double share = 0;                         // of `progress`
  LineRules lines;                          // the same in all passes
};

inline constexpr std::size_t kAllCollapses = std::numeric_limits<std::size_t>::max();

class Decimation {
 public:
  Decimation() = default;
  explicit Decimation(PlanMesh mesh);

  const PlanMesh& mesh() const { return mesh_; }
  PlanMesh& mesh() { return mesh_; }

  // The whole mesh as one tile, with so many collapses at most.
  void pass(const PassPlan& plan, const Envelope& envelope, std::size_t most_collapses, Progress& progress);
  // Tile by tile. Returns how many faces went. Advances `progress` by the plan's share.
  std::size_t pass(const PassPlan& plan, Originals& originals, const Workers& workers, Progress& progress);
  // The same with so many collapses at most, half as many if they are many, of the cheapest edges. Each tile
  // has a part of them by the number of its cheap edges.
  std::size_t pass_of(std::size_t collapses, PassPlan plan, Originals& originals, const Workers& workers,
                      Progress& progress);

  // Gives back the memory of what went.
  void compact();
  // All edges are worth trying again: the tolerance is another one.
  void forget_what_failed();
  // Remembers from now on where the vertices go that there are. The mesh is compact.
  void follow_vertices();
  // The vertex that each of them has been drawn into; where there was none to follow, empty. Compact.
  const std::vector<std::int32_t>& followed() const { return followed_; }
  std::size_t bytes() const;
  // Makes room, this being so much of what there will be.
  void expect_of_all(double part);

  // What the passes over blocks have left, joined along their rims. All blocks have had as many.
  void add(Decimation block, const Window& window, BlockJoiner& joiner);
  void finish(BlockJoiner& joiner);

 private:
  friend class TileDecimation;

  // Of a vertex. Tiles write to their own alone.
  struct State {
    std::uint32_t moves = 0;
    std::int32_t tile = 0;
    // The last pass that changed something around it, or left edges of it untested.
    std::uint16_t changed = 0;
    bool frozen = false;  // in this pass
  };
  struct Tiles {
    int across = 0, down = 0;
  };

  Tiles begin_pass(const PassPlan& plan, const Originals& originals);
  Tiles assign_tiles(const PassPlan& plan, const Originals& originals);
  void freeze_seams();
  void lead_followed_to_what_stays();
  void leave_to_next_pass(std::size_t tile);
  std::span<const std::int32_t> vertices_of(std::size_t tile) const;
  // f(tile, envelope) for all tiles that are wanted, in parallel.
  void for_each_tile(const PassPlan& plan, const Tiles& tiles, Originals& originals, const Workers& workers,
                     Progress& progress, const std::function<bool(std::size_t)>& wanted,
                     const std::function<void(std::size_t, const Envelope&)>& f);

  PlanMesh mesh_;
  std::vector<State> states_;
  std::vector<Quadric> quadrics_;  // of vertices
  std::vector<std::int32_t> followed_;
  std::uint16_t pass_ = 0;
  // Vertices by tile: those of tile t are members_[begin_[t]] to members_[begin_[t + 1]].
  std::vector<std::int32_t> begin_, members_;
};

}  // namespace sightbound
