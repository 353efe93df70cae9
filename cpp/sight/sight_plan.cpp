// SPDX-License-Identifier: GPL-3.0-or-later
//   s      distance along the ground, metres
//   rise   (height - eye) / s - bend s / 2R: the slope of a line of sight to there, over the curved ground
#include "sight/sight_plan.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "sight/vector.h"

namespace sightbound {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

std::size_t at(int i) { return static_cast<std::size_t>(i); }
std::uint32_t count(const auto& list) { return static_cast<std::uint32_t>(list.size()); }

class Writer {
 public:
  Writer(const BoundedMarch& march, const RayFan& fan, const RealisedColumns& columns, const FineGround& fine,
         const Refinement& refinement)
      : march_(march),
        fan_(fan),
        columns_(columns),
        fine_(fine),
        refinement_(refinement),
        stride_(std::bit_ceil(static_cast<unsigned>(march.widest() / 2 + 2))),
        held_(8 * static_cast<std::size_t>(stride_), {kNowhere, kNowhere}),
        places_(at(fan.rays()), fan.eye()) {
    plan_.steps = fine.steps();
    plan_.rays = fan.rays();
    plan_.slots = 8 * stride_;
  }

  SightPlan write(const std::function<std::uint32_t(int row, int col)>& item_of) {
    auto target = march_.targets().begin();
    for (int line = 0; line < fan_.lines(); ++line) {
      bool any = march_.any_may_decide(line);
      for (; target != march_.targets().end() && target->line == line; ++target) {
        if (target->open == 0) continue;
        add(*target, item_of(target->row, target->col));
        any = true;
      }
      if (!any) continue;
      for (int i = 0; i < fan_.rays(); ++i) {
        if (march_.may_decide(line, i)) add_crossing(line, i);
      }
      plan_.lines.push_back({count(plan_.samples), count(plan_.nodes), count(plan_.targets),
                             count(plan_.rows), count(plan_.crossings)});
    }
    return std::move(plan_);
  }

 private:
  void add(const BoundedMarch::Target& target, std::uint32_t item) {
    const double s = fan_.distance(target.ray, target.line), per_2r = fan_.per_2r(target.ray);
    const RayPlace place{0.5 * fan_.major(target.line), static_cast<double>(target.minor), s};
    const auto ray = static_cast<std::uint32_t>(target.ray);
    plan_.targets.push_back({ray_slope(s, per_2r), node(target.line, 2 * target.minor), ray,
                             add_fine(places_[ray], place, per_2r, refinement_.at_target), item, target.open,
                             refinement_.at_target, target.behind_unknown});
  }

  void add_crossing(int line, int i) {
    const double minor = fan_.minor(i, line), per_2r = fan_.per_2r(i);
    const int before = fan_.node_before(minor);
    const RayPlace place = fan_.crossing(i, line, minor);
    const auto ray = static_cast<std::uint32_t>(i);
    const double minor_before = line > 0 ? fan_.minor(i, line - 1) : 0;
    if (line > 0 && fan_.is_inside(minor_before)) {
      if (const auto row = row_between(fan_.crossing(i, line - 1, minor_before), place))
        plan_.rows.push_back(between_nodes(row->place, {kNodeStep, 0}, row->part, node(line - 1, row->node),
                                           node(line, row->node), ray));
    }
    const Fineness fineness = refinement_.from_eye(line);
    SightPlan::Crossing crossing{between_nodes(place, {0, kNodeStep}, 2 * minor - before, node(line, before),
                                               node(line, fan_.node_behind(minor)), ray),
                                 add_fine(places_[at(i)], place, per_2r, fineness), fineness};
    plan_.crossings.push_back(crossing);
    places_[at(i)] = place;
  }

  SightPlan::Place between_nodes(const RayPlace& place, const NodeStep& step, double part, SightPlan::Slot a,
                                 SightPlan::Slot b, std::uint32_t ray) const {
    return {ray_slope(place.s, fan_.per_2r(static_cast<int>(ray))),
            static_cast<float>(part),
            fine_.across(place, step, part),
            a,
            b,
            ray};
  }

