// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/bounded_march.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightbound {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

BoundedMarch::BoundedMarch(const RayFan& fan, const RealisedColumns& columns, const FineGround& fine,
                           const Refinement& refinement, const HeightRange& eye,
                           const std::vector<float>& heights)
    : fan_(fan), columns_(columns), fine_(fine), refinement_(refinement), eye_(eye), heights_(heights) {}

void BoundedMarch::run(const Wanted& wanted, const ProbableEye& eye, const std::vector<int>& last_lines) {
  const auto height = static_cast<float>(eye.height);
  horizons_.assign(at(fan_.rays()),
                   {-kInfinity, -kInfinity, fan_.eye(), {eye_.low - height, eye_.high - height}});
  peaks_.assign(at(fan_.rays()), {});
  minors_.resize(at(fan_.rays()));
  marked_.assign(at(fan_.lines()), 0);
  marks_.assign(at(fan_.lines()) * at(fan_.rays()), 0);
  const int lines = last_lines.empty() ? fan_.lines() : std::ranges::max(last_lines) + 1;
  for (int line = 0; line < lines; ++line) {
    if (!look_at(line, last_lines)) return;
    if (fan_.holds_targets(line)) ask_targets(line, wanted, eye, last_lines);
    for (int i = 0; i < fan_.rays(); ++i) {
      const bool goes_on = last_lines.empty() || line < last_lines[at(i)];
      if (goes_on && fan_.is_inside(minors_[at(i)])) cross(i, line);
    }
  }
}

// Finds where rays cross the line and the ground there; false when all have left the raster.
bool BoundedMarch::look_at(int line, const std::vector<int>& last_lines) {
  int from = std::numeric_limits<int>::max(), to = std::numeric_limits<int>::min();
  for (int i = 0; i < fan_.rays(); ++i) {
    const double minor = minors_[at(i)] = fan_.minor(i, line);
    if (!fan_.is_inside(minor) || (!last_lines.empty() && line > last_lines[at(i)])) continue;
    from = std::min(from, fan_.node_before(minor));
    to = std::max(to, fan_.node_behind(minor));
  }
  if (fan_.holds_targets(line)) {
    const RayFan::Range targets = fan_.targets(line, minors_);
    if (targets.from <= targets.to) {
      from = std::min(from, 2 * targets.from);
      to = std::max(to, 2 * targets.to);
    }
  }
  if (to < from) return !last_lines.empty();
  // Rows between two lines are one node off at most, where geodesics bow.
  from = fan_.node_inside(from - 1);
  to = fan_.node_inside(to + 1);
  widest_ = std::max(widest_, to - from + 1);
  std::swap(nodes_, nodes_before_);
  nodes_.first = from;
  columns_.ranges(fan_.grid_major(fan_.major(line)), fan_.grid_minor(from), fan_.grid_minor(to),
                  nodes_.ranges);
  return true;
}

void BoundedMarch::ask_targets(int line, const Wanted& wanted, const ProbableEye& eye,
                               const std::vector<int>& last_lines) {
  const RayFan::Range range = fan_.targets(line, minors_);
  int nearest = 0;
  for (int n = range.from; n <= range.to; ++n) {
    const auto off = [&](int i) { return std::abs(minors_[at(i)] - n); };
    while (nearest + 1 < fan_.rays() && off(nearest + 1) < off(nearest)) ++nearest;
    if (!last_lines.empty() && line > last_lines[at(nearest)]) continue;
    const int row = fan_.row_of(line, n), col = fan_.col_of(line, n);
    if (const Layers layers = wanted(row, col))
      judge({line, nearest, n, row, col, layers, 0, false}, nodes_.at(2 * n), eye);
  }
}

