// SPDX-License-Identifier: GPL-3.0-or-later
// Error rasters on the DEM's grid. A linear field survives bilinear resampling, so its closed form is the
// oracle wherever the grids and CRS differ.
#include <cmath>
#include <memory>
#include <optional>

#include <gtest/gtest.h>

#include "base/error.h"
#include "io/error_rasters.h"
#include "io/raster_dem.h"
#include "support/raster_files.h"
#include "support/says.h"
#include "support/scratch.h"

namespace sightbound {
namespace {

using testing::make_raster;
using testing::RasterFileSpec;
using testing::says;

constexpr std::array<double, 6> kNorthUp{500000, 10, 0, 5000000, 0, -10};
constexpr std::array<double, 6> kSouthUp{500000, 10, 0, 4999700, 0, 10};
constexpr int kSide = 30;

// sigma = 1 + 0.002 east + 0.003 south, metres from the DEM's corner.
double field(double x, double y) { return 1 + 0.002 * (x - 500000) + 0.003 * (5000000 - y); }

RasterFileSpec sampled(const std::array<double, 6>& g, int rows, int cols,
                       const std::string& crs = "EPSG:32632") {
  RasterFileSpec spec{.rows = rows, .cols = cols, .geotransform = g, .crs = crs};
  const Geotransform place(g);
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c)
      spec.values.push_back(field(place.of_sample(c, r).x, place.of_sample(c, r).y));
  }
  return spec;
}

class AlignedRasterTest : public testing::Scratch {
 protected:
  std::unique_ptr<DemSource> dem(const std::array<double, 6>& g = kNorthUp,
                                 const std::string& crs = "EPSG:32632") {
    RasterFileSpec spec{.rows = kSide, .cols = kSide, .geotransform = g, .crs = crs};
    return open_dem(make_raster(spec, path("dem.tif")));
  }

  Grid<float> aligned(const RasterFileSpec& spec, const DemSource& on, const Window& window, int band = 1) {
    Progress progress;
    return aligned_raster({make_raster(spec, path("sigma.tif")), band}, on, window, progress);
  }

  void expect_field(const Grid<float>& got, const DemSource& on, const Window& window, double tolerance) {
    ASSERT_EQ(got.rows(), window.rows);
    ASSERT_EQ(got.cols(), window.cols);
    for (int r = 0; r < window.rows; ++r) {
      for (int c = 0; c < window.cols; ++c) {
        const Xy at = on.geotransform().of_sample(window.col + c, window.row + r);
        ASSERT_NEAR(got.at(r, c), field(at.x, at.y), tolerance) << r << " " << c;
      }
    }
  }
};

constexpr Window kWindow{4, 6, 20, 15};

TEST_F(AlignedRasterTest, TheSameGridInEveryOrder) {
  for (const auto& dem_place : {kNorthUp, kSouthUp}) {
    for (const auto& place : {kNorthUp, kSouthUp}) {
      const auto on = dem(dem_place);
      expect_field(aligned(sampled(place, kSide, kSide), *on, kWindow), *on, kWindow, 1e-6);
    }
  }
}

TEST_F(AlignedRasterTest, APartOfTheGridLeavesTheRestUnknown) {
  const auto on = dem();
  const RasterFileSpec part = sampled({500100, 10, 0, 4999900, 0, -10}, 8, 8);  // columns and rows 10 to 17
  const Grid<float> got = aligned(part, *on, on->window());
  for (int r = 0; r < kSide; ++r) {
    for (int c = 0; c < kSide; ++c) {
      const bool inside = r >= 10 && r < 18 && c >= 10 && c < 18;
      ASSERT_EQ(std::isnan(got.at(r, c)), !inside) << r << " " << c;
    }
  }
  const auto turned = dem(kSouthUp);
  EXPECT_FALSE(std::isnan(aligned(part, *turned, turned->window()).at(10, 10)));
}

