// SPDX-License-Identifier: GPL-3.0-or-later
// The plain loops are the specification of the kernels: here they are compiled once more without vectors, and
// both must give the same bits.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "error_model/error_model.h"
#include "sight/search_kernel.h"
#include "sight/vector.h"
#include "sight/wedge_kernel.h"

#undef SIGHTBOUND_VECTOR
#define SIGHTBOUND_VECTOR __attribute__((optimize("no-tree-vectorize")))
namespace plain {
namespace sightbound {
using namespace ::sightbound;
}
#include "sight/search_kernel.cpp"
#include "sight/wedge_kernel.cpp"
}  // namespace plain

namespace sightbound {
namespace {

class Random {
 public:
  float between(float low, float high) { return std::uniform_real_distribution<float>(low, high)(engine_); }
  std::vector<float> values(std::size_t count, float low, float high) {
    std::vector<float> out(count);
    for (float& v : out) v = between(low, high);
    return out;
  }

 private:
  std::mt19937 engine_{20261122};
};

template <class T>
void expect_same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(T)), 0);
}

WedgeStep some_step(Random& random, int wedges, int rows) {
  WedgeStep step;
  step.wedges = wedges;
  step.rows = rows;
  step.near = {random.between(3, 6), static_cast<float>(rows - 12) / static_cast<float>(wedges)};
  step.far = {random.between(3, 6), static_cast<float>(rows - 11) / static_cast<float>(wedges)};
  step.pad = random.between(0.001f, 0.3f);
  step.drop_low = {random.between(0, 5), random.between(-0.01f, 0.01f)};
  step.drop_high = {random.between(5, 6), random.between(-0.01f, 0.01f)};
  step.eye_above = random.between(0, 100);
  step.eye_below = step.eye_above + 1;
  step.near_least = 0.011f;
  step.far_most = 0.0099f;
  step.far_least = 0.0101f;
  return step;
}

TEST(Kernels, give_the_same_bits_with_and_without_vectors) {
  Random random;
  for (const int rows : {20, 33, 70, 150}) {
    const int wedges = whole_vectors(rows - 12);
    const auto room = static_cast<std::size_t>(rows + 2 * kVector);
    std::vector<float> z = random.values(room, 0, 200);
    z[5] = std::numeric_limits<float>::quiet_NaN();
    const std::vector<float> sampling = random.values(room, 0, 2), between = random.values(room, 0, 1);
    for (const bool uniform : {true, false}) {
      ColumnBounds bounds;
      bounds.count = rows;
      bounds.full = 3.3f;
      bounds.near_end = 0.01f;
      bounds.ratio = 3.29f;
      bounds.pad = 0.005f;
      bounds.sampling = uniform ? nullptr : sampling.data();
      bounds.between = uniform ? nullptr : between.data();
      std::vector<float> above(room), below(room), plain_above(room), plain_below(room);
      bound_column(bounds, z.data(), above.data(), below.data());
      plain::sightbound::bound_column(bounds, z.data(), plain_above.data(), plain_below.data());
      expect_same_bits(above, plain_above);
      expect_same_bits(below, plain_below);

      std::vector<float> cells(room), plain_cells(room);
      highest_corners(rows - 1, above.data(), below.data(), cells.data());
      plain::sightbound::highest_corners(rows - 1, above.data(), below.data(), plain_cells.data());
      expect_same_bits(cells, plain_cells);

      const WedgeStep step = some_step(random, wedges, rows);
      std::vector<float> horizon = random.values(static_cast<std::size_t>(wedges), -1, 1),
                         plain_horizon = horizon;
      raise_above(step, cells.data(), horizon.data());
      plain::sightbound::raise_above(step, cells.data(), plain_horizon.data());
      expect_same_bits(horizon, plain_horizon);
      raise_below(step, below.data(), horizon.data());
      plain::sightbound::raise_below(step, below.data(), plain_horizon.data());
      expect_same_bits(horizon, plain_horizon);

      TargetStep targets;
      targets.first_row = 5;
      targets.rows = rows - 11;
      targets.wedges = wedges;
      targets.edges = step.far;
      targets.pad = step.pad;
      targets.drop_low = step.drop_low;
      targets.drop_high = step.drop_high;
      targets.least = 0.0101f;
      targets.most = 0.0099f;
      std::vector<std::int32_t> states(room), plain_states(room);
      judge_targets(targets, horizon.data(), z.data(), states.data());
      plain::sightbound::judge_targets(targets, horizon.data(), z.data(), plain_states.data());
      expect_same_bits(states, plain_states);
    }
  }
}

TEST(Kernels, scan_nodes_alike_with_and_without_vectors) {
  Random random;
  constexpr int kNodes = 64;
  const std::vector<float> highest = random.values(kNodes * kNodes, 0, 100),
                           widest = random.values(kNodes * kNodes, 0, 3);
  int searched = 0;
  for (int round = 0; round < 200; ++round) {
    NodeScan scan;
    scan.highest = highest.data() + kScan;
    scan.widest = round % 2 ? widest.data() + kScan : nullptr;
    scan.major_stride = 1;
    scan.minor_stride = kNodes;
    scan.minors = kNodes * 4;
    scan.xi = 0.1f;
    scan.xi_step = 0.02f;
    scan.minor0 = random.between(-2, 200);
    scan.minor_span = random.between(-100, 100);
    scan.terms = round % 3;
    scan.bow = {random.between(-1, 1), random.between(-1, 1)};
    scan.rise = random.between(-50, 150);
    scan.drop = random.between(0, 20);
    scan.eye = random.between(0, 100);
    scan.minor_pad = 0.01f;
    scan.share_pad = 1e-5f;
    scan.height_pad = 0.01f;
    scan.rim = 0.005f;
    scan.ratio = random.between(-3, 3);
    scan.uniform = scan.least_sigma = 1;
    scan.end_zone_sigma = 0.001f;
    scan.end_zone_share = 0.15f;
    std::vector<std::int32_t> matters(kScan), plain_matters(kScan);
    scan_nodes(scan, matters.data());
    plain::sightbound::scan_nodes(scan, plain_matters.data());
    expect_same_bits(matters, plain_matters);
    for (const std::int32_t m : matters) searched += m;
  }
  EXPECT_GT(searched, 100);  // the case is not an empty one
  EXPECT_LT(searched, 200 * kScan - 100);
}

}  // namespace
}  // namespace sightbound
