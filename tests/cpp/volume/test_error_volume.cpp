// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/bodies.h"
#include "support/random_dem.h"
#include "support/says.h"
#include "volume/error_volume.h"
#include "volume/tin_surface.h"

namespace sightbound {
namespace {

using testing::random_dem;
using testing::RandomDem;
using testing::says;

// The faces of a DEM as a TIN, with the same errors at the corners.
std::shared_ptr<const Surface> as_tin(const RandomDem& dem) {
  Tin tin;
  TinError error;
  tin.origin = {5e5, 5e6, 0};
  std::vector<std::int32_t> vertex(dem.height.size(), -1);
  const auto vertex_of = [&](int r, int c) {
    std::int32_t& v = vertex[dem.at(r, c)];
    if (v < 0) {
      v = static_cast<std::int32_t>(tin.vertices.size());
      tin.vertices.push_back({c * dem.cell_x, r * dem.cell_y, dem.height[dem.at(r, c)]});
      error.sampling.push_back(static_cast<float>(dem.sampling[dem.at(r, c)]));
      error.amplitude.push_back(static_cast<float>(dem.amplitude[dem.at(r, c)]));
    }
    return v;
  };
  for (int r = 0; r + 1 < dem.rows; ++r) {
    for (int c = 0; c + 1 < dem.cols; ++c) {
      const auto known = [&](int row, int col) { return !std::isnan(dem.height[dem.at(row, col)]); };
      if (!known(r, c) || !known(r + 1, c + 1)) continue;
      if (known(r, c + 1))
        tin.faces.push_back({vertex_of(r, c), vertex_of(r + 1, c + 1), vertex_of(r, c + 1)});
      if (known(r + 1, c))
        tin.faces.push_back({vertex_of(r, c), vertex_of(r + 1, c), vertex_of(r + 1, c + 1)});
    }
  }
  error.profile = {dem.shape, dem.range, dem.exponent, dem.spacing() / 2};
  error.spacing_m = dem.spacing();
  return std::make_shared<TinSurface>(std::move(tin), std::move(error), Metric::kVertical);
}

VolumeOptions voxels_of(double side) {
  VolumeOptions options;
  options.voxel_m = side;
  return options;
}

// Column by column and face by face: the same masks. Bounds are computed from the same corners, up to the
// rounding of the TIN's coordinates, which a half float may round apart: one step of a half, and masks by no
// more than the voxels that lie within it.
TEST(ErrorVolume, BuildersAgreeOnHeightFields) {
  std::size_t voxels = 0, differing = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    RandomDem dem = random_dem(seed);
    dem.ground_scale = 1;  // a TIN knows no other
    Progress progress;
    const double side = std::array{0.7, 1.3, 2.0}[seed % 3];
    const ErrorVolume columns = ErrorVolume::build(dem.surface(), voxels_of(side), progress);
    const ErrorVolume faces = ErrorVolume::build(as_tin(dem), voxels_of(side), progress);
    const Box3 &a = columns.surface().bounds(), &b = faces.surface().bounds();
    if (a.high.x != b.high.x || a.high.y != b.high.y) continue;  // a border of holes: another origin
    columns.outer(0.99).for_each([&](const Voxel& low, const Voxel& high) {
      for (int i = low.i; i <= high.i; ++i) {
        for (int j = low.j; j <= high.j; ++j) {
          for (int k = low.k; k <= high.k; ++k) {
            const RatioInterval p = columns.at({i, j, k}), q = faces.at({i, j, k});
            ++voxels;
            differing += !(p == q);
            ASSERT_NEAR(p.low, q.low, 0x1p-9 * std::max(std::abs(p.low), 0.01f) + 1e-4f) << seed;
            ASSERT_NEAR(p.high, q.high, 0x1p-9 * std::max(std::abs(p.high), 0.01f) + 1e-4f) << seed;
          }
        }
      }
    });
  }
  EXPECT_GT(voxels, 30000u);
  EXPECT_LT(differing, voxels / 100);
}

// Masks filled without bounds lie between those of the bounds, which are rounded outward.
TEST(ErrorVolume, CoversAgreeWithBounds) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const RandomDem dem = random_dem(seed);
    Progress progress;
    const ErrorVolume volume = ErrorVolume::build(dem.surface(), voxels_of(1.1), progress);
    for (const double c : {0.5, 0.95, 0.99}) {
      Progress again;
      const CoverMasks covers = build_covers(dem.surface(), c, voxels_of(1.1), again);
      const VolumeMask inner = volume.inner(c), outer = volume.outer(c);
      inner.for_each([&](const Voxel& v, const Voxel&) { EXPECT_TRUE(covers.inner.contains(v)); });
      covers.inner.for_each([&](const Voxel& v, const Voxel&) { EXPECT_TRUE(covers.outer.contains(v)); });
      covers.outer.for_each([&](const Voxel& v, const Voxel&) { EXPECT_TRUE(outer.contains(v)); });
      EXPECT_LE(outer.count(), covers.outer.count() + covers.outer.count() / 50 + 20);
      EXPECT_GE(inner.count() + covers.inner.count() / 20 + 20, covers.inner.count());
    }
  }
}

