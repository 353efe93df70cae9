// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/decimation.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <span>

#include "simplify/quadric.h"

namespace sightbound {

namespace {
std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }
constexpr double kThinnest = 1.0 / 64;  // cells: least height of a triangle in plan
}  // namespace

std::vector<PassPlan> pass_plans(std::size_t faces_to_lose) {
  if (faces_to_lose > 0) return {PassPlan{.tile = kMostCells, .most_faces = faces_to_lose}};
  constexpr int kTile = 128;  // cells
  constexpr std::array<std::array<int, 2>, 4> kShifts{
      {{0, 0}, {2, 2}, {0, 2}, {2, 0}}};  // quarters of a tile
  std::vector<PassPlan> plans;
  for (const auto& shift : kShifts) {
    plans.push_back({.tile = kTile, .shift_x = shift[0] * kTile / 4, .shift_y = shift[1] * kTile / 4});
  }
  return plans;
}

class TileDecimation {
 public:
  TileDecimation(Decimation& all, std::int32_t tile, const PassPlan& plan)
      : all_(all),
        mesh_(all.mesh_),
        tile_(tile),
        cost_limit_(plan.cost_limit),
        most_faces_(plan.most_faces) {}

  std::size_t run(std::span<const std::int32_t> vertices, Progress& progress) {
    for (const std::int32_t v : vertices) push_edges_of(v, true);
    for (const std::int32_t v : vertices) {
      if (all_.frozen_[at(v)] == 0) all_.changed_[at(v)] = 0;
    }
    flush_late();
    for (std::size_t n = 0; !queue_.empty() && faces_gone_ < most_faces_; ++n) {
      if (n % 1024 == 0) progress.check();
      const Edge edge = pop();
      if (mesh_.corner_of(edge.a) == PlanMesh::kNone || mesh_.corner_of(edge.b) == PlanMesh::kNone ||
          moves(edge.a, edge.b) != edge.moves) {
        continue;
      }
      const std::int32_t corner = corner_of(edge.a, edge.b);
      if (corner == PlanMesh::kNone || !gather(mesh_, corner, star_)) continue;
      const Quadric quadric(star_);
      const double cost = cost_of(quadric);
      if (cost > cost_limit_) {
        all_.changed_[at(edge.a)] = all_.changed_[at(edge.b)] = 1;
        continue;
      }
      if (!queue_.empty() && cost > queue_.front().cost * 1.001f) {
        push({static_cast<float>(cost), edge.a, edge.b, edge.moves});
        continue;
      }
      try_collapse(quadric);
    }
    return faces_gone_;
  }

 private:
  struct Edge {
    float cost;
    std::int32_t a, b;
    std::uint32_t moves;  // of both ends when it was put in
    friend bool operator<(const Edge& e, const Edge& f) {
      return e.cost != f.cost ? e.cost > f.cost : e.a != f.a ? e.a > f.a : e.b > f.b;
    }
  };

  std::uint32_t moves(std::int32_t a, std::int32_t b) const {
    return all_.moves_[at(a)] + all_.moves_[at(b)];
  }
  std::int32_t corner_of(std::int32_t a, std::int32_t b) const {
    const std::int32_t corner = mesh_.corner_towards(a, b);
    return corner != PlanMesh::kNone ? corner : mesh_.corner_towards(b, a);
  }
  bool stays(std::int32_t v) const { return all_.frozen_[at(v)] != 0 || mesh_.kind(v) == VertexKind::kFixed; }

  void push(const Edge& edge) {
    queue_.push_back(edge);
    std::push_heap(queue_.begin(), queue_.end());
  }
  Edge pop() {
    std::pop_heap(queue_.begin(), queue_.end());
    const Edge edge = queue_.back();
    queue_.pop_back();
    return edge;
  }

  template <class F>
  void for_each_edge(std::int32_t v, const F& f) {
    const std::int32_t first = mesh_.first_corner(v);
    std::int32_t corner = first;
    for (;;) {
      f(corner, mesh_.vertex(PlanMesh::next(corner)));
      const std::int32_t after = mesh_.counterclockwise(corner);
      if (after == PlanMesh::kNone) {
        f(PlanMesh::previous(corner), mesh_.vertex(PlanMesh::previous(corner)));
        return;
      }
      if (after == first) return;
      corner = after;
    }
  }

