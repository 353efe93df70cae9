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

      WedgeStep step = some_step(random, wedges, rows);
      step.window = 1 + rows % 3;
      std::vector<float> lowest = below, plain_lowest = below;
      widen_highest(rows - 1, step.window, cells.data());
      plain::sightbound::widen_highest(rows - 1, step.window, plain_cells.data());
      expect_same_bits(cells, plain_cells);
      widen_lowest(rows, step.window, lowest.data());
      plain::sightbound::widen_lowest(rows, step.window, plain_lowest.data());
      expect_same_bits(lowest, plain_lowest);
      std::vector<float> horizon = random.values(static_cast<std::size_t>(wedges), -1, 1),
                         plain_horizon = horizon;
      raise_above(step, cells.data(), horizon.data());
      plain::sightbound::raise_above(step, cells.data(), plain_horizon.data());
      expect_same_bits(horizon, plain_horizon);
      raise_below(step, below.data(), lowest.data(), horizon.data());
      plain::sightbound::raise_below(step, below.data(), lowest.data(), plain_horizon.data());
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

TEST(Kernels, widen_by_the_neighbours_there_are) {
  std::vector<float> highest(8 + 2 * kVector, -1), lowest(8 + 2 * kVector, -1);
  const std::vector<float> values{3, 1, 4, 1, 5, 9, 2, 6};
  std::copy(values.begin(), values.end(), highest.begin());
  std::copy(values.begin(), values.end(), lowest.begin());
  widen_highest(8, 3, highest.data());
  widen_lowest(8, 3, lowest.data());
  highest.resize(8);
  lowest.resize(8);
  EXPECT_EQ(highest, (std::vector<float>{4, 4, 5, 9, 9, 9, 6, 6}));
  EXPECT_EQ(lowest, (std::vector<float>{1, 1, 1, 1, 2, 2, 2, 6}));
}

// Three windows hold every entry of a span, wherever it begins.
TEST(Kernels, look_a_whole_wedge_up) {
  for (double span = 0.1; span < 12; span += 0.1) {
    for (double low = 5; low < 6; low += 0.01) {
      const int touched = static_cast<int>(low + span) - static_cast<int>(low) + 1;
      EXPECT_LE(touched, 3 * window_for(span)) << span << " from " << low;
    }
  }
}

// A wedge of several cells: its horizons are those of the highest and the lowest of them all, wherever it
// stands.
TEST(Kernels, raise_by_every_cell_of_a_wide_wedge) {
  constexpr int kRows = 24;
  for (int odd = 5; odd <= 10; ++odd) {
    WedgeStep step;
    step.wedges = 1;
    step.near = step.far = {4.25f, 6.5f};  // cells 4 to 10
    step.rows = kRows;
    step.window = window_for(6.5 + 2e-3);
    step.pad = 1e-3f;
    step.near_least = step.far_most = step.far_least = 1;
    std::vector<float> cells(kRows + 2 * kVector, 10), line(kRows + 2 * kVector, 10);
    cells[static_cast<std::size_t>(odd)] = 70;
    line[static_cast<std::size_t>(odd)] = 2;
    std::vector<float> lowest = line, above(kVector, -kUnbounded), below(kVector, -kUnbounded);
    widen_highest(kRows - 1, step.window, cells.data());
    widen_lowest(kRows, step.window, lowest.data());
    raise_above(step, cells.data(), above.data());
    raise_below(step, line.data(), lowest.data(), below.data());
    EXPECT_EQ(above[0], 70) << odd;
    EXPECT_EQ(below[0], 2) << odd;
  }
}

