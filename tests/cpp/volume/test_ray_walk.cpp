// SPDX-License-Identifier: GPL-3.0-or-later
// The hierarchical walk against a plain one, voxel by voxel, on trees with tiles at every level.
#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "volume/vdb_ray_walk.h"

namespace sightbound {
namespace {

constexpr float kBeyond = 3.5f;

using Seen = std::set<std::tuple<float, float>>;  // the different bounds passed

struct Recorder {
  Seen seen;
  int visits = 0;
  double last_t = -1;
  bool voxel(std::int32_t packed, bool, double t) {
    const RatioInterval k = unpack(packed);
    seen.emplace(k.low, k.high);
    ++visits;
    EXPECT_GE(t, last_t);
    last_t = t;
    return true;
  }
  bool unknown(double) { return true; }
  bool may_matter(std::int32_t) const { return true; }
};

// Between one crossing with a plane of the voxels' grid and the next a line stays within one voxel.
Seen plain_walk(const RatioTree& tree, const VolumeLine& line, double side, double height) {
  std::vector<double> crossings{0, 1};
  const auto add = [&](double t) {
    if (t > 0 && t < 1) crossings.push_back(t);
  };
  const auto planes = [&](double a, double b, double step, const auto& cross) {
    for (double n = std::floor(std::min(a, b) / step); n <= std::max(a, b) / step + 1; ++n) cross(n * step);
  };
  const double dx = line.to.x - line.from.x, dy = line.to.y - line.from.y, dz = line.to.z - line.from.z;
  planes(line.from.x, line.to.x, side, [&](double x) { add((x - line.from.x) / dx); });
  planes(line.from.y, line.to.y, side, [&](double y) { add((y - line.from.y) / dy); });
  const double lowest = std::min(line.from.z, line.to.z) - line.drop / 4;
  planes(lowest, std::max(line.from.z, line.to.z), height, [&](double z) {
    // drop t^2 + (dz - drop) t + from - z = 0
    const double a = line.drop, b = dz - line.drop, c = line.from.z - z;
    if (a == 0) return add(-c / b);
    const double under = b * b - 4 * a * c;
    if (under < 0) return;
    add((-b + std::sqrt(under)) / (2 * a));
    add((-b - std::sqrt(under)) / (2 * a));
  });
  std::sort(crossings.begin(), crossings.end());
  Seen seen;
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
    const Xyz at = line.at((crossings[i] + crossings[i + 1]) / 2);
    const openvdb::Coord voxel(static_cast<int>(std::floor(at.x / side)),
                               static_cast<int>(std::floor(at.y / side)),
                               static_cast<int>(std::floor(at.z / height)));
    const RatioInterval k = unpack(tree.getValue(voxel));
    seen.emplace(k.low, k.high);
  }
  return seen;
}

class RandomTree {
 public:
  explicit RandomTree(unsigned seed) : random_(seed), tree_(pack(kBeyond, kBeyond)) {}

  double between(double a, double b) { return std::uniform_real_distribution(a, b)(random_); }
  Xyz place(double reach) {
    return {between(-reach, reach), between(-reach, reach), between(-reach / 4, reach / 4)};
  }
  std::int32_t value() {
    const double low = between(-kBeyond, kBeyond - 0.1);
    return pack(low, low + 0.1);
  }

  // Tiles of a level and voxels, along a line, where the walk will meet them.
  void strew(const VolumeLine& line, double side, double height) {
    for (const auto& [level, count] : {std::pair{3, 1}, std::pair{2, 2}, std::pair{1, 6}, std::pair{0, 40}}) {
      for (int n = 0; n < count; ++n) {
        const Xyz at = line.at(between(0, 1));
        tree_.addTile(static_cast<openvdb::Index>(level),
                      {static_cast<int>(std::floor(at.x / side)) + static_cast<int>(between(-2, 2)),
                       static_cast<int>(std::floor(at.y / side)),
                       static_cast<int>(std::floor(at.z / height)) + static_cast<int>(between(-2, 2))},
                      value(), level != 2);
      }
    }
  }

  RatioTree& tree() { return tree_; }

