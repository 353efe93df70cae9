// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "support/tins.h"
#include "terrain/tin_topology.h"

namespace sightbound {
namespace {

using testing::box;
using testing::tin_of;
using testing::together;

constexpr auto kBorder = TinTopology::kBorder;
constexpr auto kNonManifold = TinTopology::kNonManifold;

void expect_neighbours_true(const Tin& tin, const TinTopology& topology) {
  const TinTopology again = topology_of(tin);
  EXPECT_EQ(again.neighbours, topology.neighbours);
}

double volume(const Tin& tin) {
  double six = 0;
  for (const Face& f : tin.faces) six += dot(tin.vertices[static_cast<std::size_t>(f[0])], normal_of(tin, f));
  return six / 6;
}

TEST(TinTopology, NeighboursOfTwoFaces) {
  const Tin tin = tin_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
  const TinTopology topology = topology_of(tin);
  EXPECT_EQ(topology.neighbours[0], (std::array<std::int32_t, 3>{kBorder, kBorder, 1}));
  EXPECT_EQ(topology.neighbours[1], (std::array<std::int32_t, 3>{0, kBorder, kBorder}));
  ASSERT_EQ(topology.components.size(), 1U);
  EXPECT_FALSE(topology.components[0].closed);
  EXPECT_TRUE(topology.components[0].orientable);
  EXPECT_EQ(topology.components[0].faces, 2U);
  EXPECT_EQ(topology.border_edges, 4U);
}

TEST(TinTopology, ThreeFacesAtAnEdgeAreNotConnectedByIt) {
  const Tin tin =
      tin_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  const TinTopology topology = topology_of(tin);
  EXPECT_EQ(topology.non_manifold_edges, 1U);
  EXPECT_EQ(topology.components.size(), 3U);
  EXPECT_EQ(topology.neighbours[0][0], kNonManifold);
  EXPECT_EQ(topology.component, (std::vector<std::int32_t>{0, 1, 2}));
}

TEST(Orient, ABoxWithFacesTurnedAtRandomLooksOutward) {
  for (unsigned pattern = 0; pattern < 4096; pattern += 7) {
    Tin tin = box({-1, 5, 2}, {4, 7, 3});
    for (std::size_t f = 0; f < 12; ++f) {
      if (pattern >> f & 1) std::swap(tin.faces[f][0], tin.faces[f][1]);
    }
    TinTopology topology = topology_of(tin);
    EXPECT_TRUE(topology.components[0].closed);
    const std::size_t turned = orient(tin, topology);
    EXPECT_EQ(turned, static_cast<std::size_t>(__builtin_popcount(pattern & 4095)));
    EXPECT_NEAR(volume(tin), 10, 1e-12);
    expect_neighbours_true(tin, topology);
  }
}

TEST(Orient, OpenPartsLookUp) {
  Tin tin = together(tin_of({{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 2, 3}}),
                     testing::triangle(5));
  TinTopology topology = topology_of(tin);
  EXPECT_EQ(orient(tin, topology), 1U);
  for (const Face& f : tin.faces) EXPECT_GT(normal_of(tin, f).z, 0);
}

TEST(Orient, ACavityStaysOneABodyBesideIsTurned) {
  Tin inner = box({4, 4, 4}, {6, 6, 6}), beside = box({20, 0, 0}, {21, 1, 1});
  for (Face& f : inner.faces) std::swap(f[0], f[1]);
  for (Face& f : beside.faces) std::swap(f[0], f[1]);
  Tin tin = together(together(box({0, 0, 0}, {10, 10, 10}), inner), beside);
  TinTopology topology = topology_of(tin);
  EXPECT_EQ(orient(tin, topology), 12U);
  EXPECT_NEAR(volume(tin), 1000 - 8 + 1, 1e-9);
}

TEST(Orient, AMoebiusStripHasNoSides) {
  constexpr int kSteps = 12;
  Tin tin;
  for (int i = 0; i < kSteps; ++i) {
    const double a = 2 * std::numbers::pi * i / kSteps;
    for (const double w : {-0.3, 0.3}) {
      const double r = 2 + w * std::cos(a / 2);
      tin.vertices.push_back({r * std::cos(a), r * std::sin(a), w * std::sin(a / 2)});
    }
  }
  for (int i = 0; i < kSteps; ++i) {
    const bool last = i + 1 == kSteps;
    const int a = 2 * i, b = 2 * i + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    tin.faces.push_back({a, c, b});
    tin.faces.push_back({b, c, d});
  }
  TinTopology topology = topology_of(tin);
  ASSERT_EQ(topology.components.size(), 1U);
  EXPECT_FALSE(topology.components[0].orientable);
  EXPECT_EQ(topology.non_manifold_edges, 0U);
  const std::vector<Face> before = tin.faces;
  EXPECT_EQ(orient(tin, topology), 0U);
  EXPECT_EQ(tin.faces, before);
}

}  // namespace
}  // namespace sightbound
