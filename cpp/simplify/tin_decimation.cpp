// SPDX-License-Identifier: GPL-3.0-or-later
// An edge is tried once in a pass, with up to four places for the new vertex: the quadrics' optimum, the
// middle, the ends; the cheapest that is allowed is made. Cheap tests come first (topology, shape), the
// permission grid last.
#include "simplify/tin_decimation.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "simplify/simplify_tin.h"
#include "terrain/exact_planes.h"

namespace sightbound {

namespace {

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

// Height over longest edge, of faces made; those of the original may be thinner.
constexpr double kThinnest = 0.01;

// Of edges that cost nothing the shortest goes first, as if places were wrong by 1e-9 of its length: faces on
// a flat then grow alike, where one vertex would draw all others to it, with more under its faces each time.
constexpr double kShortFirst = 1e-18;

// An edge with more faces around waits until there are fewer: at a hub of n faces its n edges would take n^2.
constexpr std::int32_t kMostAround = 1000;

Xyz normal_of(const std::array<Xyz, 3>& p) { return cross(p[1] - p[0], p[2] - p[0]); }

double longest2(const std::array<Xyz, 3>& p) {
  const Xyz ab = p[1] - p[0], bc = p[2] - p[1], ca = p[0] - p[2];
  return std::max({dot(ab, ab), dot(bc, bc), dot(ca, ca)});
}

std::array<Xyz, 3> in_plan(std::array<Xyz, 3> p) {
  for (Xyz& corner : p) corner.z = 0;
  return p;
}

double thickness(const std::array<Xyz, 3>& p) { return length(normal_of(p)) / longest2(p); }

}  // namespace

TinDecimation::TinDecimation(TinMesh& mesh, TinLines& lines, Containment& containment, bool in_plan)
    : mesh_(mesh),
      lines_(lines),
      containment_(containment),
      in_plan_(in_plan),
      quadrics_(at(mesh.vertices())),
      changes_(at(mesh.vertices())),
      worth_(at(mesh.vertices()), 1) {
  add_quadrics();
}

// The planes of all faces, by a third of their area for each corner; and for edges of the outline upright
// planes through them, so that what lies behind is not drawn away from it.
void TinDecimation::add_quadrics() {
  for (std::int32_t f = 0; f < mesh_.faces(); ++f) {
    const std::array<Xyz, 3> p = corners(f);
    const Xyz normal = normal_of(p);
    const double size = length(normal);
    const Xyz unit = (1 / size) * normal;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t v = mesh_.face(f)[i], w = mesh_.face(f)[(i + 1) % 3];
      quadrics_[at(v)].add_plane(unit, {}, size / 6);
      if (lines_.edge(v, w) != TinEdgeKind::kOutline) continue;
      const Xyz edge = p[(i + 1) % 3] - p[i], aside = cross(edge, unit);
      for (const std::int32_t end : {v, w})
        quadrics_[at(end)].add_plane((1 / length(aside)) * aside, {}, dot(edge, edge));
    }
  }
}

std::array<Xyz, 3> TinDecimation::corners(std::int32_t face) const {
  const Face& f = mesh_.face(face);
  return {mesh_.place(f[0]), mesh_.place(f[1]), mesh_.place(f[2])};
}

bool TinDecimation::between_lines(std::int32_t a, std::int32_t b) const {
  return lines_.kind(a) != TinVertexKind::kInside && lines_.kind(b) != TinVertexKind::kInside;
}

double TinDecimation::cost(const Collapse& c) const {
  return std::max(0.0, quadrics_[at(c.gone)].cost(c.to - mesh_.place(c.gone)) +
                           quadrics_[at(c.kept)].cost(c.to - mesh_.place(c.kept)));
}