// No point of the volume is missed, none outside is held.
TEST(ErrorVolume, CoversHoldAndMissNothing) {
  std::size_t held = 0, touched = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    const RandomDem dem = random_dem(seed);
    Progress progress;
    const double side = 0.9;
    const CoverMasks covers = build_covers(dem.surface(), 0.95, voxels_of(side), progress);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    const Box3 box = dem.surface()->bounds();
    for (int n = 0; n < 2000; ++n) {
      const double x = unit(random) * box.high.x, y = unit(random) * box.high.y;
      const RandomDem::Place place = dem.place(x, y);
      if (std::isnan(place.height)) continue;
      const double z = place.height + place.sigma * (6 * unit(random) - 3),
                   k = (z - place.height) / place.sigma;
      const Voxel v{static_cast<int>(std::floor(x / side)), static_cast<int>(std::floor(y / side)),
                    static_cast<int>(std::floor(z / side))};
      if (std::abs(k) < 1.95996) {
        ++touched;
        ASSERT_TRUE(covers.outer.contains(v)) << seed;
      }
      if (covers.inner.contains(v)) {
        ++held;
        ASSERT_LE(std::abs(k), 1.959964) << seed;
      }
    }
  }
  EXPECT_GT(touched, 20000u);
  EXPECT_GT(held, 2000u);
}

// Figure 8 of the paper: an equilateral triangle, nothing known between the samples but that the ground rises
// by no more than Delta.
TEST(ErrorVolume, ThicknessGrowsAwayFromTheSamples) {
  double before = 0;
  for (const double delta : {0.5, 1.0, 2.0}) {
    const double side = 10;
    Tin tin;
    tin.vertices = {{0, 0, 5}, {side, 0, 5}, {side / 2, side * std::sqrt(3.0) / 2, 5}};
    tin.faces = {{0, 1, 2}};
    TinError error;
    error.sampling.assign(3, 0.1f);
    error.amplitude.assign(3, static_cast<float>(delta / kZ95));
    error.profile = {GeologicShape::kGaussian, 0, 1, side / 2};
    error.spacing_m = side;
    Progress progress;
    const double voxel = 0.1;
    const CoverMasks covers = build_covers(std::make_shared<TinSurface>(tin, error, Metric::kVertical), 0.95,
                                           voxels_of(voxel), progress);
    const auto thickness = [&](double x, double y) {
      int count = 0;
      for (int k = 0; k < 150; ++k) {
        count += covers.outer.contains({static_cast<int>(x / voxel), static_cast<int>(y / voxel), k});
      }
      return count * voxel;
    };
    const double corner = thickness(0.25, 0.1), edge = thickness(5.05, 0.15), middle = thickness(5.05, 2.85);
    EXPECT_LT(corner, edge);
    EXPECT_LE(edge, middle + 2 * voxel);  // the paper's f rises fast: P is nothing there for large Delta
    const double d = side / std::sqrt(3.0), share = 1 - std::exp(-0.5 * delta * delta * d * d);
    EXPECT_NEAR(middle, 2 * (kZ95 * 0.1 + delta * share), 3 * voxel);
    EXPECT_GT(middle, before);
    before = middle;
  }
}