ScannedLine some_line(Random& random, int round, int minors) {
  ScannedLine line;
  line.minor0 = random.between(-2, 0.8f * static_cast<float>(minors));
  line.minor_span = random.between(-100, 100);
  line.terms = round % 3;
  line.bow = {random.between(-1, 1), random.between(-1, 1)};
  line.rise = random.between(-50, 150);
  line.drop = random.between(0, 20);
  line.eye = random.between(0, 100);
  line.share_pad = 1e-5f;
  line.height_pad = 0.01f;
  line.minors = minors;
  line.rim = 0.005f;
  line.uniform = line.least_sigma = 1;
  line.end_zone_sigma = 0.001f;
  line.end_zone_share = 0.15f;
  return line;
}

TEST(Kernels, scan_nodes_alike_with_and_without_vectors) {
  Random random;
  constexpr int kNodes = 64;
  const std::vector<float> highest = random.values(kNodes * kNodes, 0, 100),
                           widest = random.values(kNodes * kNodes, 0, 3);
  int searched = 0;
  for (int round = 0; round < 200; ++round) {
    const ScannedLine line = some_line(random, round, kNodes * 4);
    NodeScan scan;
    scan.highest = highest.data() + kScan;
    scan.widest = round % 2 ? widest.data() + kScan : nullptr;
    scan.major_stride = 1;
    scan.minor_stride = kNodes;
    scan.xi = 0.1f;
    scan.xi_step = 0.02f;
    scan.minor_pad = 0.01f;
    scan.ratio = random.between(-3, 3);
    std::vector<std::int32_t> matters(kScan), plain_matters(kScan);
    scan_nodes(line, scan, matters.data());
    plain::sightbound::scan_nodes(line, scan, plain_matters.data());
    expect_same_bits(matters, plain_matters);
    for (const std::int32_t m : matters) searched += m;
  }
  EXPECT_GT(searched, 100);  // the case is not an empty one
  EXPECT_LT(searched, 200 * kScan - 100);
}

TEST(Kernels, bound_steps_and_places_alike_with_and_without_vectors) {
  Random random;
  constexpr int kSamples = 128;
  std::vector<float> heights = random.values(kSamples * kSamples, 0, 100);
  heights[500] = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> widest = random.values(kSamples * kSamples / 16, 0.5f, 3);
  int said = 0, judged = 0;
  for (int round = 0; round < 200; ++round) {
    const ScannedLine line = some_line(random, round, kSamples);
    StepScan steps;
    steps.heights = heights.data() + 9;
    steps.widest = round % 2 ? widest.data() + 2 : nullptr;
    steps.major_stride = 1;
    steps.minor_stride = kSamples;
    steps.widest_major_stride = 1;
    steps.widest_minor_stride = kSamples / 4;
    steps.first = 9;
    steps.steps = round % 5 ? 100 : 3;
    steps.xi = 0.1f;
    steps.xi_step = 0.01f;
    steps.minor_pad = 0.003f;
    std::vector<float> ratios(kScan), plain_ratios(kScan);
    bound_steps(line, steps, ratios.data());
    plain::sightbound::bound_steps(line, steps, plain_ratios.data());
    expect_same_bits(ratios, plain_ratios);
    for (const float ratio : ratios) said += ratio > -kNoRatio;

    PlaceScan places;
    places.heights = heights.data();
    places.major_stride = 1;
    places.minor_stride = kSamples;
    places.majors = kSamples;
    places.major0 = 20;
    places.major_span = 60;
    places.pad = 0.01f;
    for (std::size_t i = 0; i < places.shares.size(); ++i) places.shares[i] = random.between(0, 1);
    places.clearance = random.between(-3, 3);
    std::vector<std::int32_t> matters(kScan), plain_matters(kScan);
    scan_places(line, places, matters.data());
    plain::sightbound::scan_places(line, places, plain_matters.data());
    expect_same_bits(matters, plain_matters);
    for (const std::int32_t m : matters) judged += m;
  }
  EXPECT_GT(said, 500);
  EXPECT_GT(judged, 100);
  EXPECT_LT(judged, 200 * kScan - 100);
}

}  // namespace
}  // namespace sightbound
