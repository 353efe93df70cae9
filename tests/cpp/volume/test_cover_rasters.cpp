// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/bodies.h"
#include "support/random_dem.h"
#include "volume/cover_rasters.h"
#include "volume/tin_surface.h"

namespace sightbound {
namespace {

// What the rasters say of each column, against every voxel asked one by one, well beyond the rasters' edges.
void expect_like_the_voxels(const ErrorVolume& volume, double confidence) {
  const CoverRasters rasters = rasters_of(volume, confidence);
  const VolumeMask cover = volume.outer(confidence);
  const VolumeFrame& frame = volume.surface().frame();
  const auto [west, step, skew, north, turn, down] = rasters.geotransform.coefficients();
  EXPECT_EQ(step, -down);
  const int first_i =
      static_cast<int>(std::lround((west - frame.x) * frame.metres_per_unit / volume.voxel_m()));
  const int last_j =
      static_cast<int>(std::lround((north - frame.y) * frame.metres_per_unit / volume.voxel_m())) - 1;
  const Box3 bounds = volume.surface().bounds();
  const int low = static_cast<int>(std::floor(bounds.low.z / volume.voxel_height_m())) - 200;
  const int high = static_cast<int>(std::ceil(bounds.high.z / volume.voxel_height_m())) + 200;
  std::size_t voxels = 0;
  for (int row = -3; row < rasters.lower.rows() + 3; ++row) {
    for (int col = -3; col < rasters.lower.cols() + 3; ++col) {
      int lowest = high + 1, highest = low - 1, count = 0;
      for (int k = low; k <= high; ++k) {
        if (!cover.contains({first_i + col, last_j - row, k})) continue;
        lowest = std::min(lowest, k);
        highest = std::max(highest, k);
        ++count;
      }
      voxels += static_cast<std::size_t>(count);
      if (row < 0 || col < 0 || row >= rasters.lower.rows() || col >= rasters.lower.cols()) {
        EXPECT_EQ(count, 0) << row << ' ' << col;
        continue;
      }
      if (count == 0) {
        EXPECT_TRUE(std::isnan(rasters.lower.at(row, col)) && std::isnan(rasters.upper.at(row, col)) &&
                    std::isnan(rasters.thickness.at(row, col)));
        continue;
      }
      const double height = volume.voxel_height_m();
      EXPECT_LE(static_cast<double>(rasters.lower.at(row, col)), lowest * height);
      EXPECT_GE(static_cast<double>(rasters.upper.at(row, col)), (highest + 1) * height);
      EXPECT_FLOAT_EQ(rasters.lower.at(row, col), static_cast<float>(lowest * height));
      EXPECT_FLOAT_EQ(rasters.upper.at(row, col), static_cast<float>((highest + 1) * height));
      EXPECT_FLOAT_EQ(rasters.thickness.at(row, col), static_cast<float>(count * height));
    }
  }
  EXPECT_EQ(voxels, cover.count()) << "all of them are over the rasters";
}

TEST(CoverRasters, OfHeightFields) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const testing::RandomDem dem = testing::random_dem(seed);
    VolumeOptions options;
    options.voxel_m = dem.spacing() / 3;
    options.voxel_height_m = options.voxel_m / 1.7;
    Progress progress;
    const ErrorVolume volume = ErrorVolume::build(dem.surface(), options, progress);
    expect_like_the_voxels(volume, 0.95);
    expect_like_the_voxels(volume, 0.3);
  }
}

TEST(CoverRasters, OfABridge) {
  Tin tin = testing::bridge(3);
  TinError error;
  error.sampling.assign(tin.vertices.size(), 0.7f);
  error.amplitude.assign(tin.vertices.size(), 0.0f);
  error.spacing_m = 5;
  VolumeOptions options;
  options.voxel_m = 1.5;
  Progress progress;
  const auto surface = std::make_shared<TinSurface>(std::move(tin), std::move(error), Metric::kNormal);
  const ErrorVolume volume = ErrorVolume::build(surface, options, progress);
  expect_like_the_voxels(volume, 0.9);
  EXPECT_THROW(rasters_of(volume, 1.0), InvalidInput);
}

}  // namespace
}  // namespace sightbound
