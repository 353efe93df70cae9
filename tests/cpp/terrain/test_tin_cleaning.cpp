// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/says.h"
#include "support/tins.h"
#include "terrain/tin_cleaning.h"
#include "terrain/tin_topology.h"

namespace sightbound {
namespace {

using testing::all_notes;
using testing::says;
using testing::tin_of;

std::string complaint(const Tin& tin) {
  try {
    clean(tin, "The TIN");
  } catch (const InvalidInput& e) {
    return e.what();
  }
  return "none";
}

TEST(Clean, LeavesAGoodTinAlone) {
  const Tin tin = clean(testing::box({0, 0, 0}, {1, 2, 3}), "The TIN");
  EXPECT_TRUE(tin.notes.empty()) << all_notes(tin);
  EXPECT_EQ(tin.faces, testing::box({0, 0, 0}, {1, 2, 3}).faces);
}

TEST(Clean, RefusesWhatCannotBeMended) {
  Tin tin = testing::triangle();
  tin.faces.push_back({0, 1, 3});
  EXPECT_TRUE(
      says(complaint(tin), "The TIN: face 1 (counted from 0) has vertex 3; there are vertices 0 to 2"));
  tin.faces.back() = {0, -1, 2};
  EXPECT_TRUE(says(complaint(tin), "has vertex -1"));
  tin = testing::triangle();
  tin.vertices[1].z = std::nan("");
  EXPECT_TRUE(says(complaint(tin), "vertex 1 (counted from 0) of face 0 lies at (10, 0, nan)"));
  tin.vertices[1] = {1e300, 0, 0};
  EXPECT_TRUE(says(complaint(tin), "within 1e9"));
  EXPECT_TRUE(says(complaint(Tin{}), "no vertices"));
  EXPECT_TRUE(says(complaint(tin_of({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, {{0, 1, 2}, {1, 1, 2}})),
                   "no face with an area"));
}

TEST(Clean, JoinsASoup) {
  // A square as two separate triangles, the second turned over; vertex attributes follow the first of each
  // place.
  Tin tin =
      tin_of({{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, -0.0, 1}, {0, 1, 1}, {1, 1, 1}}, {{0, 1, 2}, {3, 4, 5}});
  tin.sigma_v = {0, 1, 2, 3, 4, 5};
  tin.vertex_attributes = {{"id", {0, 1, 2, 3, 4, 5}}};
  tin = clean(tin, "The TIN");
  EXPECT_EQ(tin.vertices.size(), 4U);
  EXPECT_EQ(tin.vertex_attributes[0].values, (std::vector<float>{0, 1, 2, 4}));
  EXPECT_EQ(tin.sigma_v, (std::vector<float>{0, 1, 2, 4}));
  EXPECT_EQ(topology_of(tin).border_edges, 4U);
  EXPECT_TRUE(says(all_notes(tin), "2 vertices joined"));
  EXPECT_TRUE(says(all_notes(tin), "1 face turned"));
}

TEST(Clean, DropsFlatRepeatedAndUnused) {
  Tin tin = tin_of({{0, 0, 0}, {std::nan(""), 0, 0}, {10, 0, 0}, {0, 10, 0}, {5, 0, 0}},
                   {{0, 2, 3}, {2, 2, 3}, {0, 4, 2}, {3, 0, 2}, {0, 3, 2}});
  tin.face_attributes = {{"n", {0, 1, 2, 3, 4}}};
  tin = clean(tin, "The TIN");
  EXPECT_EQ(tin.faces, (std::vector<Face>{{0, 1, 2}}));
  EXPECT_EQ(tin.vertices, (std::vector<Xyz>{{0, 0, 0}, {10, 0, 0}, {0, 10, 0}}));
  EXPECT_EQ(tin.face_attributes[0].values, (std::vector<float>{0}));
  EXPECT_TRUE(says(all_notes(tin), "2 faces without area"));
  EXPECT_TRUE(says(all_notes(tin), "2 repeated faces"));
  EXPECT_TRUE(says(all_notes(tin), "1 vertex of no face"));
}

TEST(Clean, TellsOfEdgesWithThreeFaces) {
  const Tin tin = clean(
      tin_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}),
      "The TIN");
  EXPECT_TRUE(says(all_notes(tin), "1 edge shared by more than two faces"));
  EXPECT_EQ(tin.faces.size(), 3U);
}

TEST(Clean, KeepsNeedlesWithAnArea) {
  EXPECT_EQ(clean(tin_of({{0, 0, 0}, {1000, 0, 0}, {500, 1e-6, 0}}, {{0, 1, 2}}), "The TIN").faces.size(),
            1U);
}

}  // namespace
}  // namespace sightbound
