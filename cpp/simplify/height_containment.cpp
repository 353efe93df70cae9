// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/height_containment.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightbound {

namespace {

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

using Triangle = std::array<Xyz, 3>;

double cross_in_plan(const Xyz& a, const Xyz& b) { return a.x * b.y - a.y * b.x; }

// A linear function over a triangle in plan: 1 at one corner, 0 at the others.
struct Weight {
  double x, y, one;
  double operator()(const Xyz& p) const { return x * p.x + y * p.y + one; }
};

std::array<Weight, 3> weights_of(const Triangle& t) {
  const double area = cross_in_plan(t[1] - t[0], t[2] - t[0]);
  std::array<Weight, 3> weights;
  for (std::size_t i = 0; i < 3; ++i) {
    const Xyz &from = t[(i + 1) % 3], &to = t[(i + 2) % 3];
    const double x = (from.y - to.y) / area, y = (to.x - from.x) / area;
    weights[i] = {x, y, -(x * from.x + y * from.y)};
  }
  return weights;
}

// Corners of the piece that two triangles have in common in plan (Sutherland and Hodgman 1974).
struct Piece {
  std::array<Xyz, 9> corners;
  std::size_t count = 0;
};

Piece common_piece(const Triangle& a, const Triangle& b) {
  Piece piece;
  piece.count = 3;
  std::copy(a.begin(), a.end(), piece.corners.begin());
  for (std::size_t i = 0; i < 3 && piece.count > 0; ++i) {
    const Xyz &from = b[i], along = b[(i + 1) % 3] - b[i];
    const auto side = [&](const Xyz& p) { return cross_in_plan(along, p - from); };
    Piece cut;
    double before = side(piece.corners[piece.count - 1]);
    for (std::size_t n = 0; n < piece.count; ++n) {
      const Xyz &last = piece.corners[n == 0 ? piece.count - 1 : n - 1], &here = piece.corners[n];
      const double now = side(here);
      if ((before < 0 && now > 0) || (before > 0 && now < 0))
        cut.corners[cut.count++] = last + (before / (before - now)) * (here - last);
      if (now >= 0) cut.corners[cut.count++] = here;
      before = now;
    }
    piece = cut;
  }
  return piece;
}

}  // namespace

HeightContainment::HeightContainment(const Tin& original, std::vector<float> tolerance, bool outline_moves)
    : original_(original), tolerance_(std::move(tolerance)), beneath_(original.faces.size()) {
  for (std::size_t f = 0; f < beneath_.size(); ++f) beneath_[f] = {static_cast<std::int32_t>(f)};
  if (outline_moves) index_.emplace(original);
}

HeightContainment::Flat::Flat(const Triangle& t, const Xyz& here) {
  for (std::size_t i = 0; i < 3; ++i) at[i] = {t[i].x - here.x, t[i].y - here.y, t[i].z};
  low_x = std::min({at[0].x, at[1].x, at[2].x});
  low_y = std::min({at[0].y, at[1].y, at[2].y});
  high_x = std::max({at[0].x, at[1].x, at[2].x});
  high_y = std::max({at[0].y, at[1].y, at[2].y});
}

HeightContainment::Triangle HeightContainment::original(std::int32_t face) const {
  const Face& f = original_.faces[at(face)];
  return {original_.vertices[at(f[0])], original_.vertices[at(f[1])], original_.vertices[at(f[2])]};
}

void HeightContainment::gather(const StarChange& change) {
  near_.clear();
  const auto add = [this](std::int32_t face) {
    near_.insert(near_.end(), beneath_[at(face)].begin(), beneath_[at(face)].end());
  };
  for (const std::int32_t face : change.gone) add(face);
  for (const FaceChange& face : change.changed) {
    add(face.face);
    if (!index_) continue;
    const auto& [a, b, c] = face.after;
    index_->for_near({std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), 0},
                     {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y}), 0},
                     [this](std::int32_t near) { near_.push_back(near); });
  }
  std::sort(near_.begin(), near_.end());
  near_.erase(std::unique(near_.begin(), near_.end()), near_.end());
  flat_.clear();
  for (const std::int32_t face : near_) flat_.emplace_back(original(face), change.to);
}