TEST_F(AlignedRasterTest, OtherCellSizes) {
  for (const auto& place : {kNorthUp, kSouthUp}) {
    const auto on = dem(place);
    const RasterFileSpec coarse = sampled({499800, 37, 0, 5000200, 0, -41}, 30, 30);
    expect_field(aligned(coarse, *on, kWindow), *on, kWindow, 1e-4);
    const RasterFileSpec shifted = sampled({499903, 10, 0, 5000103, 0, -10}, 60, 60);
    expect_field(aligned(shifted, *on, kWindow), *on, kWindow, 1e-4);
  }
}

TEST_F(AlignedRasterTest, ACoarseRasterOfTheSameExtentIsKnownToItsEdges) {
  const auto on = dem();
  for (const std::optional<double>& nodata : {std::optional<double>(), std::optional<double>(-1)}) {
    RasterFileSpec coarse = sampled({500000, 60, 0, 5000000, 0, -60}, 5, 5);
    coarse.nodata = nodata;
    const Grid<float> got = aligned(coarse, *on, on->window());
    for (const float sigma : got.values()) ASSERT_FALSE(std::isnan(sigma));
    EXPECT_NEAR(got.at(15, 15), field(500155, 4999845), 1e-4);
    EXPECT_NEAR(got.at(0, 0), field(500030, 4999970), 1e-4);  // flat beyond the last centres
  }
}

TEST_F(AlignedRasterTest, HolesStayHoles) {
  const auto on = dem();
  RasterFileSpec coarse = sampled({500000, 60, 0, 5000000, 0, -60}, 5, 5);
  for (const double hole : {-1.0, static_cast<double>(NAN)}) {
    coarse.nodata = std::isnan(hole) ? std::nullopt : std::optional<double>(hole);
    coarse.values[12] = hole;  // the middle one: rows and columns 12 to 17 of the DEM
    const Grid<float> got = aligned(coarse, *on, on->window());
    EXPECT_TRUE(std::isnan(got.at(15, 15)));
    EXPECT_FALSE(std::isnan(got.at(3, 3)));
    EXPECT_FALSE(std::isnan(got.at(15, 26)));
  }
}

TEST_F(AlignedRasterTest, RotatedGrids) {
  const auto on = dem();
  const RasterFileSpec turned = sampled({499500, 16, 12, 5000000, 12, -16}, 60, 60);
  expect_field(aligned(turned, *on, kWindow), *on, kWindow, 2e-3);
  const auto rotated_dem = dem({500000, 8, 6, 5000000, 6, -8});
  const RasterFileSpec plain = sampled({499800, 20, 0, 5000400, 0, -20}, 60, 60);
  expect_field(aligned(plain, *rotated_dem, kWindow), *rotated_dem, kWindow, 2e-3);
}

TEST_F(AlignedRasterTest, AnotherCrs) {
  // Degrees around the DEM (500000, 5000000 in zone 32 lies on 9 E); a field linear in degrees there is
  // linear to 1e-4 here.
  const auto on = dem();
  RasterFileSpec degrees{.rows = 40, .cols = 40, .geotransform = {{8.995, 0.0005, 0, 45.158, 0, -0.0005}}};
  degrees.crs = "EPSG:4326";
  for (int r = 0; r < 40; ++r) {
    for (int c = 0; c < 40; ++c) degrees.values.push_back(1 + 100 * (0.0005 * (c + 0.5) - 0.005));
  }
  const Grid<float> got = aligned(degrees, *on, kWindow);
  for (int c = 0; c < kWindow.cols; ++c) {
    const double metres_east = 10 * (kWindow.col + c + 0.5);
    ASSERT_NEAR(got.at(7, c), 1 + 100 * metres_east / 0.9996 / 78848, 1e-3)
        << c;  // a degree is 78.85 km here
  }
}

TEST_F(AlignedRasterTest, WithoutACrsTheDemsIsMeant) {
  const auto on = dem();
  expect_field(aligned(sampled(kNorthUp, kSide, kSide, ""), *on, kWindow), *on, kWindow, 1e-6);
  expect_field(aligned(sampled({499800, 37, 0, 5000200, 0, -41}, 30, 30, ""), *on, kWindow), *on, kWindow,
               1e-4);
  const auto nowhere = dem(kNorthUp, "");
  expect_field(aligned(sampled(kNorthUp, kSide, kSide), *nowhere, kWindow), *nowhere, kWindow, 1e-6);
}

