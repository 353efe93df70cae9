// SPDX-License-Identifier: GPL-3.0-or-later
// The fitted frame against GeographicLib itself, on rasters in degrees (whose longitudes and latitudes need
// no projection).
#include <cmath>

#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/GeodesicLine.hpp>
#include <gtest/gtest.h>

#include "base/error.h"
#include "earth/observer_frame.h"

namespace sightbound {
namespace {

constexpr double kCell = 1.0 / 1200;  // degrees

Georeference degrees_at(double latitude) {
  return Georeference(Geotransform({10, kCell, 0, latitude, 0, -kCell}), Ellipsoid{},
                      [](std::span<double>, std::span<double>) {});
}

class FrameAt : public testing::TestWithParam<double> {};

TEST_P(FrameAt, knows_distance_and_azimuth) {
  const Georeference georeference = degrees_at(GetParam());
  const ObserverFrame frame(georeference, 0.3, 0.6, {-400, -300, 900, 700});
  const auto& wgs84 = GeographicLib::Geodesic::WGS84();
  const LonLat from = georeference.lon_lat(0.3, 0.6);
  for (const double col : {-390.0, -1.0, 0.0, 2.0, 499.0}) {
    for (const double row : {-299.0, 3.0, 398.0}) {
      const LonLat to = georeference.lon_lat(col, row);
      double distance, azimuth, back;
      wgs84.Inverse(from.lat, from.lon, to.lat, to.lon, distance, azimuth, back);
      const FramePlace place = frame.at(col, row);
      EXPECT_NEAR(place.distance(), distance, 1e-3);
      EXPECT_NEAR(std::remainder(place.azimuth_deg() - azimuth, 360), 0, 1e-3 / distance * 180);
    }
  }
}

TEST_P(FrameAt, follows_the_geodesic_within_a_hundred_thousandth_of_a_cell) {
  const Georeference georeference = degrees_at(GetParam());
  const ObserverFrame frame(georeference, 0, 0, {-400, -300, 900, 700});
  const auto& wgs84 = GeographicLib::Geodesic::WGS84();
  const LonLat from = georeference.lon_lat(0, 0);
  for (const auto& [col, row] : {std::pair{490.0, 120.0}, {-395.0, -250.0}, {30.0, 390.0}, {-200.0, 201.0}}) {
    const bool transposed = std::abs(row) > std::abs(col);
    const GeodesicPath path = frame.path_to(col, row, transposed);
    const LonLat to = georeference.lon_lat(col, row);
    const auto line = wgs84.InverseLine(from.lat, from.lon, to.lat, to.lon);
    for (const double xi : {0.1, 0.37, 0.5, 0.9}) {
      double lat, lon;
      line.Position(path.share(xi) * line.Distance(), lat, lon);
      const Xy at = georeference.geotransform().to_raster(lon, lat);
      EXPECT_NEAR(transposed ? at.y : at.x, xi * (transposed ? row : col), 1e-5);
      EXPECT_NEAR(transposed ? at.x : at.y, path.minor(xi), 1e-5);
    }
    EXPECT_LE(std::abs(path.minor(0.5) - path.chord(0.5)), path.largest_bow());
  }
}

TEST_P(FrameAt, gives_the_same_bulge_from_either_end) {
  const Georeference georeference = degrees_at(GetParam());
  const Window reach{-400, -300, 900, 700};
  const ObserverFrame here(georeference, 0, 0, reach);
  const ObserverFrame there(georeference.of_window({300, 200, 1, 1}), 0, 0, {-700, -500, 900, 700});
  EXPECT_NEAR(here.at(300, 200).bulge, there.at(-300, -200).bulge, 1e-4);
  const double distance = here.at(300, 200).distance();
  EXPECT_NEAR(here.at(300, 200).bulge, distance * distance / (2 * 6371e3), 0.01 * here.at(300, 200).bulge);
}

INSTANTIATE_TEST_SUITE_P(Latitudes, FrameAt, testing::Values(5.0, 60.0, 77.0, -45.0));

TEST(ObserverFrame, refuses_a_reach_that_leaves_the_earth) {
  EXPECT_THROW(ObserverFrame(degrees_at(89.9), 0, 0, {-10, -3000, 20, 3100}), InvalidInput);
}

TEST(ObserverFrame, is_straight_on_a_plane) {
  const ObserverFrame frame(Georeference(Geotransform({0, 10, 0, 0, 0, -10})), 0, 0, {-50, -50, 100, 100});
  EXPECT_TRUE(frame.is_straight());
  EXPECT_NEAR(frame.at(3, -4).distance(), 50, 1e-9);
}

}  // namespace
}  // namespace sightbound