  // At the start each edge once, later all of a vertex that has moved.
  void push_edges_of(std::int32_t v, bool start) {
    for_each_edge(v, [&](std::int32_t corner, std::int32_t w) {
      if (all_.tile_of_[at(w)] != tile_) return;
      if (stays(v) && stays(w)) return;
      if (start && (v > w || (all_.changed_[at(v)] | all_.changed_[at(w)]) == 0)) return;
      EdgeStar& star = start ? star_ : other_star_;
      if (!gather(mesh_, corner, star)) return;
      const double cost = [&] {
        const Quadric q(star);
        return q.cost(target(q, star));
      }();
      if (cost > cost_limit_) {
        late_.push_back(v), late_.push_back(w);
        return;
      }
      push({static_cast<float>(cost), v, w, moves(v, w)});
    });
    if (!start) flush_late();
  }
  void flush_late() {
    for (const std::int32_t v : late_) all_.changed_[at(v)] = 1;
    late_.clear();
  }

  // What the new vertex may do, by the kinds of the edge's ends.
  enum class Freedom { kNone, kHeight, kLine, kPlane };
  Freedom freedom(const EdgeStar& star) const {
    if (stays(star.a)) return Freedom::kNone;
    const bool outline_edge = star.right < 0;
    if (mesh_.kind(star.a) == VertexKind::kCorner || (!star.closed && !outline_edge)) return Freedom::kHeight;
    return outline_edge ? Freedom::kLine : Freedom::kPlane;
  }

  // Where the quadric would have it.
  Point target(const Quadric& q, const EdgeStar& star) const {
    const Point &a = star.place_a, &b = star.place_b;
    const auto best_at = [&](double x, double y) { return Point{x, y, q.best_height(x, y)}; };
    switch (freedom(star)) {
      case Freedom::kNone:
        return a;
      case Freedom::kHeight:
        return best_at(a.x, a.y);
      case Freedom::kLine:
        return best_at((a.x + b.x) / 2, (a.y + b.y) / 2);
      default:
        return q.optimum();
    }
  }
  double cost_of(const Quadric& q) const { return q.cost(target(q, star_)); }

  static double snapped(double v) { return std::floor(v * kStepsPerCell + 0.5) / kStepsPerCell; }

  void try_collapse(const Quadric& q) {
    // Of two vertices of one kind the one that stays is kept.
    if (stays(star_.b)) {
      if (stays(star_.a) || mesh_.kind(star_.a) != mesh_.kind(star_.b)) return;
      std::swap(star_.a, star_.b);
      std::swap(star_.place_a, star_.place_b);
    }
    const Freedom free = freedom(star_);
    if (free == Freedom::kNone || free == Freedom::kHeight) {
      try_at(q, star_.place_a, free == Freedom::kNone);
      return;
    }
    const Point &a = star_.place_a, &b = star_.place_b;
    const auto cost_at = [&](const Point& p) { return q.cost({p.x, p.y, q.best_height(p.x, p.y)}); };
    const Point best = q.optimum();
    if (free == Freedom::kPlane && try_at(q, {snapped(best.x), snapped(best.y), 0}, false)) return;
    if (try_at(q, {snapped((a.x + b.x) / 2), snapped((a.y + b.y) / 2), 0}, false)) return;
    const bool a_first = cost_at(a) <= cost_at(b);
    if (try_at(q, a_first ? a : b, false)) return;
    try_at(q, a_first ? b : a, false);
  }

  bool well_shaped(const Point& p) const {
    for (int i = 0; i < star_.sides(); ++i) {
      const auto n = static_cast<std::size_t>(i);
      const Point &v = star_.at[n], &w = star_.at[n + 1];
      const double area = area2(p, v, w);
      if (area <= 0) return false;
      const auto l2 = [](const Point& s, const Point& t) {
        return (s.x - t.x) * (s.x - t.x) + (s.y - t.y) * (s.y - t.y);
      };
      const double longest = std::max({l2(p, v), l2(p, w), l2(v, w)});
      if (area * area < kThinnest * kThinnest * longest) return false;
    }
    return true;
  }

  bool try_at(const Quadric& q, Point p, bool fixed) {
    if (!well_shaped(p)) return false;
    const HeightInterval z = all_.envelope_.heights_for(star_, p);
    if (z.empty()) return false;
    if (fixed) {
      if (p.z < z.low || p.z > z.high) return false;
    } else {
      p.z = std::clamp(q.best_height(p.x, p.y), z.low, z.high);
    }
    commit(p);
    return true;
  }