std::vector<TinDecimation::Collapse> TinDecimation::candidates(std::int32_t a, std::int32_t b) const {
  const TinVertexKind of_a = lines_.kind(a), of_b = lines_.kind(b);
  std::vector<Collapse> all;
  if (of_a == TinVertexKind::kInside && of_b == TinVertexKind::kInside) {
    const Xyz &from = mesh_.place(a), &to = mesh_.place(b), half = 0.5 * (to - from);
    TinQuadric both = quadrics_[at(a)].moved(half);
    both.add(quadrics_[at(b)].moved(-1 * half));
    const Xyz middle = from + half;
    all = {{a, b, middle + both.optimum({})}, {a, b, middle}, {a, b, to}, {b, a, from}};
  } else {
    for (const auto& [gone, kept] : {std::pair(a, b), std::pair(b, a)}) {
      const TinVertexKind kind = lines_.kind(gone);
      const bool goes = kind == TinVertexKind::kInside
                            ? lines_.kind(kept) != TinVertexKind::kInside
                            : kind != TinVertexKind::kFixed && lines_.edge(gone, kept) != TinEdgeKind::kNone;
      if (goes) all.push_back({gone, kept, mesh_.place(kept)});
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [this](const Collapse& one, const Collapse& other) { return cost(one) < cost(other); });
  return all;
}

void TinDecimation::push(std::int32_t a, std::int32_t b) {
  const std::vector<Collapse> all = candidates(a, b);
  if (all.empty()) return;
  const Xyz along = mesh_.place(b) - mesh_.place(a);
  const double order = cost(all.front()) + kShortFirst * dot(along, along) * dot(along, along);
  queue_.push(static_cast<float>(order), {a, b, changes_[at(a)], changes_[at(b)]});
}

std::size_t TinDecimation::pass(const std::function<bool()>& enough, double share, Progress& progress) {
  std::size_t edges = 0;
  for (std::int32_t f = 0; f < mesh_.faces(); ++f) {
    if (f % 4096 == 0) progress.check();
    if (!mesh_.alive(f)) continue;
    const Face face = mesh_.face(f);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t a = face[i], b = face[(i + 1) % 3];
      if (!(worth_[at(a)] || worth_[at(b)])) continue;
      // Of the two faces at an edge one has it the other way round.
      const TinEdgeKind line = between_lines(a, b) ? lines_.edge(a, b) : TinEdgeKind::kNone;
      if (line != TinEdgeKind::kOutline && (a > b || (line == TinEdgeKind::kNone && between_lines(a, b))))
        continue;
      push(a, b);
      ++edges;
    }
  }
  std::fill(worth_.begin(), worth_.end(), std::uint8_t{0});
  const std::size_t before = mesh_.count_faces();
  const double each = share / static_cast<double>(std::max<std::size_t>(edges, 1));
  Edge edge;
  for (std::size_t tried = 0; !enough() && queue_.pop(edge); ++tried) {
    if (tried % 64 == 0) progress.check();
    if (edge.change_a != changes_[at(edge.a)] || edge.change_b != changes_[at(edge.b)]) continue;
    if (tried < edges) progress.advance(each);
    try_edge(edge.a, edge.b);
  }
  while (queue_.pop(edge)) {
  }
  return before - mesh_.count_faces();
}

bool TinDecimation::try_edge(std::int32_t a, std::int32_t b) {
  if (mesh_.faces_around(a) + mesh_.faces_around(b) > kMostAround) return false;
  look_around(a, b);
  if (!topology_stays()) return false;
  for (const Collapse& collapse : candidates(a, b)) {
    if (make_if_allowed(collapse)) return true;
  }
  return false;
}

void TinDecimation::look_around(std::int32_t a, std::int32_t b) {
  a_ = a;
  b_ = b;
  for (auto* list : {&star_.a, &star_.b, &star_.both, &star_.ring_a, &star_.ring_b}) list->clear();
  const auto walk = [&](std::int32_t v, std::int32_t other, std::vector<std::int32_t>& faces,
                        std::vector<std::int32_t>& ring) {
    mesh_.for_each_face(v, [&](std::int32_t f, std::int32_t c) {
      const std::array<std::int32_t, 2> ends{mesh_.face(f)[at((c + 1) % 3)], mesh_.face(f)[at((c + 2) % 3)]};
      const bool shared = ends[0] == other || ends[1] == other;
      if (!shared) faces.push_back(f);
      if (shared && v == a_) star_.both.push_back(f);
      for (const std::int32_t end : ends) {
        if (end != other) ring.push_back(end);
      }
    });
    std::sort(ring.begin(), ring.end());
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  };
  walk(a, b, star_.a, star_.ring_a);
  walk(b, a, star_.b, star_.ring_b);
}

// The link condition (Dey, Edelsbrunner, Guha and Nekhayev 1999): a and b have no neighbour in common but
// across the edge's own faces, and no edge of the ring either. The outline counts as one more neighbour of
// all its vertices, and lines are drawn together along themselves only.
bool TinDecimation::topology_stays() const {
  if (star_.both.empty() || star_.both.size() > 2) return false;
  std::vector<std::int32_t> common;
  std::set_intersection(star_.ring_a.begin(), star_.ring_a.end(), star_.ring_b.begin(), star_.ring_b.end(),
                        std::back_inserter(common));
  if (common.size() != star_.both.size()) return false;
  if (star_.both.size() == 2) {
    if (between_lines(a_, b_) && lines_.edge(a_, b_) == TinEdgeKind::kNone) return false;
    const auto across = [&](std::int32_t f) {
      const Face& face = mesh_.face(f);
      return std::count_if(face.begin(), face.end(),
                           [&](std::int32_t v) { return v == common[0] || v == common[1]; }) == 2;
    };
    return std::none_of(star_.a.begin(), star_.a.end(), across) ||
           std::none_of(star_.b.begin(), star_.b.end(), across);
  }
  // At the outline the one face's other two edges must not both be on it.
  const auto reaches = [&](const std::vector<std::int32_t>& faces) {
    return std::any_of(faces.begin(), faces.end(), [&](std::int32_t f) {
      const Face& face = mesh_.face(f);
      return std::find(face.begin(), face.end(), common[0]) != face.end();
    });
  };
  return reaches(star_.a) || reaches(star_.b);
}

