// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "base/error.h"
#include "support/says.h"
#include "support/tins.h"
#include "terrain/tin.h"

namespace sightbound {
namespace {

using testing::says;
using testing::tin_of;

TEST(Tin, CoordinatesComeBackToTheLastBit) {
  const std::vector<Xyz> places{
      {416155.123456789, 5381556.987654321, 309.78}, {416255.1, 5381656.7, 1e-3}, {416200.3, 5381600.9, -5}};
  Tin tin = tin_of(places, {{0, 1, 2}});
  set_origin(tin, 1);
  EXPECT_EQ(tin.origin.x, 416205);
  EXPECT_EQ(tin.origin.z, 0);
  for (std::size_t i = 0; i < places.size(); ++i) EXPECT_EQ(tin.to_crs(tin.vertices[i]), places[i]);
}

TEST(Tin, FeetInPlanBecomeMetresHeightsStay) {
  Tin tin = tin_of({{1000, 2000, 10}, {1010, 2000, 20}, {1000, 2010, 30}}, {{0, 1, 2}});
  set_origin(tin, 0.3048);
  EXPECT_NEAR(length(Xyz{tin.vertices[1].x - tin.vertices[0].x, 0, 0}), 3.048, 1e-12);
  EXPECT_EQ(tin.vertices[2].z, 30);
  EXPECT_NEAR(tin.to_crs(tin.vertices[2]).y, 2010, 1e-9);
  const Xyz local = tin.from_crs({1010, 2000, 20});
  EXPECT_NEAR(local.x, tin.vertices[1].x, 1e-12);
}

TEST(Tin, MedianEdgeAndBounds) {
  const Tin tin = tin_of({{0, 0, 1}, {3, 0, 1}, {3, 4, 1}, {-5, 0, -2}}, {{0, 1, 2}});
  EXPECT_EQ(median_edge(tin), 4);  // of 3, 4, 5
  const Box3 box = bounds_of(tin);
  EXPECT_EQ(box.low, (Xyz{-5, 0, -2}));
  EXPECT_EQ(box.high, (Xyz{3, 4, 1}));
  EXPECT_EQ(normal_of(tin, tin.faces[0]), (Xyz{0, 0, 12}));
  EXPECT_THROW(median_edge(Tin{}), InvalidInput);
  EXPECT_THROW(bounds_of(Tin{}), InvalidInput);
}

TEST(Tin, SizesAreChecked) {
  const auto complaint = [](const Tin& tin) -> std::string {
    try {
      check_sizes(tin, "The TIN");
    } catch (const InvalidInput& e) {
      return e.what();
    }
    return "";
  };
  Tin tin = testing::triangle();
  EXPECT_EQ(complaint(tin), "");
  tin.sigma_v = {1, 2};
  EXPECT_TRUE(says(complaint(tin), "sigma_v has 2 values; it must have 3"));
  tin.sigma_v = {};
  tin.face_attributes = {{"slope", {1, 2}}};
  EXPECT_TRUE(says(complaint(tin), "face attribute 'slope' has 2 values; it must have 1"));
  EXPECT_TRUE(says(complaint(Tin{}), "The TIN has no vertices"));
  tin.faces = {};
  EXPECT_TRUE(says(complaint(tin), "no faces"));
}

}  // namespace
}  // namespace sightbound
