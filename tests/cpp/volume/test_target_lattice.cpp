// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/hidden_volumes.h"
#include "support/random_dem.h"
#include "support/says.h"
#include "volume/target_lattice.h"

namespace sightbound {
namespace {

using testing::complaint;
using testing::random_dem;
using testing::RandomDem;
using testing::says;

// Every centre above ground and up to the ceiling is asked, and no other.
TEST(TargetLattice, AboveTheGroundOfADem) {
  Progress progress;
  std::size_t none = 0, some = 0;
  for (unsigned seed = 0; seed < 30; ++seed) {
    const RandomDem dem = random_dem(seed);
    const LatticeOptions options{3.7, seed % 2 ? 0.0 : 1.3, 9};
    const auto lattice = lattice_above(*dem.surface(), options, Workers(2), progress);
    EXPECT_EQ(lattice->height_spacing_m, seed % 2 ? 2.25 : 1.3);
    for (int j = 0; j < lattice->ny; ++j) {
      for (int i = 0; i < lattice->nx; ++i) {
        const Xyz centre = lattice->centre(i, j, 0);
        const double ground = dem.place(centre.x, centre.y).height;
        const TargetColumn& column = lattice->column(i, j);
        ASSERT_EQ(std::isnan(ground), std::isnan(column.ground));
        if (std::isnan(ground)) {
          EXPECT_EQ(column.size(), 0);
          ++none;
          continue;
        }
        ++some;
        ASSERT_NEAR(column.ground, ground, 1e-4);
        EXPECT_GE(lattice->height_of(column.first), ground - 1e-6);
        EXPECT_LT(lattice->height_of(column.first - 1), ground + 1e-6);
        EXPECT_LE(lattice->height_of(column.last), ground + 9 + 1e-6);
        EXPECT_GT(lattice->height_of(column.last + 1), ground + 9 - 1e-6);
      }
    }
  }
  EXPECT_GT(none, 100u);
  EXPECT_GT(some, 1000u);
}

// One target a column, over the highest of the terrain.
TEST(TargetLattice, OneLayerFollowsTheGround) {
  Progress progress;
  for (unsigned seed = 0; seed < 10; ++seed) {
    const RandomDem dem = random_dem(seed);
    const auto layer = layer_above(*dem.surface(), 3.7, 1.8, Workers(2), progress);
    const auto above = lattice_above(*dem.surface(), {3.7, 0, 9}, Workers(2), progress);
    ASSERT_EQ(layer->nx, above->nx);
    ASSERT_EQ(layer->ny, above->ny);
    for (int j = 0; j < layer->ny; ++j) {
      for (int i = 0; i < layer->nx; ++i) {
        const Xyz centre = layer->centre(i, j, 0);
        EXPECT_EQ(centre.x, above->centre(i, j, 0).x);
        EXPECT_EQ(centre.y, above->centre(i, j, 0).y);
        const double ground = dem.place(centre.x, centre.y).height;
        ASSERT_EQ(layer->column(i, j).size(), std::isnan(ground) ? 0 : 1);
        if (!std::isnan(ground)) {
          ASSERT_NEAR(centre.z, ground + 1.8, 1e-4);
        }
      }
    }
  }
  const auto surface = random_dem(1).surface();
  const auto made = [&](double spacing, double height) {
    layer_above(*surface, spacing, height, Workers(1), progress);
  };
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { made(0, 2); }), "target_spacing is 0"));
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { made(5, 0); }), "target_height is 0"));
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { made(5, std::nan("")); }), "target_height"));
}

TEST(TargetLattice, OfOnePlaceIsThatPlace) {
  const Xyz place{0.1, -7.3, 123.456};
  const TargetLattice alone = lattice_of(place, 120);
  EXPECT_EQ(alone.targets(), 1u);
  EXPECT_EQ(alone.centre(0, 0, 0), place);
}

TEST(TargetLattice, RefusesNonsense) {
  Progress progress;
  const auto surface = random_dem(1).surface();
  const auto made = [&](LatticeOptions options) { lattice_above(*surface, options, Workers(1), progress); };
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { made({0, 0, 20}); }), "target_spacing is 0"));
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { made({10, 0, -1}); }), "target_ceiling is -1"));
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { made({10, 30, 20}); }), "at most the ceiling"));
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { made({std::nan(""), 0, 20}); }), "target_spacing"));
}

}  // namespace
}  // namespace sightbound