bool TinDecimation::well_shaped(const std::array<Xyz, 3>& before, const std::array<Xyz, 3>& after) const {
  if (in_plan_) {
    return turn_in_plan(after[0], after[1], after[2]) > 0 &&
           thickness(in_plan(after)) >= std::min(kThinnest, thickness(in_plan(before)));
  }
  const Xyz old = normal_of(before), made = normal_of(after);
  return dot(old, made) > kMostTurn * length(old) * length(made) &&
         thickness(after) >= std::min(kThinnest, thickness(before));
}

StarChange TinDecimation::change_of(const Collapse& c) const {
  StarChange change;
  change.gone = star_.both;
  change.to = c.to;
  change.free_height = in_plan_ && lines_.kind(c.kept) == TinVertexKind::kInside;
  const auto add = [&](const std::vector<std::int32_t>& faces, std::int32_t vertex) {
    for (const std::int32_t face : faces) {
      const Face& f = mesh_.face(face);
      const auto moved = static_cast<std::size_t>(std::find(f.begin(), f.end(), vertex) - f.begin());
      change.changed.push_back({face, corners(face), moved});
      change.changed.back().after[moved] = c.to;
    }
  };
  const bool moves = change.free_height || !(c.to == mesh_.place(c.kept));
  add(c.gone == a_ ? star_.a : star_.b, c.gone);
  if (moves) add(c.gone == a_ ? star_.b : star_.a, c.kept);
  return change;
}

bool TinDecimation::make_if_allowed(Collapse c) {
  if (lines_.kind(c.gone) != TinVertexKind::kInside && !lines_.may_go(c.gone, c.kept)) return false;
  StarChange change = change_of(c);
  for (const FaceChange& f : change.changed) {
    if (!well_shaped(corners(f.face), f.after)) return false;
  }
  if (!(c.to == mesh_.place(c.kept)) || !same_surface(c)) {
    const std::optional<Xyz> place = containment_.place(change);
    if (!place) return false;
    c.to = change.to = *place;
    for (FaceChange& f : change.changed) f.after[f.moved] = *place;
  }
  containment_.made(change);
  make(c);
  return true;
}

// All faces around what goes lie in the planes of the faces at the edge and look the same way: one plane, or
// two that meet in a straight line along the edge. Faces made have the sense of those they replace
// (well_shaped), so they cover the same places. (Of faces folded back on one another some would vanish.)
bool TinDecimation::same_surface(const Collapse& c) const {
  const auto in_plane_of = [this](std::int32_t face, std::int32_t plane) {
    const std::array<Xyz, 3> p = corners(face), q = corners(plane);
    return dot(normal_of(p), normal_of(q)) > 0 &&
           std::all_of(p.begin(), p.end(), [&](const Xyz& at) { return in_one_plane(q[0], q[1], q[2], at); });
  };
  // Every face around, those at the edge too, is in the plane of one of these.
  std::vector<std::int32_t> around = c.gone == a_ ? star_.a : star_.b;
  around.insert(around.end(), star_.both.begin(), star_.both.end());
  const std::int32_t first = star_.both.front(), second = star_.both.back();
  const auto in_first = [&](std::int32_t f) { return in_plane_of(f, first); };
  if (std::all_of(around.begin(), around.end(), in_first)) {
    if (lines_.kind(c.gone) != TinVertexKind::kOutline) return true;
    const std::int32_t other = lines_.other_neighbour(c.gone, c.kept);  // the outline must be straight
    return on_one_line(mesh_.place(other), mesh_.place(c.gone), mesh_.place(c.kept));
  }
  const std::array<Xyz, 3> p = corners(first), q = corners(second);
  const bool folded =
      std::all_of(q.begin(), q.end(), [&](const Xyz& at) { return in_one_plane(p[0], p[1], p[2], at); });
  return first != second && !folded && std::all_of(around.begin(), around.end(), [&](std::int32_t f) {
           return in_first(f) || in_plane_of(f, second);
         });
}

void TinDecimation::make(const Collapse& c) {
  const TinQuadric of_gone = quadrics_[at(c.gone)].moved(c.to - mesh_.place(c.gone));
  TinQuadric& kept = quadrics_[at(c.kept)];
  kept = kept.moved(c.to - mesh_.place(c.kept));
  kept.add(of_gone);
  if (lines_.kind(c.gone) != TinVertexKind::kInside) lines_.went(c.gone, c.kept);
  mesh_.collapse(c.gone, c.kept, c.to);
  ++changes_[at(c.gone)];
  ++changes_[at(c.kept)];
  worth_[at(c.kept)] = 1;
  std::vector<std::int32_t> ring;
  std::set_union(star_.ring_a.begin(), star_.ring_a.end(), star_.ring_b.begin(), star_.ring_b.end(),
                 std::back_inserter(ring));
  for (const std::int32_t v : ring) {
    worth_[at(v)] = 1;
    push(c.kept, v);
  }
}

}  // namespace sightbound
