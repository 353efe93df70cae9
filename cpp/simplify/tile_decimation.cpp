// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/tile_decimation.h"

namespace sightbound {

namespace {

constexpr std::size_t kCheckEvery = 128;  // edges or vertices

// f(corner, w) for each neighbour w of v; the corner is at one of the two, its next at the other.
template <class F>
void for_each_edge(const PlanMesh& mesh, std::int32_t v, const F& f) {
  const std::int32_t first = mesh.first_corner(v);
  for (std::int32_t corner = first;;) {
    f(corner, mesh.vertex(PlanMesh::next(corner)));
    const std::int32_t after = mesh.counterclockwise(corner);
    if (after == PlanMesh::kNone) {
      f(PlanMesh::previous(corner), mesh.vertex(PlanMesh::previous(corner)));
      return;
    }
    if (after == first) return;
    corner = after;
  }
}

}  // namespace

void TileDecimation::relax(std::span<const std::int32_t> vertices, Progress& progress) {
  for (std::size_t n = 0; n < vertices.size(); ++n) {
    if (n % kCheckEvery == 0) progress.check();
    move_to_room(vertices[n]);
  }
}

std::size_t TileDecimation::run(std::span<const std::int32_t> vertices, std::size_t most_collapses,
                                Progress& progress) {
  for (const std::int32_t v : vertices) {
    index_outline(v);
    push_untested_edges(v);
  }
  Edge edge{};
  for (std::size_t n = 0; collapses_ < most_collapses && pop(edge); ++n) {
    if (n % kCheckEvery == 0) progress.check();
    try_collapse(corner_of(edge));
  }
  keep_untested();
  return faces_gone_;
}

std::vector<std::uint32_t> TileDecimation::count_costs(std::span<const std::int32_t> vertices,
                                                       Progress& progress) {
  progress.check();
  for (const std::int32_t v : vertices) push_untested_edges(v);
  std::vector<std::uint32_t> edges;
  for (std::size_t n = 0; n < kCostClasses; ++n) edges.push_back(static_cast<std::uint32_t>(queue_.size(n)));
  return edges;
}

// What the queue holds still is for the next pass.
void TileDecimation::keep_untested() {
  queue_.for_each([&](const Edge& edge) {
    if (up_to_date(edge)) state(edge.a).changed = state(edge.b).changed = all_.pass_;
  });
}

void TileDecimation::move_to_room(std::int32_t v) {
  if (stays(v) || mesh_.kind(v) != VertexKind::kInside || !gather_around(mesh_, v, star_)) return;
  const auto place = find_room(envelope_, star_);
  if (!place) return;
  mesh_.move(v, *place);
  Quadric& quadric = all_.quadrics_[at(v)];
  quadric = QuadricSum(quadric, star_.place_a, {}, star_.place_a).seen_from(*place);
  has_changed(v);
}

// `v` and all vertices of the star's ring.
void TileDecimation::has_changed(std::int32_t v) {
  state(v).changed = all_.pass_;
  for (int i = 0; i < star_.size; ++i) {
    const std::int32_t w = star_.ring[at(i)];
    if (in_tile(w)) state(w).changed = all_.pass_;
  }
}

void TileDecimation::push_untested_edges(std::int32_t v) {
  const auto untested = [&](std::int32_t u) { return state(u).changed + 1 >= all_.pass_; };
  for_each_edge(mesh_, v, [&](std::int32_t corner, std::int32_t w) {
    if (v < w && in_tile(w) && (untested(v) || untested(w))) push(corner, v, w);
  });
}

void TileDecimation::push_all_edges(std::int32_t v) {
  for_each_edge(mesh_, v, [&](std::int32_t corner, std::int32_t w) { push(corner, v, w); });
}

void TileDecimation::push(std::int32_t corner, std::int32_t v, std::int32_t w) {
  if (!in_tile(w) || (stays(v) && stays(w))) return;
  const bool outline_edge = mesh_.opposite(PlanMesh::previous(corner)) == PlanMesh::kNone;
  const std::int32_t a = mesh_.kind(w) > mesh_.kind(v) || stays(w) ? w : v;
  const QuadricSum quadric = quadrics(v, w);
  const Freedom free = freedom(a, outline_edge);
  const double cost = [&] {
    if (free == Freedom::kPlane) return quadric.cost(quadric.optimum());
    const Point p = mesh_.place(a), q = mesh_.place(a == v ? w : v);
    const double t = free == Freedom::kLine ? 0.5 : 0, x = p.x + t * (q.x - p.x), y = p.y + t * (q.y - p.y);
    return quadric.cost({x, y, quadric.best_height(x, y)});
  }();
  const double tolerance = envelope_.tolerance_near(mesh_.place(a));
  queue_.push(static_cast<float>(cost / (tolerance * tolerance)),
              {v, w, corner, state(v).moves + state(w).moves});
}

// The cheapest edge that still is what it was.
bool TileDecimation::pop(Edge& edge) {
  while (queue_.pop(edge, plan_.cost_classes)) {
    if (up_to_date(edge)) return true;
  }
  return false;
}

bool TileDecimation::up_to_date(const Edge& edge) {
  return mesh_.corner_of(edge.a) != PlanMesh::kNone && mesh_.corner_of(edge.b) != PlanMesh::kNone &&
         state(edge.a).moves + state(edge.b).moves == edge.moves;
}

QuadricSum TileDecimation::quadrics(std::int32_t v, std::int32_t w) {
  return {all_.quadrics_[at(v)], mesh_.place(v), all_.quadrics_[at(w)], mesh_.place(w)};
}

// `a` being the end of the higher kind, or the one that stays.
Freedom TileDecimation::freedom(std::int32_t a, bool outline_edge) {
  if (stays(a)) return Freedom::kNone;
  if (mesh_.kind(a) == VertexKind::kInside) return Freedom::kPlane;
  return mesh_.kind(a) == VertexKind::kOutline && outline_edge ? Freedom::kLine : Freedom::kHeight;
}

std::int32_t TileDecimation::corner_of(const Edge& edge) const {
  const std::int32_t one = mesh_.vertex(edge.corner);
  if (one == edge.a || one == edge.b) {
    const std::int32_t next = mesh_.vertex(PlanMesh::next(edge.corner));
    if (next == (one == edge.a ? edge.b : edge.a)) return edge.corner;
  }
  return mesh_.edge(edge.a, edge.b);
}

void TileDecimation::try_collapse(std::int32_t corner) {
  if (corner == PlanMesh::kNone) return;
  const std::int32_t one = mesh_.vertex(corner), other = mesh_.vertex(PlanMesh::next(corner));
  if (try_collapse_of(corner, stays(other))) return;
  // On a line it matters which of two alike goes: neither moves.
  const bool alike = mesh_.kind(one) == VertexKind::kOnLine && mesh_.kind(other) == VertexKind::kOnLine;
  if (alike && !stays(other)) try_collapse_of(corner, true);
}

bool TileDecimation::try_collapse_of(std::int32_t corner, bool next_stays) {
  if (!gather(mesh_, corner, next_stays, star_) || stays(star_.b)) return false;
  std::optional<LineRules::Edge> edge;
  if (mesh_.kind(star_.b) == VertexKind::kOnLine) {
    edge = line_without_b();
    if (!edge) return false;
  }
  const QuadricSum quadric = quadrics(star_.a, star_.b);
  const auto place =
      find_place(envelope_, star_, quadric, freedom(star_.a, star_.right < 0), edge && edge->advances);
  if (!place) return false;
  const std::int32_t a = star_.a;
  collapse(*place, quadric);
  if (edge) mesh_.set_line(PlanMesh::previous(mesh_.edge(a, edge->to)), edge->state);
  return true;
}

// Tiles do not see each other: the outline advances within its own.
std::optional<LineRules::Edge> TileDecimation::line_without_b() {
  const auto edge = plan_.lines.without_b(mesh_, star_);
  if (!edge || !edge->advances) return edge;
  const bool room = in_tile(edge->to) && !outline_.any_in(mesh_, star_.a, star_.b, edge->to);
  return room ? edge : std::nullopt;
}

void TileDecimation::index_outline(std::int32_t v) {
  if (plan_.lines.outline_moves() && mesh_.on_outline(mesh_.first_corner(v))) outline_.add(v, mesh_.place(v));
}

void TileDecimation::collapse(const Point& to, const QuadricSum& quadric) {
  const std::int32_t a = star_.a;
  if (!stays(a)) mesh_.move(a, to);
  if (mesh_.kind(a) == VertexKind::kOutline) index_outline(a);  // others stay in their places
  mesh_.collapse(star_.corner, a);
  faces_gone_ += star_.right < 0 ? 1 : 2;
  ++collapses_;
  all_.quadrics_[at(a)] = quadric.seen_from(to);
  ++state(a).moves;
  has_changed(a);
  push_all_edges(a);
}

}  // namespace sightbound