  std::uint32_t add_fine(const RayPlace& a, const RayPlace& b, double per_2r, Fineness fineness) {
    const std::uint32_t first = count(plan_.fine);
    FinePlaces places;
    fine_.between(a, b, per_2r, fineness, places);
    plan_.fine.insert(plan_.fine.end(), places, places + static_cast<int>(fineness));
    return first;
  }

  // What a slot holds: half cells.
  using Place = std::pair<int, int>;
  bool takes(SightPlan::Slot slot, const Place& place) { return std::exchange(held_[slot], place) != place; }

  // Samples of even and odd lines of samples have slots of their own, for a line of nodes lies between two;
  // so have centres of squares, for it has two beside it.
  SightPlan::Slot sample(int major, int minor) {
    const SightPlan::Slot slot = (unsigned(major) % 2) * stride_ + unsigned(minor) % stride_;
    if (takes(slot, {2 * major, 2 * minor})) plan_.samples.push_back({columns_.sample(major, minor), slot});
    return slot;
  }

  SightPlan::Slot centre(int major, int minor) {
    const unsigned line = unsigned((major + 1) / 2), place = unsigned((minor + 1) / 2);
    const SightPlan::Slot slot = (2 + line % 2) * stride_ + place % stride_;
    if (takes(slot, {major, minor})) plan_.samples.push_back({columns_.centre(major, minor), slot});
    return slot;
  }

  SightPlan::Slot node(int line, int half_cells) {
    const int major = fan_.grid_major(fan_.major(line)), minor = fan_.grid_minor(half_cells);
    SightPlan::Node made{columns_.node_of(
                             major, minor, [&](int m, int n) { return sample(m, n); },
                             [&](int m, int n) { return centre(m, n); }),
                         0};
    if (made.is_sample) return made.a;
    made.slot = (4 + 2 * (unsigned(major) % 2)) * stride_ + unsigned(minor) % (2 * stride_);
    if (takes(made.slot, {major, minor})) plan_.nodes.push_back(made);
    return made.slot;
  }

