// SPDX-License-Identifier: GPL-3.0-or-later
// Sixteen neighbouring nodes of the finest pyramid level at once: could the terrain in them matter to a line?
//
// A bound: a node is told off only when no place in it can matter; float rounding is covered by the pads. The
// plain loop is the specification, the compiler's vector version gives the same bits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace sightbound {

inline constexpr int kScan = 16;  // nodes

struct NodeScan {
  // The finest level of both pyramids from the first node on; `widest` null = the error is uniform.
  const float* highest = nullptr;
  const float* widest = nullptr;
  int major_stride = 0, minor_stride = 0;  // from node to node
  int minors = 0;                          // samples across
  // The line: xi at the beginning of the first node and from node to node; minor = minor0 + xi span + xi (1 -
  // xi) bow(xi) in the grid's coordinates; heights above the eye: xi rise - drop xi (1 - xi).
  float xi = 0, xi_step = 0;
  float minor0 = 0, minor_span = 0;
  int terms = 0;
  std::array<float, 8> bow{};
  float rise = 0, drop = 0, eye = 0;
  // By how much all that may be wrong: cells, shares of the distance, metres.
  float minor_pad = 0, share_pad = 0, height_pad = 0, rim = 0;
  // A place matters when the line clears it by less than ratio sigma. sigma = uniform or from `widest`, plus
  // `ends`.
  float ratio = 0, uniform = 0, ends = 0;
  float least_sigma = 0, end_zone_sigma = 0,
        end_zone_share = 0;  // sigma at least: between the end zones, in them
};

// matters[i] != 0: node i must be searched.
void scan_nodes(const NodeScan&, std::int32_t* matters);

}  // namespace sightbound
