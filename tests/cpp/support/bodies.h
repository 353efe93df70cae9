// SPDX-License-Identifier: GPL-3.0-or-later
// TINs that are no height fields, and k along the normal by brute force: no code of cpp/volume.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "error_model/error_field.h"
#include "support/growth.h"
#include "terrain/tin.h"
#include "volume/tin_error.h"

namespace sightbound::testing {

// A ball of triangles, each corner pushed in or out: closed, with ridges and valleys.
inline Tin rough_ball(unsigned seed, double radius, double roughness) {
  const double t = (1 + std::sqrt(5.0)) / 2;
  Tin tin;
  tin.vertices = {{-1, t, 0},  {1, t, 0},  {-1, -t, 0}, {1, -t, 0}, {0, -1, t},  {0, 1, t},
                  {0, -1, -t}, {0, 1, -t}, {t, 0, -1},  {t, 0, 1},  {-t, 0, -1}, {-t, 0, 1}};
  tin.faces = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
               {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
               {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  // Once divided: 80 faces.
  std::vector<Face> faces;
  std::vector<std::pair<std::array<std::int32_t, 2>, std::int32_t>> middles;
  const auto middle = [&](std::int32_t a, std::int32_t b) {
    const std::array<std::int32_t, 2> edge{std::min(a, b), std::max(a, b)};
    for (const auto& m : middles) {
      if (m.first == edge) return m.second;
    }
    tin.vertices.push_back(
        0.5 * (tin.vertices[static_cast<std::size_t>(a)] + tin.vertices[static_cast<std::size_t>(b)]));
    middles.push_back({edge, static_cast<std::int32_t>(tin.vertices.size() - 1)});
    return middles.back().second;
  };
  for (const Face& f : std::vector<Face>(tin.faces)) {
    const std::int32_t a = middle(f[0], f[1]), b = middle(f[1], f[2]), c = middle(f[2], f[0]);
    for (const Face& part : {Face{f[0], a, c}, Face{f[1], b, a}, Face{f[2], c, b}, Face{a, b, c}})
      faces.push_back(part);
  }
  tin.faces = faces;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (Xyz& v : tin.vertices) v = (radius * (1 + roughness * unit(random)) / length(v)) * v + Xyz{50, 40, 30};
  return tin;
}

// Ground with bumps under a bridge deck: two sheets one above the other, both looking up.
inline Tin bridge(unsigned seed) {
  Tin tin;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto sheet = [&](int across, int down, const Xyz& from, double step, double rough) {
    const auto first = static_cast<std::int32_t>(tin.vertices.size());
    for (int r = 0; r <= down; ++r) {
      for (int c = 0; c <= across; ++c)
        tin.vertices.push_back(from + Xyz{c * step, r * step, rough * unit(random)});
    }
    for (int r = 0; r < down; ++r) {
      for (int c = 0; c < across; ++c) {
        const std::int32_t a = first + r * (across + 1) + c, b = a + 1, d = a + across + 1, e = d + 1;
        tin.faces.push_back({a, b, e});
        tin.faces.push_back({a, e, d});
      }
    }
  };
  sheet(8, 6, {0, 0, 0}, 7, 4);
  sheet(6, 1, {2, 15, 14}, 8, 1);
  return tin;
}

// Half a tube over nothing: a sheet that overhangs at both feet, folded at sharp edges where `sides` is
// small.
inline Tin arch(int sides, double radius, double depth) {
  Tin tin;
  for (int s = 0; s <= sides; ++s) {
    const double angle = -0.3 + (3.14159265 + 0.6) * s / sides;
    for (int n = 0; n <= 3; ++n) {
      tin.vertices.push_back(
          {radius - radius * std::cos(angle), depth * n / 3, 5 + radius * std::sin(angle)});
    }
  }
  for (std::int32_t s = 0; s < sides; ++s) {
    for (std::int32_t n = 0; n < 3; ++n) {
      const std::int32_t a = 4 * s + n, b = a + 1, c = a + 4, d = c + 1;
      tin.faces.push_back({a, c, d});
      tin.faces.push_back({a, d, b});
    }
  }
  return tin;
}

inline TinError random_error(const Tin& tin, unsigned seed, double least, double most, double amplitude) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  TinError error;
  for (std::size_t v = 0; v < tin.vertices.size(); ++v) {
    error.sampling.push_back(static_cast<float>(least + (most - least) * unit(random)));
    if (amplitude > 0) error.amplitude.push_back(static_cast<float>(amplitude * unit(random)));
  }
  error.spacing_m = median_edge(tin);
  error.profile = {seed % 2 == 0 ? GeologicShape::kGrowth : GeologicShape::kGaussian, 0, 0.8,
                   error.spacing_m / 2};
  return error;
}

// |k| at a place of the Tin's own coordinates, and what is nearest there.
struct NearestByHand {
  double ratio = 0, distance = 0;
  std::vector<std::size_t> faces;  // all that come within a hair of it
  Xyz place;
};
inline NearestByHand nearest_by_hand(const Tin& tin, const TinError& error, const Xyz& x) {
  NearestByHand best;
  best.distance = std::numeric_limits<double>::infinity();
  const auto at = [&](std::int32_t v) { return tin.vertices[static_cast<std::size_t>(v)]; };
  std::vector<std::pair<double, std::size_t>> all;
  for (std::size_t f = 0; f < tin.faces.size(); ++f) {
    const std::array<Xyz, 3> p{at(tin.faces[f][0]), at(tin.faces[f][1]), at(tin.faces[f][2])};
    double nearest = std::numeric_limits<double>::infinity();
    Xyz where;
    const auto offer = [&](const Xyz& q) {
      if (length(q - x) < nearest) {
        nearest = length(q - x);
        where = q;
      }
    };
    for (std::size_t i = 0; i < 3; ++i) {
      const Xyz edge = p[(i + 1) % 3] - p[i];
      offer(p[i] + std::clamp(dot(x - p[i], edge) / dot(edge, edge), 0.0, 1.0) * edge);
    }
    const Xyz normal = cross(p[1] - p[0], p[2] - p[0]);
    const Xyz foot = x - (dot(x - p[0], normal) / dot(normal, normal)) * normal;
    bool inside = true;
    for (std::size_t i = 0; i < 3; ++i)
      inside = inside && dot(cross(p[(i + 1) % 3] - p[i], foot - p[i]), normal) >= 0;
    if (inside) offer(foot);
    all.push_back({nearest, f});
    if (nearest >= best.distance) continue;
    best.distance = nearest;
    best.place = where;
    const double whole = length(normal);
    double sigma = 0, amplitude = 0, d = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
      const double weight = length(cross(p[(i + 1) % 3] - where, p[(i + 2) % 3] - where)) / whole;
      const auto v = static_cast<std::size_t>(tin.faces[f][i]);
      sigma += weight * static_cast<double>(error.sampling[v]);
      if (!error.amplitude.empty()) amplitude += weight * static_cast<double>(error.amplitude[v]);
      d = std::min(d, length(where - p[i]));
    }
    double share = 0;
    if (error.profile.shape == GeologicShape::kGrowth) {
      share = growth(2 * d / error.spacing_m, error.profile.exponent);
    } else {
      share = 1 - std::exp(-0.5 * std::pow(amplitude * 1.959963984540054 * d, 2));
    }
    best.ratio = nearest / std::max(sigma + amplitude * share, 0.001);
  }
  for (const auto& [distance, face] : all) {
    if (distance <= best.distance + 1e-9) best.faces.push_back(face);
  }
  return best;
}

// How often a closed TIN goes round a place: 1 inside.
inline double winding(const Tin& tin, const Xyz& x) {
  double angle = 0;
  for (const Face& f : tin.faces) {
    const Xyz a = tin.vertices[static_cast<std::size_t>(f[0])] - x,
              b = tin.vertices[static_cast<std::size_t>(f[1])] - x,
              c = tin.vertices[static_cast<std::size_t>(f[2])] - x;
    const double la = length(a), lb = length(b), lc = length(c);
    angle +=
        2 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return angle / (4 * 3.14159265358979);
}

}  // namespace sightbound::testing
