// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/placement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "simplify/coplanar.h"

namespace sightbound {

namespace {

// Where more than this part of the tolerance is missing, a search rarely finds a place
// (docs/algorithms/simplify.md).
constexpr double kReach = 1;

// A descent, by steps along columns and rows that are halved when none helps.
struct Steps {
  double first;  // of the edge's length, or of the mean length of the edges around
  double last;   // cells
  int most_visits;
};
constexpr Steps kSearchSteps{0.3, 1.0 / 256, 40};
constexpr Steps kRoomSteps{0.1, 1.0 / 64, 12};
constexpr double kLeastGain = 0.01;  // of what is missing, or of the room there is

double snapped(double v) { return std::floor(v * kStepsPerCell + 0.5) / kStepsPerCell; }

double square_of_length(const Point& a, const Point& b) {
  return (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y);
}

bool well_shaped(const EdgeStar& star, const Point& p) {
  for (int i = 0; i < star.sides(); ++i) {
    const auto n = static_cast<std::size_t>(i);
    const Point &v = star.at[n], &w = star.at[n + 1];
    const double area = area2(p, v, w);
    const double longest = std::max({square_of_length(p, v), square_of_length(p, w), square_of_length(v, w)});
    if (!(area > 0) || area * area < kThinnest * kThinnest * longest) return false;
  }
  return true;
}

// The best place seen so far: where the interval of heights is widest, or where least is missing for there to
// be one.
class Search {
 public:
  Search(const Envelope& envelope, const EdgeStar& star, double reach)
      : envelope_(envelope), star_(star), missing_(reach) {}

  // Is it better than all before?
  bool visit(double x, double y) {
    const Point p{snapped(x), snapped(y), 0};
    if (!well_shaped(star_, p)) return false;
    const double most = missing_ - kLeastGain * std::abs(missing_);
    const HeightInterval heights = envelope_.heights_for(star_, p, most);
    if (!(heights.missing() <= most)) return false;
    best_ = {p.x, p.y, 0.5 * (heights.low + heights.high)};
    missing_ = heights.missing();
    any_ = true;
    return true;
  }
  bool visit(const Point& p) { return visit(p.x, p.y); }
  bool found() const { return any_ && missing_ <= 0; }
  double room() const { return -missing_; }

  // Downhill in what is missing; until nothing is, or for as much room as can be had.
  void descend(const Steps& steps, double length, bool until_found) {
    double step = steps.first * length;
    for (int visits = 0; any_ && visits < steps.most_visits && step > steps.last;) {
      bool better = false;
      constexpr std::array<std::array<int, 2>, 4> kDirections{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
      for (const auto& d : kDirections) {
        ++visits;
        better |= visit(best_.x + d[0] * step, best_.y + d[1] * step);
        if (until_found && found()) return;
      }
      if (!better) step /= 2;
    }
  }
  std::optional<Point> result() const { return found() ? std::optional(best_) : std::nullopt; }

 private:
  const Envelope& envelope_;
  const EdgeStar& star_;
  double missing_;
  bool any_ = false;
  Point best_;
};

Point centre_of(const EdgeStar& star) {
  Point sum;
  for (int i = 0; i < star.size; ++i) {
    sum.x += star.at[static_cast<std::size_t>(i)].x;
    sum.y += star.at[static_cast<std::size_t>(i)].y;
  }
  return {sum.x / star.size, sum.y / star.size, 0};
}

// At the place of vertex a, which stays there.
std::optional<Point> place_at_a(const Envelope& envelope, const EdgeStar& star, Freedom freedom) {
  const Point& a = star.place_a;
  if (!well_shaped(star, a)) return {};
  const HeightInterval heights =
      freedom == Freedom::kHeight ? envelope.heights_for(star, a, 0) : envelope.heights_at_a(star, 0);
  if (heights.missing() > 0) return {};
  if (freedom == Freedom::kHeight) return Point{a.x, a.y, 0.5 * (heights.low + heights.high)};
  return a.z >= heights.low && a.z <= heights.high ? std::optional(a) : std::nullopt;
}

}  // namespace

std::optional<Point> find_place(const Envelope& envelope, const EdgeStar& star, const QuadricSum& quadric,
                                Freedom freedom, bool outline_advances) {
  const bool fixed = freedom == Freedom::kNone || freedom == Freedom::kHeight;
  const auto same = place_without_change(star, fixed);
  if (same && !outline_advances && well_shaped(star, *same)) return same;
  if (fixed) return place_at_a(envelope, star, freedom);
  const Point &a = star.place_a, &b = star.place_b;
  Search search(envelope, star, kReach * envelope.tolerance_near(a));
  if (freedom == Freedom::kPlane) search.visit(quadric.optimum());
  for (const Point& p : {Point{(a.x + b.x) / 2, (a.y + b.y) / 2, 0}, a, b}) {
    if (!search.found()) search.visit(p);
  }
  if (!search.found() && freedom == Freedom::kPlane) {
    search.visit(centre_of(star));
    if (!search.found()) search.descend(kSearchSteps, std::sqrt(square_of_length(a, b)), true);
  }
  return search.result();
}

std::optional<Point> find_room(const Envelope& envelope, const EdgeStar& star) {
  const Point& p = star.place_a;
  double length = 0;
  for (int i = 0; i < star.size; ++i) {
    length += std::sqrt(square_of_length(p, star.at[static_cast<std::size_t>(i)])) / star.size;
  }
  Search search(envelope, star, 0);
  if (!search.visit(p)) return {};
  search.descend(kRoomSteps, length, false);
  const auto best = search.result();
  if (!best) return {};
  const bool same = best->x == p.x && best->y == p.y && std::abs(best->z - p.z) <= kLeastGain * search.room();
  return same ? std::nullopt : best;
}

}  // namespace sightbound