TEST_F(AlignedRasterTest, CompoundCrsIsTheSamePlace) {
  const auto on = dem(kNorthUp, "EPSG:32632+5773");
  expect_field(aligned(sampled(kNorthUp, kSide, kSide), *on, kWindow), *on, kWindow, 1e-6);
}

TEST_F(AlignedRasterTest, NodataScaleAndUnit) {
  const auto on = dem();
  RasterFileSpec packed{.rows = kSide,
                        .cols = kSide,
                        .type = GDT_Int16,
                        .geotransform = kNorthUp,
                        .nodata = -1,
                        .scale = 0.5,
                        .unit = "cm"};
  packed.values.assign(kSide * kSide, 300);
  packed.values[0] = -1;
  const Grid<float> plain = aligned(packed, *on, on->window());
  EXPECT_TRUE(std::isnan(plain.at(0, 0)));
  EXPECT_FLOAT_EQ(plain.at(5, 5), 1.5F);

  packed.geotransform = {{499990, 11, 0, 5000010, 0, -11}};
  const Grid<float> warped = aligned(packed, *on, on->window());
  EXPECT_FLOAT_EQ(warped.at(5, 5), 1.5F);
}

TEST_F(AlignedRasterTest, BytesAreNotRoundedWhenResampled) {
  const auto on = dem();
  RasterFileSpec bytes{.rows = 2,
                       .cols = 2,
                       .values = {0, 10, 0, 10},
                       .type = GDT_Byte,
                       .geotransform = {{500000, 150, 0, 5000000, 0, -150}}};
  const Grid<float> got = aligned(bytes, *on, on->window());
  EXPECT_NEAR(got.at(15, 12), 10.0 * (125 - 75) / 150, 1e-4);
}

TEST_F(AlignedRasterTest, TheBandAskedFor) {
  const auto on = dem();
  RasterFileSpec two{.rows = kSide, .cols = kSide, .geotransform = kNorthUp, .bands = 2};
  EXPECT_EQ(aligned(two, *on, on->window(), 2).at(0, 1), 1001);
  two.geotransform = {{499990, 11, 0, 5000010, 0, -11}};
  EXPECT_GE(aligned(two, *on, on->window(), 2).at(0, 1), 1000);
}

TEST_F(AlignedRasterTest, Refusals) {
  const auto on = dem();
  const auto refusal = [&](const RasterFileSpec& spec) -> std::string {
    try {
      aligned(spec, *on, on->window());
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  RasterFileSpec negative{.rows = kSide, .cols = kSide, .geotransform = kNorthUp};
  negative.values.assign(kSide * kSide, 1);
  negative.values[7] = -9999;
  EXPECT_TRUE(says(refusal(negative), "1 negative values"));
  EXPECT_TRUE(says(refusal(sampled({700000, 10, 0, 5000000, 0, -10}, 30, 30)), "no value anywhere"));
  EXPECT_TRUE(says(refusal(sampled({700000, 11, 0, 5000000, 0, -11}, 30, 30)), "no value anywhere"));
  EXPECT_TRUE(says(refusal({.geotransform = {}}), "no georeference"));
  Progress progress;
  EXPECT_THROW(aligned_raster({path("missing.tif"), 1}, *on, on->window(), progress), IoError);
  EXPECT_THROW(aligned(sampled(kNorthUp, kSide, kSide), *on, on->window(), 2), InvalidInput);
}

TEST_F(AlignedRasterTest, Cancels) {
  const auto on = dem();
  for (const double cell : {10.0, 11.0}) {
    const std::string file =
        make_raster(sampled({500000, cell, 0, 5000000, 0, -cell}, 30, 30), path("sigma.tif"));
    Progress progress([](double) { return false; });
    EXPECT_THROW(aligned_raster({file, 1}, *on, on->window(), progress), Cancelled);
  }
}

}  // namespace
}  // namespace sightbound