 private:
  std::mt19937 random_;
  RatioTree tree_;
};

TEST(RayWalk, passes_what_a_plain_walk_passes) {
  const Workers workers(2);
  std::size_t passed = 0, visits = 0, steps = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    RandomTree random(seed);
    const double side = seed % 3 ? 1 : 2.5, height = seed % 2 ? side : 0.5 * side;
    // Short and long, flat and steep, straight and bent.
    const double reach = seed % 4 == 0 ? 9000 : 300;
    VolumeLine line{random.place(reach), random.place(reach), seed % 5 ? 0 : random.between(0, reach / 3)};
    if (seed % 7 == 0) line.to.x = line.from.x;
    if (seed % 11 == 0) line.to = {line.from.x, line.from.y, line.from.z + 500};
    random.strew(line, side, height);
    const BitTree none(false);
    const BlockColumns columns(random.tree(), workers);
    RayWalk walk({random.tree(), none, nullptr, side, height, columns}, line);
    Recorder recorder;
    walk.run(0, 1, recorder);
    const Seen expected = plain_walk(random.tree(), line, side, height);
    // The walk may pass a voxel of the background where it stops at a column's edge; nothing else more or
    // less.
    recorder.seen.emplace(kBeyond, kBeyond);
    Seen with_background = expected;
    with_background.emplace(kBeyond, kBeyond);
    EXPECT_EQ(recorder.seen, with_background) << "seed " << seed;
    passed += expected.size();
    visits += static_cast<std::size_t>(recorder.visits);
    steps += static_cast<std::size_t>(std::hypot(line.to.x - line.from.x, line.to.y - line.from.y) / side);
  }
  EXPECT_GT(passed, 600u);
  EXPECT_LT(4 * visits, steps);  // tiles are crossed in one step each
}

TEST(RayWalk, walks_the_part_asked_for) {
  RatioTree tree(pack(kBeyond, kBeyond));
  for (int i = 0; i < 100; ++i) tree.setValue({i, 0, 0}, pack(i / 64.0, i / 64.0));
  const BitTree none(false);
  const Workers workers(1);
  const BlockColumns columns(tree, workers);
  RayWalk walk({tree, none, nullptr, 1, 1, columns}, {{0.5, 0.5, 0.5}, {100.5, 0.5, 0.5}, 0});
  Recorder recorder;
  walk.run(0.2, 0.3, recorder);  // from x = 20.5 to 30.5
  EXPECT_EQ(recorder.visits, 11);
  EXPECT_EQ(std::get<0>(*recorder.seen.begin()), 20 / 64.0f);
  EXPECT_EQ(std::get<0>(*recorder.seen.rbegin()), 30 / 64.0f);
}

// The sides of a sheet are told by the order in which its voxels are passed.
TEST(RayWalk, passes_the_voxels_of_a_steep_line_in_its_order) {
  struct Layers {
    std::vector<float> seen;
    bool voxel(std::int32_t packed, bool, double) {
      if (unpack(packed).low < kBeyond) seen.push_back(unpack(packed).low);
      return true;
    }
    bool unknown(double) { return true; }
    bool may_matter(std::int32_t) const { return true; }
  };
  RatioTree tree(pack(kBeyond, kBeyond));
  for (int i = 0; i < 16; ++i) {
    for (int k = 0; k < 24; ++k) tree.setValue({i, 2, k}, pack(k / 64.0, k / 64.0));
  }
  const BitTree none(false);
  const Workers workers(1);
  const BlockColumns columns(tree, workers);
  const Xyz low{1.2, 2.5, 0.5}, high{6.9, 2.5, 23.5};
  for (const bool down : {false, true}) {
    Layers layers;
    RayWalk({tree, none, nullptr, 1, 1, columns}, {down ? high : low, down ? low : high, 0})
        .run(0, 1, layers);
    if (down) std::reverse(layers.seen.begin(), layers.seen.end());
    EXPECT_TRUE(std::is_sorted(layers.seen.begin(), layers.seen.end())) << down;
    EXPECT_GE(layers.seen.size(), 24u);
  }
}

TEST(RayWalk, tells_of_columns_without_terrain) {
  struct Counter {
    int unknown_columns = 0;
    bool voxel(std::int32_t, bool, double) { return true; }
    bool unknown(double) { return ++unknown_columns < 3; }
    bool may_matter(std::int32_t) const { return true; }
  };
  RatioTree tree(pack(kBeyond, kBeyond));
  tree.setValue({5, 5, 5}, pack(1, 1));
  PlanMask mask(16, 16, true);
  mask.set_8(1, 0, ~std::uint64_t{0});
  mask.summarise();
  const BitTree none(false);
  const Workers workers(1);
  const BlockColumns columns(tree, workers);
  RayWalk walk({tree, none, &mask, 1, 1, columns}, {{0.5, 0.5, 40}, {15.5, 0.5, 40}, 0});
  Counter counter;
  walk.run(0, 0.45, counter);
  EXPECT_EQ(counter.unknown_columns, 0);
  walk.run(0, 1, counter);
  EXPECT_GT(counter.unknown_columns, 0);
}

}  // namespace
}  // namespace sightbound
