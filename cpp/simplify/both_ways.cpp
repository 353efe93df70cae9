// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/both_ways.h"

#include <algorithm>
#include <cmath>

#include "volume/triangle.h"

namespace sightbound {

namespace {

constexpr int kMostCuts = 4;  // into four pieces, and so on

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

void insert_sorted(std::vector<std::int32_t>& list, std::int32_t value) {
  const auto place = std::lower_bound(list.begin(), list.end(), value);
  if (place == list.end() || *place != value) list.insert(place, value);
}

void erase_sorted(std::vector<std::int32_t>& list, std::int32_t value) {
  const auto place = std::lower_bound(list.begin(), list.end(), value);
  if (place != list.end() && *place == value) list.erase(place);
}

}  // namespace

BothWays::BothWays(const Tin& original, std::vector<float> tolerance, Containment& forward)
    : original_(original),
      forward_(forward),
      tolerance_(std::move(tolerance)),
      proved_(original.faces.size()),
      by_(original.faces.size()) {
  faces_.reserve(original.faces.size());
  for (const Face& f : original.faces)
    faces_.push_back({original.vertices[at(f[0])], original.vertices[at(f[1])], original.vertices[at(f[2])]});
  for (std::size_t f = 0; f < proved_.size(); ++f) {
    proved_[f] = {static_cast<std::int32_t>(f)};
    by_[f] = {static_cast<std::int32_t>(f)};
  }
}

void BothWays::gather(const StarChange& change) {
  near_.clear();
  const auto add = [this](std::int32_t face) {
    near_.insert(near_.end(), proved_[at(face)].begin(), proved_[at(face)].end());
  };
  for (const std::int32_t face : change.gone) add(face);
  for (const FaceChange& face : change.changed) add(face.face);
  std::sort(near_.begin(), near_.end());
  near_.erase(std::unique(near_.begin(), near_.end()), near_.end());
}

// The star's new faces, and those beside it that have proved a part.
void BothWays::candidates_for(std::int32_t original, const StarChange& change) {
  candidates_.clear();
  for (const FaceChange& f : change.changed) candidates_.push_back({f.face, f.after});
  const auto in_star = [&](std::int32_t face) {
    return std::find(change.gone.begin(), change.gone.end(), face) != change.gone.end() ||
           std::any_of(change.changed.begin(), change.changed.end(),
                       [face](const FaceChange& f) { return f.face == face; });
  };
  for (const std::int32_t face : by_[at(original)]) {
    if (!in_star(face)) candidates_.push_back({face, faces_[at(face)]});
  }
}

bool BothWays::covered(const Triangle& piece, const std::array<double, 3>& tolerance, int depth) {
  std::array<bool, 3> near{};
  for (const Near& candidate : candidates_) {
    bool all = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const bool is = norm(closest_on(candidate.at, piece[i]) - piece[i]) <= tolerance[i];
      near[i] = near[i] || is;
      all = all && is;
    }
    if (!all) continue;
    used_.push_back(candidate.face);
    return true;
  }
  if (depth == 0 || !(near[0] && near[1] && near[2])) return false;
  const Triangle middle{0.5 * (piece[0] + piece[1]), 0.5 * (piece[1] + piece[2]),
                        0.5 * (piece[2] + piece[0])};
  const std::array<double, 3>& t = tolerance;
  const std::array<double, 3> m{0.5 * (t[0] + t[1]), 0.5 * (t[1] + t[2]), 0.5 * (t[2] + t[0])};
  return covered({piece[0], middle[0], middle[2]}, {t[0], m[0], m[2]}, depth - 1) &&
         covered({piece[1], middle[1], middle[0]}, {t[1], m[1], m[0]}, depth - 1) &&
         covered({piece[2], middle[2], middle[1]}, {t[2], m[2], m[1]}, depth - 1) &&
         covered({middle[0], middle[1], middle[2]}, {m[0], m[1], m[2]}, depth - 1);
}

bool BothWays::is_covered(std::int32_t original) {
  used_.clear();
  const Face& f = original_.faces[at(original)];
  const auto tolerance = [this](std::int32_t v) {
    return static_cast<double>(tolerance_[at(v)]) - kWrittenSlack;
  };
  return covered({original_.vertices[at(f[0])], original_.vertices[at(f[1])], original_.vertices[at(f[2])]},
                 {tolerance(f[0]), tolerance(f[1]), tolerance(f[2])}, kMostCuts);
}

std::optional<Xyz> BothWays::place(const StarChange& change) {
  const std::optional<Xyz> found = forward_.place(change);
  if (!found) return {};
  gather(change);
  for (const std::int32_t original : near_) {
    candidates_for(original, change);
    if (!is_covered(original)) return {};
  }
  return found;
}

// Where the surface stayed as it was, rounding may leave an original unproved: what was near to it still is.
void BothWays::made(const StarChange& change) {
  forward_.made(change);
  gather(change);
  const auto forget = [this](std::int32_t face) {
    for (const std::int32_t original : proved_[at(face)]) erase_sorted(by_[at(original)], face);
    proved_[at(face)].clear();
  };
  std::vector<std::vector<std::int32_t>> proofs;
  proofs.reserve(near_.size());
  for (const std::int32_t original : near_) {
    candidates_for(original, change);
    if (!is_covered(original)) {
      for (const Near& candidate : candidates_) used_.push_back(candidate.face);
    }
    proofs.push_back(used_);
  }
  for (const std::int32_t face : change.gone) forget(face);
  for (const FaceChange& face : change.changed) {
    forget(face.face);
    faces_[at(face.face)] = face.after;
  }
  for (std::size_t n = 0; n < near_.size(); ++n) {
    const std::int32_t original = near_[n];
    for (const std::int32_t face : by_[at(original)]) erase_sorted(proved_[at(face)], original);
    by_[at(original)].clear();
    for (const std::int32_t face : proofs[n]) {
      insert_sorted(by_[at(original)], face);
      insert_sorted(proved_[at(face)], original);
    }
  }
}

}  // namespace sightbound
