// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "support/random_dem.h"
#include "volume/error_volume.h"

namespace sightbound {
namespace {

using testing::random_dem;
using testing::RandomDem;

constexpr unsigned kScenes = 60;

ErrorVolume volume_of(const RandomDem& dem, double voxel, double height = 0, int threads = 1) {
  Progress progress;
  VolumeOptions options;
  options.voxel_m = voxel;
  options.voxel_height_m = height;
  options.threads = threads;
  return ErrorVolume::build(dem.surface(), options, progress);
}

double voxel_for(unsigned seed) { return std::array{0.7, 1.3, 2.0, 3.7, 9.0}[seed % 5]; }

// Places of a voxel: corners, edges, faces and the inside.
struct Places {
  std::mt19937 random;
  std::uniform_real_distribution<double> unit{-0.3, 1.3};

  double along(int i, double side) { return (i + std::clamp(unit(random), 0.0, 1.0)) * side; }
};

TEST(ColumnFill, BoundsHoldEveryPlace) {
  std::size_t judged = 0, in_band = 0;
  for (unsigned seed = 0; seed < kScenes; ++seed) {
    const RandomDem dem = random_dem(seed);
    const double side = voxel_for(seed), height = seed % 4 == 0 ? side / 2 : side;
    const ErrorVolume volume = volume_of(dem, side, height);
    const double most = volume.largest_ratio();
    Places places{std::mt19937(seed)};
    const int across = static_cast<int>(volume.surface().bounds().high.x / side) + 1;
    const int down = static_cast<int>(volume.surface().bounds().high.y / side) + 1;
    for (int i = 0; i < across; ++i) {
      for (int j = 0; j < down; ++j) {
        const Voxel low = volume.voxel_of({0, 0, -60}), high = volume.voxel_of({0, 0, 30});
        for (int k = low.k; k <= high.k; ++k) {
          const RatioInterval bounds = volume.at({i, j, k});
          ASSERT_LE(bounds.low, bounds.high);
          for (int n = 0; n < 3; ++n) {
            const double x = places.along(i, side), y = places.along(j, side), z = places.along(k, height);
            const double ratio = dem.k(x, y, z);
            if (std::isnan(ratio)) continue;
            ++judged;
            in_band += std::abs(ratio) < volume.largest_ratio();
            // What is beyond K is only said to be so.
            ASSERT_LE(std::min(static_cast<double>(bounds.low), most), std::max(ratio, -most))
                << "seed " << seed << " voxel " << i << ' ' << j << ' ' << k;
            ASSERT_GE(std::max(static_cast<double>(bounds.high), -most), std::min(ratio, most))
                << "seed " << seed << " voxel " << i << ' ' << j << ' ' << k;
          }
        }
      }
    }
  }
  EXPECT_GT(judged, 100000u);
  EXPECT_GT(in_band, 20000u);
}

// Without error between the samples the bounds are those of some place, but for the rounding of a half float.
TEST(ColumnFill, BoundsAreReached) {
  RandomDem dem = random_dem(1);
  dem.shape = GeologicShape::kGaussian;
  std::fill(dem.amplitude.begin(), dem.amplitude.end(), 0.0);
  for (double& s : dem.sampling) s += 1;
  const double side = 1.3;
  const ErrorVolume volume = volume_of(dem, side);
  std::size_t voxels = 0;
  const Box3 box = volume.surface().bounds();
  for (int i = 0; (i + 1) * side < box.high.x; ++i) {
    for (int j = 0; (j + 1) * side < box.high.y; ++j) {
      if (volume.unknown_columns().at(i, j)) continue;
      for (int k = -40; k < 20; ++k) {
        const RatioInterval bounds = volume.at({i, j, k});
        if (static_cast<double>(bounds.high) >= volume.largest_ratio() ||
            static_cast<double>(bounds.low) <= -volume.largest_ratio())
          continue;
        double low = 1e9, high = -1e9;
        constexpr int kSteps = 26;
        for (int u = 0; u <= kSteps; ++u) {
          for (int v = 0; v <= kSteps; ++v) {
            const double x = (i + u / double{kSteps}) * side, y = (j + v / double{kSteps}) * side;
            low = std::min(low, dem.k(x, y, k * side));
            high = std::max(high, dem.k(x, y, (k + 1) * side));
          }
        }
        ++voxels;
        EXPECT_NEAR(static_cast<double>(bounds.low), low, 0.05 + 0.002 * std::abs(low));
        EXPECT_NEAR(static_cast<double>(bounds.high), high, 0.05 + 0.002 * std::abs(high));
      }
    }
  }
  EXPECT_GT(voxels, 500u);
}

TEST(ColumnFill, BandInsideAndOutside) {
  const RandomDem dem = random_dem(2);
  const ErrorVolume volume = volume_of(dem, 2);
  const float end = volume.beyond_ratio();
  const Voxel middle =
      volume.voxel_of({volume.surface().bounds().high.x / 2, volume.surface().bounds().high.y / 2, 0});
  EXPECT_EQ(volume.at({middle.i, middle.j, 500}), (RatioInterval{end, end}));
  EXPECT_EQ(volume.at({middle.i, middle.j, -500}), (RatioInterval{-end, -end}));
  EXPECT_EQ(volume.at({middle.i, middle.j, -5000}), (RatioInterval{-end, -end}));
  EXPECT_EQ(volume.at({-50, middle.j, 0}), (RatioInterval{end, end}));
}

TEST(ColumnFill, UnknownColumnsAreThoseWithoutTerrainSomewhere) {
  for (unsigned seed = 0; seed < kScenes; ++seed) {
    const RandomDem dem = random_dem(seed);
    const double side = voxel_for(seed);
    const ErrorVolume volume = volume_of(dem, side);
    const PlanMask& unknown = volume.unknown_columns();
    for (int i = -1; i <= unknown.cols(); ++i) {
      for (int j = -1; j <= unknown.rows(); ++j) {
        bool missing = false;
        for (int n = 0; n < 300; ++n) {  // inner places: touching terrain that is missing is not enough
          const double x = (i + 0.001 + 0.998 * (n % 17) / 16) * side,
                       y = (j + 0.001 + 0.998 * (n / 17) / 17) * side;
          missing = missing || std::isnan(dem.place(x, y).height);
        }
        if (missing) {
          ASSERT_TRUE(unknown.at(i, j)) << seed << ": " << i << ' ' << j;
        }
        if (unknown.at(i, j) && !missing) {  // a corner of it only, missed by the places looked at
          const double x0 = i * side, y0 = j * side, x1 = x0 + side, y1 = y0 + side;
          bool corner = false;
          for (const double x : {x0, x1}) {
            for (const double y : {y0, y1}) {
              corner =
                  corner ||
                  std::isnan(dem.place(x + 1e-5 * (x0 + x1 - 2 * x), y + 1e-5 * (y0 + y1 - 2 * y)).height);
            }
          }
          ASSERT_TRUE(corner) << seed << ": " << i << ' ' << j;
        }
      }
    }
  }
}

TEST(ColumnFill, SameForAnyNumberOfThreads) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const RandomDem dem = random_dem(seed);
    const ErrorVolume one = volume_of(dem, 0.3, 0, 1), two = volume_of(dem, 0.3, 0, 2);
    for (const double c : {0.5, 0.95}) {
      EXPECT_TRUE(one.inner(c) == two.inner(c));
      EXPECT_TRUE(one.outer(c) == two.outer(c));
    }
    EXPECT_EQ(one.report().voxels, two.report().voxels);
    one.outer(0.99).for_each([&](const Voxel& low, const Voxel& high) {
      for (Voxel v = low; v.k <= high.k; ++v.k) ASSERT_EQ(one.at(v), two.at(v));
    });
  }
}

}  // namespace
}  // namespace sightbound
