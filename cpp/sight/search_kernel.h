// SPDX-License-Identifier: GPL-3.0-or-later
// Sixteen parts of a sight line at once: could the terrain there matter? Parts are nodes of the finest
// pyramid level, steps between two columns, or places near the ends.
//
// All are bounds: a part is told off only when no place in it can matter; float rounding is covered by the
// pads. The plain loops are the specification, the compiler's vector versions give the same bits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace sightbound {

inline constexpr int kScan = 16;  // parts

// What is the same all along a line, in floats.
struct ScannedLine {
  // minor = minor0 + xi minor_span + xi (1 - xi) bow(xi) in the grid's coordinates; heights above the eye:
  // xi rise - drop xi (1 - xi).
  float minor0 = 0, minor_span = 0;
  int terms = 0;
  std::array<float, 8> bow{};
  float rise = 0, drop = 0, eye = 0;
  // By how much shares of the distance and heights (metres) may be wrong.
  float share_pad = 0, height_pad = 0;
  int minors = 0;  // samples across
  float rim = 0;   // cells beyond them that count as within
  // sigma: at most, where the error is uniform; what moving ends add at most; at least between the end zones
  // and in them.
  float uniform = 0, ends = 0, least_sigma = 0, end_zone_sigma = 0;
  float end_zone_share = 0;
};

struct NodeScan {
  // The finest level of both pyramids from the first node on; `widest` null = the error is uniform.
  const float* highest = nullptr;
  const float* widest = nullptr;
  int major_stride = 0, minor_stride = 0;  // from node to node
  float xi = 0, xi_step = 0;               // at the beginning of the first node; from node to node
  float minor_pad = 0;                     // cells
  float ratio = 0;                         // a place matters when the line clears it by less than ratio sigma
};

// matters[i] != 0: node i must be searched.
void scan_nodes(const ScannedLine&, const NodeScan&, std::int32_t* matters);

struct StepScan {
  const float* heights = nullptr;  // of the samples, from the column where the first step begins
  int major_stride = 0, minor_stride = 0;
  int steps = 0;  // how many the grid has from there on, at least 1
  // The finest level of sigma's pyramid; null = the error is uniform.
  const float* widest = nullptr;
  int widest_major_stride = 0, widest_minor_stride = 0;
  int first = 0;  // number of the first step in the grid
  float xi = 0, xi_step = 0;
  float minor_pad = 0;
};

// ratio[i]: every judged crossing of step i clears its terrain by so many sigma or more; -kNoRatio where
// nothing is known (a hole, the rim).
inline constexpr float kNoRatio = 1e30f;
void bound_steps(const ScannedLine&, const StepScan&, float* ratio);

struct PlaceScan {
  const float* heights = nullptr;  // of all samples
  int major_stride = 0, minor_stride = 0;
  int majors = 0;
  float major0 = 0, major_span = 0;  // in the grid's coordinates
  float pad = 0;                     // cells by which a place may be elsewhere
  std::array<float, kScan> shares{};
  float clearance = 0;  // a place matters when the line clears it by less
};

// matters[i] != 0: the place at shares[i] must be judged.
void scan_places(const ScannedLine&, const PlaceScan&, std::int32_t* matters);

}  // namespace sightbound
