// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/target_tile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "error_model/error_model.h"

namespace sightbound {

namespace {

double gap(double a_low, double a_high, double b_low, double b_high) {
  return std::max({a_low - b_high, b_low - a_high, 0.0});
}
double nearest_in_plan(const Box3& a, const Box3& b) {
  return std::hypot(gap(a.low.x, a.high.x, b.low.x, b.high.x), gap(a.low.y, a.high.y, b.low.y, b.high.y));
}
double farthest_in_plan(const Box3& a, const Box3& b) {
  return std::hypot(std::max(b.high.x - a.low.x, a.high.x - b.low.x),
                    std::max(b.high.y - a.low.y, a.high.y - b.low.y));
}

// One where the box is a place.
std::vector<Xyz> corners_of(const Box3& box) {
  if (box.low == box.high) return {box.low};
  std::vector<Xyz> corners;
  for (const double z : {box.low.z, box.high.z}) {
    for (const double y : {box.low.y, box.high.y}) {
      for (const double x : {box.low.x, box.high.x}) corners.push_back({x, y, z});
    }
  }
  return corners;
}

constexpr int kLeastBlock = 4;          // columns; smaller blocks are settled too seldom
constexpr double kRounding = 1e-4;      // of a ratio told from p
constexpr std::size_t kFewPlaces = 16;  // smaller boxes of views are looked at voxel by voxel

}  // namespace

template <class Visit>
void TargetTile::each_column(const Block& block, const Visit& visit) const {
  const int end_i = std::min(block.i + block.side, targets_.nx),
            end_j = std::min(block.j + block.side, targets_.ny);
  for (int j = block.j; j < end_j; ++j) {
    for (int i = block.i; i < end_i; ++i) visit(i, j);
  }
}

TargetTile::TargetTile(const TileQuestion& ask, const TargetLattice& targets, int i, int j,
                       Progress& progress)
    : ask_(ask),
      targets_(targets),
      progress_(progress),
      whole_{i, j, kSide},
      hint_(ask.views.places().size()) {
  each_column(whole_, [&](int at_i, int at_j) {
    answers_[slot(at_i, at_j)].resize(static_cast<std::size_t>(targets_.column(at_i, at_j).size()));
  });
}

void TargetTile::see() { see(whole_, {&ask_.views.root()}); }

void TargetTile::put_into(HiddenVolumeBuilder& builder) const {
  each_column(whole_, [&](int i, int j) {
    const std::vector<TargetAnswer>& answers = answers_[slot(i, j)];
    if (!answers.empty()) builder.set_column(i, j, answers);
  });
}

// The views are those nothing is proven of yet, none of their boxes much larger than the block.
void TargetTile::see(const Block& block, const std::vector<const Node*>& views) {
  Box3 targets;
  if (!box_of(block, targets)) return;
  progress_.check();
  const double side = std::max(targets.high.x - targets.low.x, targets.high.y - targets.low.y);
  std::vector<const Node*> ahead = views, open;
  while (!ahead.empty()) {
    const Node* node = ahead.back();
    ahead.pop_back();
    const std::uint8_t verdict = verdict_of_all(*node, targets);
    if (verdict == kNoVerdict) continue;
    if (verdict != kUncertain) {
      give(block, verdict);
      if (verdict == settling()) return;
    } else if (!node->is_leaf() && node->side() > side) {
      split(*node, ahead);
    } else {
      open.push_back(node);
    }
  }
  if (open.empty()) return;
  if (block.side == kLeastBlock) return each_column(block, [&](int i, int j) { see_column(i, j, open); });
  const int half = block.side / 2;
  for (const int j : {block.j, block.j + half}) {
    for (const int i : {block.i, block.i + half}) see({i, j, half}, open);
  }
}

void TargetTile::see_column(int i, int j, const std::vector<const Node*>& views) {
  const TargetColumn& column = targets_.column(i, j);
  if (column.size() == 0) return;
  progress_.check();
  EndZone target = ask_.sight.zone(targets_.centre(i, j, column.first));
  std::vector<int> all(static_cast<std::size_t>(column.size()));
  std::iota(all.begin(), all.end(), column.first);
  // Who saw the column before sees this one as a rule.
  const std::size_t hint = hint_;
  if (hint < ask_.views.places().size()) see_from(hint, i, j, all, target);
  struct Ahead {
    const Node* node;
    std::vector<int> layers;  // that it may have something to say of
  };
  std::vector<Ahead> ahead;
  for (const Node* node : views) ahead.push_back({node, all});
  while (!ahead.empty()) {
    const auto [node, layers] = std::move(ahead.back());
    ahead.pop_back();
    if (is_settled(i, j)) return;
    if (is_too_far(*node, i, j) || (node->is_leaf() && node->first == hint)) continue;
    const std::vector<int> open = unbeaten(*node, i, j, layers);
    if (open.empty()) continue;
    if (node->is_leaf()) {
      see_from(node->first, i, j, open, target);
      if (is_settled(i, j)) hint_ = node->first;
    } else {
      std::vector<const Node*> parts;
      split(*node, parts);
      for (const Node* part : parts) ahead.push_back({part, open});
    }
  }
}

// The higher part comes to its turn first: as a rule it sees more, and beats the other.
void TargetTile::split(const Node& node, std::vector<const Node*>& into) const {
  const Node &a = ask_.views.node(node.lower), &b = ask_.views.node(node.upper);
  const bool higher = a.places.high.z > b.places.high.z;
  into.push_back(higher ? &b : &a);
  into.push_back(higher ? &a : &b);
}

bool TargetTile::is_too_far(const Node& node, int i, int j) const {
  const Xyz centre = targets_.centre(i, j, 0);
  return nearest_in_plan(node.places, {centre, centre}) > ask_.options.max_distance_m;
}

// The layers of which the views of a node may still change the answer.
std::vector<int> TargetTile::unbeaten(const Node& node, int i, int j, const std::vector<int>& layers) {
  if (!is_any() || !ask_.solid) return layers;
  const int first = targets_.column(i, j).first;
  std::vector<int> open;
  for (const int k : layers) {
    TargetAnswer& answer = answers_[slot(i, j)][static_cast<std::size_t>(k - first)];
    if (!is_beaten(node, answer, box_of(i, j, k), targets_.centre(i, j, k))) open.push_back(k);
  }
  return open;
}

// All views of the node are proven to hide the target, or to see it no better than others do.
bool TargetTile::is_beaten(const Node& node, TargetAnswer& answer, const Box3& target,
                           const Xyz& centre) const {
  if (answer == sure(kVisible)) return true;
  const Grain grain = node.last - node.first <= kFewPlaces ? Grain::kVoxels : Grain::kBlocks;
  double known = answer.verdict == kNoVerdict ? -ask_.most
                                              : one_sided_quantile(static_cast<double>(answer.p), ask_.tails);
  if (known != 0) known -= kRounding;
  if (answer.verdict == kNoVerdict || answer.verdict == kHidden) {
    if (farthest_in_plan(node.box, target) > ask_.options.max_distance_m) return false;
    // Of areas no p is told but that of the proof.
    const bool area = !ask_.cells.empty();
    if (!area && node.is_leaf() && answer.verdict == kNoVerdict) return false;
    const double ratio = area ? ask_.quantile : std::clamp(-known, ask_.quantile, ask_.most);
    if (!ask_.sight.blocked(node.box, target, ratio, grain)) return false;
    answer = join(answer, area ? hidden_by(ratio) : sure(kHidden));
    return true;
  }
  const double most = answer.verdict == kUncertain ? std::min(known, ask_.quantile) : known;
  return most >= 0 ? ask_.sight.doubtful(node.places, {centre, centre}, most, grain)
                   : ask_.sight.blocked(node.places, {centre, centre}, -most, grain);
}

// All lines from one place to a column. In height fields one line may tell for the rest: who is surely seen
// is so in every layer above, who is surely hidden in every layer beneath.
void TargetTile::see_from(std::size_t place, int i, int j, const std::vector<int>& layers, EndZone& target) {
  const Xyz &from = ask_.views.places()[place].place, &to = target.place();
  if (std::hypot(to.x - from.x, to.y - from.y) > ask_.options.max_distance_m) return;
  std::vector<TargetAnswer>& answers = answers_[slot(i, j)];
  const auto is_sure = [&](int k, std::uint8_t verdict) {
    const TargetAnswer seen = judge(place, i, j, k, target);
    TargetAnswer& answer = answers[static_cast<std::size_t>(k - targets_.column(i, j).first)];
    answer = join(answer, seen);
    return ask_.monotone && seen == sure(verdict);
  };
  const int lowest = layers.front();
  if (is_sure(lowest, kVisible)) return give({i, j, 1}, kVisible, lowest);
  for (std::size_t n = layers.size() - 1; n > 0; --n) {
    if (is_sure(layers[n], kHidden))
      return give({i, j, 1}, kHidden, std::numeric_limits<int>::min(), layers[n]);
  }
}

TargetAnswer TargetTile::judge(std::size_t place, int i, int j, int k, EndZone& target) {
  target.move_to_height(targets_.centre(i, j, k).z);
  const auto [ratio, closest] = ask_.sight.least(ask_.zones[place], target, closest_);
  if (closest < VolumeRays::kNever) closest_ = closest;
  const auto within = [most = static_cast<float>(ask_.most)](float b) { return std::clamp(b, -most, most); };
  TargetAnswer answer{
      static_cast<float>(proven_probability({within(ratio.low), within(ratio.high)}, ask_.tails)),
      verdict_of(ratio, ask_.quantile)};
  if (answer.verdict == kUncertain) return answer;
  const TargetAnswer& known = answers_[slot(i, j)][static_cast<std::size_t>(k - targets_.column(i, j).first)];
  const bool matters = join(known, answer).verdict != join(known, {answer.p, kUncertain}).verdict;
  if (!matters || !holds_around(answer.verdict, place, box_of(i, j, k))) answer.verdict = kUncertain;
  return answer;
}

// Seen from any: a place that sees all of the target is enough, hidden it must be from all of the cell. Seen
// from all: the other way round.
bool TargetTile::holds_around(std::uint8_t verdict, std::size_t place, const Box3& target) const {
  const bool one_place = (verdict == kVisible) == is_any();
  const EndRoom& views = one_place ? ask_.rooms[place] : ask_.cell(place);
  if (views.room() == Xyz{} && target.low == target.high) return true;
  const EndRoom around = ask_.sight.room(0.5 * (target.low + target.high), 0.5 * (target.high - target.low));
  if (verdict == kHidden) {
    return ask_.sight.blocked(views, around, ask_.quantile) ||
           (!ask_.monotone && corners_hide(views.box(), target));
  }
  return ask_.sight.clear(views, target, ask_.quantile) || ask_.sight.clear(views, around, ask_.quantile);
}

// Walls are too thin for beams: where the terrain is no height field the corners of the two boxes are tried,
// all with all.
bool TargetTile::corners_hide(const Box3& views, const Box3& target) const {
  for (const Xyz& from : corners_of(views)) {
    const EndZone view = ask_.sight.zone(from);
    for (const Xyz& to : corners_of(target)) {
      if (verdict_of(ask_.sight.ratio(view, ask_.sight.zone(to)), ask_.quantile) != kHidden) return false;
    }
  }
  return true;
}

std::uint8_t TargetTile::verdict_of_all(const Node& node, const Box3& targets) const {
  const double most = ask_.options.max_distance_m;
  if (nearest_in_plan(node.box, targets) > most) return kNoVerdict;
  if (farthest_in_plan(node.box, targets) > most) return kUncertain;
  if (is_any()) {
    if (ask_.sight.blocked(node.box, targets, ask_.most, Grain::kBlocks)) return kHidden;
    if (node.is_leaf() && ask_.sight.clear(ask_.rooms[node.first], targets, ask_.most)) return kVisible;
  } else if (node.is_leaf()) {
    if (ask_.sight.blocked(ask_.rooms[node.first].box(), targets, ask_.most, Grain::kBlocks)) return kHidden;
    if (ask_.sight.clear(ask_.cell(node.first), targets, ask_.most)) return kVisible;
  }
  return kUncertain;
}

bool TargetTile::is_any() const { return ask_.options.seen_from == SeenFrom::kAny; }

TargetAnswer TargetTile::join(const TargetAnswer& a, const TargetAnswer& b) const {
  return is_any() ? better_of(a, b) : worse_of(a, b);
}

TargetAnswer TargetTile::sure(std::uint8_t verdict) const {
  if (verdict == kHidden) return hidden_by(ask_.most);
  const auto most = static_cast<float>(ask_.most);
  return {static_cast<float>(proven_probability({most, most}, ask_.tails)), kVisible};
}

TargetAnswer TargetTile::hidden_by(double ratio) const {
  const auto most = static_cast<float>(-ratio);
  return {static_cast<float>(proven_probability({most, most}, ask_.tails)), kHidden};
}

bool TargetTile::is_settled(int i, int j) const {
  return std::ranges::all_of(answers_[slot(i, j)],
                             [settled = sure(settling())](const TargetAnswer& a) { return a == settled; });
}

void TargetTile::give(const Block& block, std::uint8_t verdict, int bottom, int top) {
  const TargetAnswer given = sure(verdict);
  each_column(block, [&](int i, int j) {
    const TargetColumn& column = targets_.column(i, j);
    for (int k = std::max(column.first, bottom); k <= std::min(column.last, top); ++k) {
      TargetAnswer& answer = answers_[slot(i, j)][static_cast<std::size_t>(k - column.first)];
      answer = join(answer, given);
    }
  });
}

// Around everything that the verdicts of a block speak of; false when it asks nothing.
bool TargetTile::box_of(const Block& block, Box3& box) const {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  box = {{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  each_column(block, [&](int i, int j) {
    const TargetColumn& column = targets_.column(i, j);
    if (column.size() == 0) return;
    const Xyz low = box_of(i, j, column.first).low, high = box_of(i, j, column.last).high;
    box.low = {std::min(box.low.x, low.x), std::min(box.low.y, low.y), std::min(box.low.z, low.z)};
    box.high = {std::max(box.high.x, high.x), std::max(box.high.y, high.y), std::max(box.high.z, high.z)};
  });
  return box.low.x <= box.high.x;
}

// No place beneath the ground is asked about.
Box3 TargetTile::box_of(int i, int j, int k) const {
  const Xyz centre = targets_.centre(i, j, k);
  Box3 box{centre - ask_.target_room, centre + ask_.target_room};
  const auto ground = static_cast<double>(targets_.column(i, j).ground);
  box.low.z = std::max(box.low.z, std::min(ground, centre.z));
  return box;
}

}  // namespace sightbound