  const BoundedMarch& march_;
  const RayFan& fan_;
  const RealisedColumns& columns_;
  const FineGround& fine_;
  const Refinement refinement_;
  SightPlan plan_;
  static constexpr int kNowhere = std::numeric_limits<int>::min();
  const unsigned stride_;
  std::vector<Place> held_;       // by the slots
  std::vector<RayPlace> places_;  // of the rays
};

SIGHTBOUND_INLINE void raise(const Lanes& ground, const Lanes& eye, const RaySlope& slope, Lanes& horizon) {
  for (int l = 0; l < kLanes; ++l) {
    const float rise = (ground.v[l] - eye.v[l]) * slope.per_s - slope.drop;
    horizon.v[l] = larger(rise, horizon.v[l]);  // what is not known (NaN) raises nothing
  }
}

// By what lies between two places.
SIGHTBOUND_INLINE void raise_between(const FinePlace* places, Fineness fineness, const StepLaw& steps,
                                     std::uint32_t first, const Lanes& a, const Lanes& b, const Lanes& eye,
                                     Lanes& horizon) {
  if (fineness == Fineness::kNone) return;
  Lanes half, quarter;
  draw_on_way(places[0].draw, steps, first, a, b, 0.5f, half);
  raise(half, eye, places[0].slope, horizon);
  if (fineness == Fineness::kHalves) return;
  draw_on_way(places[1].draw, steps, first, a, half, 0.5f, quarter);
  raise(quarter, eye, places[1].slope, horizon);
  draw_on_way(places[2].draw, steps, first, half, b, 0.5f, quarter);
  raise(quarter, eye, places[2].slope, horizon);
}

SIGHTBOUND_INLINE std::uint16_t seen_over(const Lanes& horizon, const Lanes& ground, float height,
                                          const Lanes& eye, const RaySlope& slope) {
  std::uint32_t bits = 0;
  for (int l = 0; l < kLanes; ++l) {
    const float rise = (ground.v[l] + height - eye.v[l]) * slope.per_s - slope.drop;
    bits |= rise >= horizon.v[l] ? 1u << l : 0u;
  }
  return static_cast<std::uint16_t>(bits);
}

struct Working {
  Lanes *slots, *horizons, *places;
};

SIGHTBOUND_VECTOR
void carry_out(const SightPlan& plan, const Lanes& eye, const float* heights, std::uint32_t first,
               std::uint16_t open_holes, const Working& work, const SeenBits& seen) {
  SightPlan::Line from{0, 0, 0, 0, 0};
  for (const SightPlan::Line& to : plan.lines) {
    for (; from.samples < to.samples; ++from.samples) {
      const SightPlan::Sample& sample = plan.samples[from.samples];
      draw(sample.draw, first, work.slots[sample.slot]);
    }
    for (; from.nodes < to.nodes; ++from.nodes) {
      const SightPlan::Node& node = plan.nodes[from.nodes];
      const Lanes* of = work.slots;
      draw(node.draw, first, {of[node.a], of[node.b], of[node.c], of[node.d], of[node.e], of[node.f]},
           work.slots[node.slot]);
    }
    for (; from.targets < to.targets; ++from.targets) {
      const SightPlan::Target& target = plan.targets[from.targets];
      const Lanes &ground = work.slots[target.ground], &before = work.horizons[target.ray];
      float highest = -kInfinity;
      for (unsigned layers = target.layers; layers != 0; layers &= layers - 1)
        highest = larger(heights[std::countr_zero(layers)], highest);
      if (seen_over(before, ground, highest, eye, target.slope) == 0) continue;
      Lanes horizon = before;
      raise_between(plan.fine.data() + target.fine, target.fineness, plan.steps, first,
                    work.places[target.ray], ground, eye, horizon);
      for (unsigned layers = target.layers; layers != 0; layers &= layers - 1) {
        const int l = std::countr_zero(layers);
        std::uint16_t& bits = seen.bits[(target.item + static_cast<std::size_t>(l)) * seen.stride];
        const unsigned over = seen_over(horizon, ground, heights[l], eye, target.slope);
        bits = static_cast<std::uint16_t>(bits | (target.behind_unknown ? over & open_holes : over));
      }
    }
    for (; from.rows < to.rows; ++from.rows) {
      const SightPlan::Place& row = plan.rows[from.rows];
      Lanes ground;
      draw_on_way(row.across, plan.steps, first, work.slots[row.a], work.slots[row.b], row.part, ground);
      raise(ground, eye, row.slope, work.horizons[row.ray]);
    }
    for (; from.crossings < to.crossings; ++from.crossings) {
      const SightPlan::Crossing& crossing = plan.crossings[from.crossings];
      Lanes ground, &horizon = work.horizons[crossing.ray], &place = work.places[crossing.ray];
      draw_on_way(crossing.across, plan.steps, first, work.slots[crossing.a], work.slots[crossing.b],
                  crossing.part, ground);
      raise_between(plan.fine.data() + crossing.fine, crossing.fineness, plan.steps, first, place, ground,
                    eye, horizon);
      raise(ground, eye, crossing.slope, horizon);
      place = ground;
    }
  }
}

}  // namespace

SightPlan write_plan(const BoundedMarch& march, const RayFan& fan, const RealisedColumns& columns,
                     const FineGround& fine, const Refinement& refinement,
                     const std::function<std::uint32_t(int row, int col)>& item_of) {
  return Writer(march, fan, columns, fine, refinement).write(item_of);
}

void PlanRunner::run(const SightPlan& plan, const SixteenEyes& eyes, const std::vector<float>& heights,
                     std::uint32_t first, std::uint16_t open_holes, const SeenBits& seen) {
  Lanes low;
  std::fill_n(low.v, kLanes, -kInfinity);
  slots_.resize(plan.slots);
  horizons_.assign(at(plan.rays), low);
  places_.assign(at(plan.rays), eyes.ground);
  carry_out(plan, eyes.eye, heights.data(), first, open_holes,
            {slots_.data(), horizons_.data(), places_.data()}, seen);
}

}  // namespace sightbound