void BoundedMarch::judge(const Target& asked, const HeightRange& ground, const ProbableEye& eye) {
  const Horizon& horizon = horizons_[at(asked.ray)];
  const double s = fan_.distance(asked.ray, asked.line), per_2r = fan_.per_2r(asked.ray);
  const RaySlope slope = ray_slope(s, per_2r);
  Target target = asked;
  target.open = 0;
  target.behind_unknown = horizon.behind_unknown;
  float lowest = kInfinity, highest_fine = -kInfinity;
  bool fine_is_known = false;
  for (std::size_t l = 0; l < heights_.size(); ++l) {
    const auto bit = static_cast<Layers>(1u << l);
    if (!(asked.open & bit)) continue;
    const HeightRange top = slope_range({ground.low + heights_[l], ground.high + heights_[l]}, eye_, slope);
    if (!(top.high >= horizon.low)) continue;
    if (top.low >= horizon.high && !fine_is_known && refinement_.at_target != Fineness::kNone) {
      FinePlaces places;
      const RayPlace place{0.5 * fan_.major(asked.line), static_cast<double>(asked.minor), s};
      fine_.between(horizon.place, place, per_2r, refinement_.at_target, places);
      highest_fine = fine_.highest(places, refinement_.at_target, horizon.ground, ground, eye_);
      fine_is_known = true;
    }
    if (!horizon.behind_unknown && top.low >= std::max(horizon.high, highest_fine)) {
      target.seen |= bit;
    } else {
      target.open |= bit;
      lowest = std::min(lowest, top.low);
    }
  }
  if ((target.open | target.seen) == 0 || !eye.asks(target.row, target.col)) return;
  targets_.push_back(target);
  if (target.open == 0) return;
  keep_what_may_hide(asked.ray, lowest);
  if (refinement_.at_target != Fineness::kNone && horizon.line >= 0) mark(horizon.line, asked.ray);
}

// Of ground between two nodes.
HeightRange BoundedMarch::ground_at(const RayPlace& place, const NodeStep& step, double part,
                                    const HeightRange& a, const HeightRange& b) const {
  const auto share = static_cast<float>(part);
  const float room = fine_.most_across(place, part), rise = fine_.rise_across(place, step, part);
  return {a.low + share * (b.low - a.low) + rise - room, a.high + share * (b.high - a.high) + rise + room};
}

void BoundedMarch::cross(int ray, int line) {
  Horizon& horizon = horizons_[at(ray)];
  const double minor = minors_[at(ray)], per_2r = fan_.per_2r(ray);
  const int before = fan_.node_before(minor);
  const RayPlace place = fan_.crossing(ray, line, minor);
  const HeightRange ground = ground_at(place, {0, kNodeStep}, 2 * minor - before, nodes_.at(before),
                                       nodes_.at(fan_.node_behind(minor)));
  HeightRange rise = slope_range(ground, eye_, ray_slope(place.s, per_2r));
  if (const Fineness fineness = refinement_.from_eye(line); fineness != Fineness::kNone) {
    FinePlaces places;
    fine_.between(horizon.place, place, per_2r, fineness, places);
    rise.high = larger(fine_.highest(places, fineness, horizon.ground, ground, eye_), rise.high);
  }
  const bool is_unknown = std::isnan(rise.high);
  if (const auto row = horizon.line == line - 1 ? row_between(horizon.place, place) : std::nullopt;
      row && line > 0) {
    const HeightRange there =
        ground_at(row->place, {kNodeStep, 0}, row->part, nodes_before_.at(row->node), nodes_.at(row->node));
    const HeightRange over = slope_range(there, eye_, ray_slope(row->place.s, per_2r));
    if (is_unknown) {
      rise = over;
    } else if (!std::isnan(over.high)) {
      rise = {larger(over.low, rise.low), larger(over.high, rise.high)};
    }
  }
  horizon.place = place;
  horizon.ground = ground;
  horizon.line = line;
  horizon.behind_unknown |= is_unknown;
  if (rise.high > horizon.low) {  // not of what is unknown (NaN)
    peaks_[at(ray)].push_back({line, rise.high});
    horizon.low = std::max(horizon.low, rise.low);
    horizon.high = std::max(horizon.high, rise.high);
  }
}

// Of the peaks before an open target: who is higher than the horizon must be, and than the target may be, may
// hide it; who is below the horizon never matters again.
void BoundedMarch::keep_what_may_hide(int ray, float lowest_target) {
  const float low = horizons_[at(ray)].low;
  std::erase_if(peaks_[at(ray)], [&](const Peak& peak) {
    if (peak.high < low) return true;
    if (peak.high < lowest_target) return false;
    mark(peak.line, ray);
    return true;
  });
}

// With fine ground before it, the place before must be known too.
void BoundedMarch::mark(int line, int ray) {
  for (int l = line; l >= 0; --l) {
    std::uint8_t& known = marks_[mark_at(l, ray)];
    if (known) return;
    known = 1;
    ++marked_[at(l)];
    if (refinement_.from_eye(l) == Fineness::kNone) return;
  }
}

std::vector<int> BoundedMarch::last_lines() const {
  std::vector<int> last(at(fan_.rays()), -1);
  for (const Target& target : targets_) {
    if (target.open) last[at(target.ray)] = target.line;
  }
  return last;
}

}  // namespace sightbound