std::optional<Xyz> HeightContainment::place(const StarChange& change) {
  gather(change);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Interval heights{-kInfinity, kInfinity};
  for (const FaceChange& face : change.changed) {
    const Flat made(face.after, change.to);
    for (std::size_t n = 0; n < near_.size(); ++n) {
      if (flat_[n].meets(made) && !narrow(made, face.moved, n, heights)) return {};
    }
  }
  if (!change.free_height) {
    const bool within = heights.low <= change.to.z && change.to.z <= heights.high;
    return within ? std::optional(change.to) : std::nullopt;
  }
  if (!std::isfinite(heights.low) || !std::isfinite(heights.high)) return {};
  return Xyz{change.to.x, change.to.y, 0.5 * (heights.low + heights.high)};
}

// False when no height is left.
bool HeightContainment::narrow(const Flat& made, std::size_t moved, std::size_t n, Interval& heights) const {
  const Flat& old = flat_[n];
  const Piece piece = common_piece(made.at, old.at);
  if (piece.count == 0) return true;
  const std::array<Weight, 3> of_new = weights_of(made.at), of_old = weights_of(old.at);
  const Face& corners = original_.faces[at(near_[n])];
  for (std::size_t c = 0; c < piece.count; ++c) {
    const Xyz& p = piece.corners[c];
    const double weight = of_new[moved](p);
    constexpr double kNoWeight = 1e-9;  // on the edge opposite to it, which has been tested before
    if (weight <= kNoWeight) continue;
    double height = 0, tolerance = -kWrittenSlack;
    for (std::size_t i = 0; i < 3; ++i) {
      const double w = of_old[i](p);
      height += w * old.at[i].z;
      tolerance += w * static_cast<double>(tolerance_[at(corners[i])]);
      if (i != moved) height -= of_new[i](p) * made.at[i].z;
    }
    heights.low = std::max(heights.low, (height - tolerance) / weight);
    heights.high = std::min(heights.high, (height + tolerance) / weight);
    if (heights.low > heights.high) return false;
  }
  return true;
}

void HeightContainment::made(const StarChange& change) {
  gather(change);
  for (const std::int32_t face : change.gone) beneath_[at(face)] = {};
  for (const FaceChange& face : change.changed) {
    const Flat made(face.after, change.to);
    std::vector<std::int32_t>& beneath = beneath_[at(face.face)];
    beneath.clear();
    for (std::size_t n = 0; n < near_.size(); ++n) {
      if (flat_[n].meets(made) && common_piece(made.at, flat_[n].at).count > 0) beneath.push_back(near_[n]);
    }
    beneath.shrink_to_fit();
  }
}

// No ratio is more than 1: place() has seen to that, or the surface is as it was, whatever rounding says.
std::optional<FaceDeviation> HeightContainment::deviation_of(std::int32_t face, const Triangle& now) const {
  const Xyz here = now[0];
  const Flat made(now, here);
  const std::array<Weight, 3> of_new = weights_of(made.at);
  FaceDeviation most;
  for (const std::int32_t beneath : beneath_[at(face)]) {
    const Flat old(original(beneath), here);
    const std::array<Weight, 3> of_old = weights_of(old.at);
    const Face& corners = original_.faces[at(beneath)];
    const Piece piece = common_piece(made.at, old.at);
    for (std::size_t c = 0; c < piece.count; ++c) {
      double off = 0, tolerance = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const double w = of_old[i](piece.corners[c]);
        off += of_new[i](piece.corners[c]) * made.at[i].z - w * old.at[i].z;
        tolerance += w * static_cast<double>(tolerance_[at(corners[i])]);
      }
      if (off == 0) continue;
      const double metres = std::abs(off) + kWrittenSlack;
      most.metres = std::max(most.metres, metres);
      if (tolerance > 0) most.ratio = std::max(most.ratio, std::min(metres / tolerance, 1.0));
    }
  }
  return most;
}

}  // namespace sightbound
