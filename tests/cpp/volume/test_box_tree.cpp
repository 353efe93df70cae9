// SPDX-License-Identifier: GPL-3.0-or-later
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "volume/box_tree.h"

namespace sightbound {
namespace {

std::vector<Box3> random_boxes(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Box3> boxes;
  for (std::size_t n = 0; n < count; ++n) {
    const Xyz low{100 * unit(random), 100 * unit(random), seed % 2 == 0 ? 0 : 30 * unit(random)};
    boxes.push_back({low, low + Xyz{5 * unit(random), 5 * unit(random), unit(random)}});
  }
  return boxes;
}

bool meet(const Box3& a, const Box3& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
         a.low.z <= b.high.z && b.low.z <= a.high.z;
}

TEST(BoxTree, FindsAllThatMeetABox) {
  for (const std::size_t count : {0u, 1u, 7u, 9u, 64u, 65u, 1000u}) {
    const std::vector<Box3> boxes = random_boxes(count, static_cast<unsigned>(count));
    const BoxTree tree(count, [&](std::size_t n) { return boxes[n]; });
    for (const Box3& query : random_boxes(50, 5)) {
      std::set<std::size_t> visited;
      tree.visit([&](const Box3& node) { return meet(node, query); },
                 [&](std::size_t n) { visited.insert(n); });
      for (std::size_t n = 0; n < count; ++n) {
        if (meet(boxes[n], query)) {
          EXPECT_TRUE(visited.contains(n));
        }
      }
      if (count == 1000) {
        EXPECT_LT(visited.size(), 400u);  // not simply all
      }
    }
  }
}

TEST(BoxTree, FindsTheNearestAndTheLowestOfEquals) {
  const std::vector<Box3> boxes = random_boxes(500, 3);
  const BoxTree tree(1000, [&](std::size_t n) { return boxes[n % 500]; });  // every box twice
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(-20, 120);
  for (int q = 0; q < 300; ++q) {
    const Xyz place{unit(random), unit(random), unit(random) / 3};
    std::size_t best = 0;
    for (std::size_t n = 1; n < 500; ++n) {
      if (BoxTree::distance(boxes[n], place) < BoxTree::distance(boxes[best], place)) best = n;
    }
    const BoxTree::Nearest nearest =
        tree.nearest(place, [&](std::size_t n) { return BoxTree::distance(boxes[n % 500], place); });
    EXPECT_EQ(nearest.item, best);
    EXPECT_EQ(nearest.distance, BoxTree::distance(boxes[best], place));
  }
}

}  // namespace
}  // namespace sightbound