  void commit(const Point& p) {
    const std::int32_t a = star_.a;
    if (!stays(a)) {
      mesh_.move(a, static_cast<std::int32_t>(std::lround(p.x * kStepsPerCell)),
                 static_cast<std::int32_t>(std::lround(p.y * kStepsPerCell)), p.z);
    }
    mesh_.collapse(star_.corner, a);
    ++all_.moves_[at(a)];
    faces_gone_ += star_.right < 0 ? 1 : 2;
    all_.changed_[at(a)] = 1;
    for (int i = 0; i < star_.size; ++i) {
      const std::int32_t v = star_.ring[at(i)];
      if (all_.tile_of_[at(v)] == tile_) all_.changed_[at(v)] = 1;
    }
    push_edges_of(a, false);
  }

  Decimation& all_;
  PlanMesh& mesh_;
  std::int32_t tile_;
  double cost_limit_;
  std::size_t most_faces_, faces_gone_ = 0;
  std::vector<Edge> queue_;
  std::vector<std::int32_t> late_;
  EdgeStar star_, other_star_;
};

Decimation::Decimation(PlanMesh& mesh, const Envelope& envelope)
    : mesh_(mesh),
      envelope_(envelope),
      moves_(mesh.vertices(), 0),
      changed_(mesh.vertices(), 1),
      frozen_(mesh.vertices(), 0),
      tile_of_(mesh.vertices(), 0) {}

std::size_t Decimation::pass(const PassPlan& plan, const Workers& workers, Progress& progress) {
  // Which tile each vertex is in, and who stays.
  std::int32_t tiles_x = 0, tiles_y = 0;
  const auto count = static_cast<std::int32_t>(mesh_.vertices());
  std::vector<std::int32_t> tx(at(count), 0);
  const auto tile_at = [&](std::int32_t step, int shift) {
    return (step / kStepsPerCell + shift) / plan.tile;
  };
  for (std::int32_t v = 0; v < count; ++v) {
    if (mesh_.corner_of(v) == PlanMesh::kNone) continue;
    tiles_x = std::max(tiles_x, tile_at(mesh_.step_x(v), plan.shift_x) + 1);
    tiles_y = std::max(tiles_y, tile_at(mesh_.step_y(v), plan.shift_y) + 1);
  }
  std::vector<std::int32_t> begin(at(tiles_x * tiles_y) + 1, 0);
  for (std::int32_t v = 0; v < count; ++v) {
    frozen_[at(v)] = 0;
    if (mesh_.corner_of(v) == PlanMesh::kNone) continue;
    const std::int32_t tile =
        tile_at(mesh_.step_y(v), plan.shift_y) * tiles_x + tile_at(mesh_.step_x(v), plan.shift_x);
    tile_of_[at(v)] = tile;
    ++begin[at(tile) + 1];
  }
  for (std::size_t t = 1; t < begin.size(); ++t) begin[t] += begin[t - 1];
  std::vector<std::int32_t> members(at(begin.back()));
  std::vector<std::int32_t> fill = begin;
  for (std::int32_t v = 0; v < count; ++v) {
    if (mesh_.corner_of(v) != PlanMesh::kNone) members[at(fill[at(tile_of_[at(v)])]++)] = v;
  }
  for (std::int32_t t = 0; at(t) < mesh_.triangles(); ++t) {
    if (!mesh_.alive(t)) continue;
    const std::int32_t a = mesh_.vertex(3 * t), b = mesh_.vertex(3 * t + 1), c = mesh_.vertex(3 * t + 2);
    if (tile_of_[at(a)] != tile_of_[at(b)] || tile_of_[at(a)] != tile_of_[at(c)]) {
      frozen_[at(a)] = frozen_[at(b)] = frozen_[at(c)] = 1;
    }
  }
  std::atomic<std::size_t> gone = 0;
  workers.for_each(begin.size() - 1, [&](std::size_t t) {
    TileDecimation tile(*this, static_cast<std::int32_t>(t), plan);
    gone += tile.run({members.data() + begin[t], at(begin[t + 1] - begin[t])}, progress);
  });
  return gone;
}

}  // namespace sightbound
