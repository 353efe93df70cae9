// SPDX-License-Identifier: GPL-3.0-or-later
// Whatever the unit of the heights, metres come out, and the report says what was converted or assumed.
#include <string>

#include <gtest/gtest.h>

#include "base/error.h"
#include "io/raster_dem.h"
#include "support/raster_files.h"
#include "support/says.h"
#include "support/scratch.h"

namespace sightbound {
namespace {

using testing::RasterFileSpec;
using testing::says;

constexpr double kFoot = 0.3048, kUsFoot = 1200.0 / 3937.0;

class VerticalUnitTest : public testing::Scratch {
 protected:
  // Metres of a stored height of 1000.
  float metres(const RasterFileSpec& wanted, VerticalUnit unit = VerticalUnit::kAuto) {
    RasterFileSpec spec = wanted;
    spec.rows = spec.cols = 2;
    spec.values = {1000, 1000, 1000, 1000};
    const auto dem = open_dem(testing::make_raster(spec, path("dem.tif")), 1, unit);
    notes_.clear();
    for (const std::string& note : dem->notes()) notes_ += note + "\n";
    Progress progress;
    return dem->read(dem->window(), progress).at(0, 0);
  }
  std::string notes_;
};

TEST_F(VerticalUnitTest, MetresWhereNothingIsSaid) {
  EXPECT_EQ(metres({}), 1000);
  EXPECT_EQ(notes_, "");
}

TEST_F(VerticalUnitTest, UnitOfTheBand) {
  for (const char* name : {"m", "metre", "Meters", "METRES"}) EXPECT_EQ(metres({.unit = name}), 1000) << name;
  for (const char* name : {"ft", "foot", "Feet"})
    EXPECT_FLOAT_EQ(metres({.unit = name}), 1000 * kFoot) << name;
  for (const char* name : {"us-ft", "US survey foot", "ftUS"}) {
    EXPECT_FLOAT_EQ(metres({.unit = name}), 1000 * kUsFoot) << name;
  }
  EXPECT_FLOAT_EQ(metres({.unit = "mm"}), 1);
}

TEST_F(VerticalUnitTest, UInt16Centimetres) {
  EXPECT_FLOAT_EQ(metres({.type = GDT_UInt16, .unit = "cm"}), 10);
  EXPECT_TRUE(says(notes_, "1 unit = 0.01 m: the band's unit is 'cm'"));
  // How values are packed wins over what the vertical CRS measures in.
  EXPECT_FLOAT_EQ(metres({.type = GDT_UInt16, .crs = "EPSG:25832+7837", .unit = "cm"}), 10);
}

TEST_F(VerticalUnitTest, UnknownUnitsAreSaid) {
  EXPECT_EQ(metres({.unit = "furlong"}), 1000);
  EXPECT_TRUE(says(notes_, "'furlong' is unknown"));
}

TEST_F(VerticalUnitTest, VerticalPartOfACompoundCrs) {
  EXPECT_EQ(metres({.crs = "EPSG:25832+7837"}), 1000);  // DHHN2016, metres
  EXPECT_EQ(notes_, "");
  EXPECT_FLOAT_EQ(metres({.crs = "EPSG:2263+6360"}), 1000 * kUsFoot);  // New York, all in US survey feet
  EXPECT_TRUE(says(notes_, "US survey foot"));
  EXPECT_FLOAT_EQ(metres({.crs = "EPSG:2263+5703"}), 1000);  // feet in x and y, metres in z
  EXPECT_EQ(notes_, "");
  EXPECT_FLOAT_EQ(metres({.crs = "EPSG:26910+8228"}), 1000 * kFoot);  // metres in x and y, feet in z
}

TEST_F(VerticalUnitTest, VerticalCrsWinsOverTheBandAndSaysSo) {
  EXPECT_FLOAT_EQ(metres({.crs = "EPSG:26910+8228", .unit = "m"}), 1000 * kFoot);
  EXPECT_TRUE(says(notes_, "the CRS was followed"));
}

TEST_F(VerticalUnitTest, FeetOnTheGroundAloneAreAmbiguous) {
  EXPECT_EQ(metres({.crs = "EPSG:2994"}), 1000);  // Oregon, feet, nothing about heights
  EXPECT_TRUE(says(notes_, "Nothing says the unit of the heights"));
  EXPECT_TRUE(says(notes_, "Set the vertical unit"));
  EXPECT_FLOAT_EQ(metres({.crs = "EPSG:2994"}, VerticalUnit::kFoot), 1000 * kFoot);
  EXPECT_TRUE(says(notes_, "set by the user"));
}

TEST_F(VerticalUnitTest, TheUsersUnitWins) {
  EXPECT_FLOAT_EQ(metres({.crs = "EPSG:2263+6360"}, VerticalUnit::kMetre), 1000);
  EXPECT_TRUE(says(notes_, "against the vertical CRS"));
  EXPECT_FLOAT_EQ(metres({.unit = "m"}, VerticalUnit::kUsSurveyFoot), 1000 * kUsFoot);
}

TEST_F(VerticalUnitTest, ScaleAndUnitTogether) {
  EXPECT_FLOAT_EQ(metres({.type = GDT_Int16, .scale = 0.1, .offset = 5.0, .unit = "ft"}), 105 * kFoot);
}

TEST(VerticalUnitNames, AreChecked) {
  EXPECT_EQ(vertical_unit_from("auto"), VerticalUnit::kAuto);
  EXPECT_EQ(metres_per(vertical_unit_from("metre")), 1);
  EXPECT_EQ(metres_per(vertical_unit_from("foot")), kFoot);
  EXPECT_EQ(metres_per(vertical_unit_from("us-foot")), kUsFoot);
  try {
    vertical_unit_from("yard");
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_TRUE(says(error.what(), "'us-foot'"));
  }
}

}  // namespace
}  // namespace sightbound
