// SPDX-License-Identifier: GPL-3.0-or-later
// Longitudes and latitudes of known places in every kind of CRS. Expected values: closed forms (degrees,
// grads, Web Mercator, poles) or worked examples of IOGP Guidance Note 7-2.
#include <cmath>
#include <memory>
#include <numbers>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "io/crs.h"
#include "support/says.h"

namespace sightbound {
namespace {

using testing::says;

constexpr double kPi = std::numbers::pi;

// A 3 x 3 array whose middle sample lies at (x, y), cells of `cell`.
ArrayDem dem_at(const std::string& crs, double x, double y, double cell) {
  static const std::vector<float> zeros(9, 0.0F);
  return ArrayDem(
      {.data = zeros.data(), .rows = 3, .cols = 3, .nodata = NAN, .metres_per_unit = 1, .owner = {}},
      Geotransform({x - 1.5 * cell, cell, 0, y + 1.5 * cell, 0, -cell}), crs);
}

LonLat place_of(const std::string& crs, double x, double y, double cell = 10) {
  return georeference_of(dem_at(crs, x, y, cell)).lon_lat(1, 1);
}

void expect_place(const LonLat& place, double lon, double lat, double tolerance = 1e-9) {
  EXPECT_NEAR(place.lon, lon, tolerance);
  EXPECT_NEAR(place.lat, lat, tolerance);
}

TEST(Crs, DegreesStayAsTheyAre) {
  expect_place(place_of("EPSG:4326", 11, 47, 0.001), 11, 47);  // axis order of EPSG is latitude first
  expect_place(place_of("EPSG:4258", -20.5, 77.25, 0.001), -20.5, 77.25);
  expect_place(place_of("OGC:CRS84", 11, 47, 0.001), 11, 47);
  expect_place(place_of("EPSG:4326", 286, 47, 0.001), 286, 47);  // 0 to 360
}

TEST(Crs, GradsBecomeDegrees) {
  // NTF (Paris): grads, on its own meridian.
  const LonLat place = place_of("EPSG:4807", 2, 52, 0.001);
  expect_place(place, 1.8, 46.8);
}

TEST(Crs, WebMercator) {
  const double r = 6378137;
  const LonLat place =
      place_of("EPSG:3857", r * 11 * kPi / 180, r * std::log(std::tan(kPi / 4 + 60 * kPi / 360)));
  expect_place(place, 11, 60);
}

TEST(Crs, TransverseMercatorWorkedExample) {
  // OSGB36 / British National Grid, GN 7-2, 3.5.3.1: 50d30m00s N, 0d30m00s E -> 577274.99, 69740.50.
  expect_place(place_of("EPSG:27700", 577274.99, 69740.50), 0.5, 50.5, 1e-6);
}

TEST(Crs, FeetOnTheGround) {
  // NAD27 / Texas South Central, GN 7-2, 3.1.1.1: 28d30m N, 96d00m W -> 2963503.91, 254759.80 US survey feet.
  expect_place(place_of("EPSG:32040", 2963503.91, 254759.80), -96, 28.5, 1e-6);
}

TEST(Crs, NorthingFirstInTheRegistryIsEastingFirstInRasters) {
  // Central meridian of NZTM.
  EXPECT_NEAR(place_of("EPSG:2193", 1600000, 5000000).lon, 173, 1e-9);
}

TEST(Crs, PolarStereographic) {
  expect_place({0, place_of("EPSG:3413", 0, 0).lat}, 0, 90);
  EXPECT_NEAR(place_of("EPSG:3413", 0, -1000000).lon, -45, 1e-9);
  EXPECT_NEAR(place_of("EPSG:3031", 0, 1000000).lon, 0, 1e-9);
}

TEST(Crs, EllipsoidIsTheCrssOwn) {
  const Ellipsoid airy = georeference_of(dem_at("EPSG:27700", 577275, 69740, 10)).ellipsoid();
  EXPECT_NEAR(airy.semi_major_m, 6377563.396, 1e-3);
  EXPECT_NEAR(1 / airy.flattening, 299.3249646, 1e-6);
  const Ellipsoid sphere =
      georeference_of(dem_at("+proj=longlat +R=1737400 +type=crs", 11, 47, 0.001)).ellipsoid();
  EXPECT_EQ(sphere.semi_major_m, 1737400);
  EXPECT_EQ(sphere.flattening, 0);
}

TEST(Crs, HorizontalPartOfCompoundAndBoundOnes) {
  expect_place(place_of("EPSG:27700+5701", 577274.99, 69740.50), 0.5, 50.5, 1e-6);
  expect_place(
      place_of("+proj=longlat +ellps=bessel +towgs84=598,74,418,0.2,0.05,-2.5,6.7 +type=crs", 11, 47, 0.001),
      11, 47);                                                 // on its own datum
  expect_place(place_of("EPSG:4979", 11, 47, 0.001), 11, 47);  // geographic with height
}

TEST(Crs, RotatedPole) {
  // The new pole at 39.25 N, 18 E of 180: the rotated origin is at 50.75 N, 18 E.
  const char* const wkt =
      "GEOGCRS[\"rotated\",BASEGEOGCRS[\"WGS 84\",DATUM[\"World Geodetic System 1984\",ELLIPSOID[\"WGS "
      "84\",6378137,298.257223563]]],DERIVINGCONVERSION[\"pole\",METHOD[\"PROJ ob_tran "
      "o_proj=longlat\"],PARAMETER[\"o_lat_p\",39.25],PARAMETER[\"o_lon_p\",0],PARAMETER[\"lon_0\",18]],CS["
      "ellipsoidal,2],"
      "AXIS[\"longitude\",east,ORDER[1],ANGLEUNIT[\"degree\",0.0174532925199433]],AXIS[\"latitude\",north,"
      "ORDER[2],"
      "ANGLEUNIT[\"degree\",0.0174532925199433]]]";
  expect_place(place_of(wkt, 0, 0, 0.01), 18, 50.75, 1e-6);
}

TEST(Crs, LocalCrsIsAPlaneInMetres) {
  const char* const feet =
      "ENGCRS[\"site\",EDATUM[\"site\"],CS[Cartesian,2],AXIS[\"x\",east,ORDER[1],LENGTHUNIT[\"foot\",0.3048]]"
      ","
      "AXIS[\"y\",north,ORDER[2],LENGTHUNIT[\"foot\",0.3048]]]";
  const Georeference plane = georeference_of(dem_at(feet, 1000, 1000, 100));
  EXPECT_TRUE(plane.is_plane());
  EXPECT_DOUBLE_EQ(larger_cell_side(plane, 3, 3), 30.48);
}

TEST(Crs, NoneIsAPlaneUnlessItLooksLikeDegrees) {
  EXPECT_TRUE(georeference_of(dem_at("", 1000, 1000, 10)).is_plane());
  EXPECT_TRUE(georeference_of(dem_at("", 10, 10, 1)).is_plane());  // coarse cells: a small scene in metres
  EXPECT_THROW(georeference_of(dem_at("", 11, 47, 0.001)), InvalidInput);
}

TEST(Crs, RefusesWhatHasNoMapCoordinates) {
  for (const char* crs : {"EPSG:5703", "EPSG:4978", "EPSG:999999", "nonsense"}) {
    try {
      georeference_of(dem_at(crs, 1000, 1000, 10));
      FAIL() << crs;
    } catch (const InvalidInput& error) {
      EXPECT_TRUE(says(error.what(), "CRS"));
    }
  }
}

TEST(Crs, DegreesUnderAProjectedCrsAreRefused) {
  try {
    georeference_of(dem_at("EPSG:32632", 11, 47, 0.001));
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_TRUE(says(error.what(), "look like degrees"));
    EXPECT_TRUE(says(error.what(), "WGS 84 / UTM zone 32N"));
  }
  EXPECT_THROW(georeference_of(dem_at("EPSG:3857", 11, 47, 0.001)), InvalidInput);  // in the Gulf of Guinea
  // Centimetre cells around the origin of a CRS made for a site.
  EXPECT_NO_THROW(georeference_of(dem_at("+proj=tmerc +lat_0=47 +lon_0=11 +type=crs", 11, 47, 0.05)));
}

TEST(Crs, PlacesOutsideTheProjectionAreNoNumbers) {
  const LonLat place = place_of("EPSG:32632", 1e12, 1e12);
  EXPECT_FALSE(std::isfinite(place.lon) && std::isfinite(place.lat));
  const Georeference wrong = georeference_of(dem_at("+proj=ortho +type=crs", 1e9, 1e9, 10));
  EXPECT_THROW(ground_cell_sizes(wrong, {0, 0, 3, 3}), InvalidInput);
}

TEST(Crs, ServesManyThreadsAtOnce) {
  const Georeference georeference = georeference_of(dem_at("EPSG:32632", 600000, 5200000, 10));
  const LonLat expected = georeference.lon_lat(1, 1);
  std::vector<std::jthread> threads;
  std::vector<int> wrong(4, 0);
  for (int& count : wrong) {
    threads.emplace_back([&] {
      for (int i = 0; i < 2000; ++i) {
        const LonLat place = georeference.lon_lat(1, 1);
        count += place.lon != expected.lon || place.lat != expected.lat;
      }
    });
  }
  threads.clear();
  EXPECT_EQ(wrong, std::vector<int>(4, 0));
}

TEST(CrsUnits, HorizontalAndVertical) {
  EXPECT_EQ(crs_units("EPSG:32632").horizontal_m, 1);
  EXPECT_FALSE(crs_units("EPSG:32632").vertical_m);
  EXPECT_FALSE(crs_units("EPSG:4326").horizontal_m);
  EXPECT_FALSE(crs_units("EPSG:4807").horizontal_m);
  EXPECT_DOUBLE_EQ(crs_units("EPSG:2994").horizontal_m.value(), 0.3048);
  EXPECT_DOUBLE_EQ(crs_units("EPSG:2263+6360").vertical_m.value(), 1200.0 / 3937.0);
  EXPECT_EQ(crs_units("EPSG:4979").vertical_m, 1);
  EXPECT_FALSE(crs_units("").vertical_m);
}

TEST(HorizontalCrs, DropsTheVerticalPart) {
  EXPECT_EQ(horizontal_crs(""), "");
  EXPECT_TRUE(says(horizontal_crs("EPSG:27700+5701"), "PROJCRS[\"OSGB36 / British National Grid\""));
  EXPECT_EQ(horizontal_crs("EPSG:27700+5701").find("VERTCRS"), std::string::npos);
  EXPECT_EQ(horizontal_crs("EPSG:4979").find("CS[ellipsoidal,3]"), std::string::npos);
}

}  // namespace
}  // namespace sightbound