TEST(ErrorVolume, RefusesWhatDoesNotFitAndSaysWhatWould) {
  const RandomDem dem = random_dem(1);
  VolumeOptions options = voxels_of(0.02);
  options.memory_bytes = 20 << 20;
  Progress progress;
  try {
    ErrorVolume::build(dem.surface(), options, progress);
    FAIL() << "built";
  } catch (const OverBudget& error) {
    const std::string text = error.what();
    EXPECT_TRUE(says(text, "voxels of 0.02 m"));
    const std::size_t at = text.find("voxel_m = ");
    ASSERT_NE(at, std::string::npos);
    options.voxel_m = std::stod(text.substr(at + 10));
    EXPECT_LT(options.voxel_m, 2);
  }
  const ErrorVolume volume = ErrorVolume::build(dem.surface(), options, progress);  // what it said does fit
  EXPECT_LE(volume.report().bytes, options.memory_bytes);
}

TEST(ErrorVolume, EstimatesItsNeed) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const RandomDem dem = random_dem(seed);
    Progress progress;
    const VolumeNeed need = estimate_need(*dem.surface(), voxels_of(0.15));
    const ErrorVolume volume = ErrorVolume::build(dem.surface(), voxels_of(0.15), progress);
    EXPECT_GT(static_cast<double>(need.bytes), 0.8 * static_cast<double>(volume.report().bytes));
    EXPECT_LT(static_cast<double>(need.bytes), 4 * static_cast<double>(volume.report().bytes) + 4e6);
  }
}

TEST(ErrorVolume, OptionsOutOfRangeAreNamed) {
  const auto surface = random_dem(1).surface();
  Progress progress;
  const auto refusal = [&](const VolumeOptions& options) {
    try {
      ErrorVolume::build(surface, options, progress);
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  VolumeOptions options = voxels_of(-1);
  EXPECT_TRUE(says(refusal(options), "voxel_m is -1"));
  options = voxels_of(std::nan(""));
  EXPECT_TRUE(says(refusal(options), "voxel_m"));
  options = voxels_of(1);
  options.confidence = 1;
  EXPECT_TRUE(says(refusal(options), "confidence is 1"));
  options.confidence = 0.99;
  options.largest_confidence = 0.9;
  EXPECT_TRUE(says(refusal(options), "largest_confidence"));
  options = voxels_of(1);
  options.alpha = 0.5;
  EXPECT_TRUE(says(refusal(options), "alpha is 0.5"));
  const ErrorVolume volume = ErrorVolume::build(surface, voxels_of(1), progress);
  EXPECT_THROW(volume.inner(0.99999), InvalidInput);
}

TEST(ErrorVolume, DefaultVoxelsHoldMostFaces) {
  RandomDem dem = random_dem(4);
  for (double& s : dem.sampling) s = 2;
  Progress progress;
  const ErrorVolume volume = ErrorVolume::build(dem.surface(), {}, progress);
  const VolumeReport& report = volume.report();
  EXPECT_LE(report.faces_not_held, report.faces / 10 + 1);
  EXPECT_GE(volume.voxel_m(), 0.099 * dem.spacing());
  EXPECT_LE(volume.voxel_m(), dem.spacing());
  if (report.faces_not_held > 0) {
    ASSERT_EQ(report.warnings.size(), 1u);
    EXPECT_TRUE(says(report.warnings[0], "faces are too steep"));
  }
  // A held face is held: inside each there is a voxel of the inner cover at every column.
  VolumeOptions fine;
  fine.voxel_m = report.finest_needed_m * 0.999;
  Progress again;
  const ErrorVolume all = ErrorVolume::build(dem.surface(), fine, again);
  EXPECT_EQ(all.report().faces_not_held, 0u);
}

TEST(ErrorVolume, CancelsWhileItBuilds) {
  Progress progress([](double) { return false; });
  EXPECT_THROW(ErrorVolume::build(random_dem(1).surface(), voxels_of(0.05), progress), Cancelled);
}

}  // namespace
}  // namespace sightbound
