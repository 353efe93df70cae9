// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <fstream>
#include <sstream>

#include <gdal_priv.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "io/tin_crs.h"
#include "io/tin_reader.h"
#include "io/tin_writer.h"
#include "support/says.h"
#include "support/scratch.h"
#include "support/terrains.h"
#include "support/tins.h"

namespace sightbound {
namespace {

using testing::says;

class TinWriter : public testing::Scratch {
 protected:
  std::vector<std::string> write(const std::string& name, const Tin& tin,
                                 const TinWriteOptions& options = {}) {
    Progress progress;
    return write_tin(path(name), tin, options, progress);
  }
  Tin read(const std::string& name) {
    Progress progress;
    return read_tin(path(name), {}, progress);
  }
};

// Coordinates that no float32 holds.
Tin sample(const std::string& crs = "EPSG:32633") {
  TinSource source;
  source.tin = testing::tin_of({{416155.123456789, 5381556.987654321, 309.78},
                                {416165.1, 5381556.7, 1.0 / 3},
                                {416160.3, 5381566.9, -5},
                                {416150.1, 5381566, 7}},
                               {{0, 1, 2}, {0, 2, 3}});
  source.tin.sigma_v = {0.5F, std::nanf(""), 0.25F, 1};
  source.tin.vertex_attributes = {{"x", {1, 2, 3, 4}}, {"odd name", {5, 6, 7, 8}}};
  source.tin.face_attributes = {{"max_error", {0.125F, std::nanf("")}}};
  source.crs = crs;
  Progress progress;
  return make_tin(source, {}, "The TIN", progress);
}

std::vector<Xyz> places(const Tin& tin) {
  std::vector<Xyz> all;
  for (const Xyz& v : tin.vertices) all.push_back(tin.to_crs(v));
  return all;
}

TEST_F(TinWriter, PlyBringsEverythingBack) {
  for (const bool ascii : {false, true}) {
    EXPECT_TRUE(write("a.ply", sample(), {.ascii = ascii}).empty());
    const Tin back = read("a.ply");
    EXPECT_EQ(places(back), places(sample()));
    EXPECT_EQ(back.faces, sample().faces);
    EXPECT_EQ(back.crs_wkt, sample().crs_wkt);
    EXPECT_EQ(back.sigma_v[2], 0.25F);
    EXPECT_TRUE(std::isnan(back.sigma_v[1]));
    ASSERT_EQ(back.vertex_attributes.size(), 2U);
    EXPECT_EQ(back.vertex_attributes[0].name, "x_");
    EXPECT_EQ(back.vertex_attributes[1].name, "odd_name");
    EXPECT_EQ(back.vertex_attributes[1].values, (std::vector<float>{5, 6, 7, 8}));
    EXPECT_EQ(back.face_attributes[0].values[0], 0.125F);
    EXPECT_TRUE(std::isnan(back.face_attributes[0].values[1]));
    EXPECT_TRUE(back.notes.empty()) << testing::all_notes(back);
  }
  EXPECT_EQ(files(), (std::vector<std::string>{"a.ply"}));
}

TEST_F(TinWriter, ObjAnd2dmBringCoordinatesBack) {
  EXPECT_EQ(write("a.obj", sample()).size(), 2U);
  EXPECT_EQ(places(read("a.obj")), places(sample()));
  EXPECT_EQ(read("a.obj").crs_wkt, sample().crs_wkt);
  const auto warnings = write("a.2dm", sample());
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_TRUE(says(warnings[1], "set it when the layer is loaded"));
  EXPECT_EQ(places(read("a.2dm")), places(sample()));
  EXPECT_EQ(read("a.2dm").faces, sample().faces);
}

TEST_F(TinWriter, GeoPackage) {
  const auto warnings = write("my tin.gpkg", sample());
  ASSERT_EQ(warnings.size(), 1U);
  const Tin back = read("my tin.gpkg");
  EXPECT_EQ(back.faces.size(), 2U);
  EXPECT_EQ(places(back), places(sample()));
  EXPECT_TRUE(says(back.crs_wkt, "UTM zone 33N"));
  EXPECT_EQ(back.face_attributes.at(0).values[0], 0.125F);
  Progress progress;
  EXPECT_EQ(tin_layers(path("my tin.gpkg"), progress), (std::vector<std::string>{"my tin"}));
  EXPECT_EQ(files(), (std::vector<std::string>{"my tin.gpkg"}));
  EXPECT_TRUE(write("again.gpkg", read("my tin.gpkg")).empty());
  write("none.gpkg", sample(""));
  EXPECT_EQ(read("none.gpkg").crs_wkt, "");
  EXPECT_TRUE(says(testing::all_notes(read("none.gpkg")), "no CRS"));
}

// Through GDAL's own eyes; tests/python reads it with QGIS.
TEST_F(TinWriter, Ugrid) {
  EXPECT_TRUE(write("a.nc", sample()).empty());
  GDALAllRegister();
  const std::unique_ptr<GDALDataset> file(GDALDataset::Open(path("a.nc").c_str(), GDAL_OF_MULTIDIM_RASTER));
  ASSERT_TRUE(file);
  const auto root = file->GetRootGroup();
  const auto array = [&](const std::string& name) { return root->OpenMDArray(name); };
  ASSERT_TRUE(array("Mesh2d"));
  EXPECT_STREQ(array("Mesh2d")->GetAttribute("cf_role")->ReadAsString(), "mesh_topology");
  std::vector<double> x(4);
  const GUInt64 start[2] = {0, 0};
  const std::size_t count[2] = {4, 3};
  ASSERT_TRUE(
      array("Mesh2d_node_x")
          ->Read(start, count, nullptr, nullptr, GDALExtendedDataType::Create(GDT_Float64), x.data()));
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(x[i], places(sample())[i].x);
  std::vector<std::int32_t> corners(6);
  const std::size_t two[2] = {2, 3};
  ASSERT_TRUE(
      array("Mesh2d_face_nodes")
          ->Read(start, two, nullptr, nullptr, GDALExtendedDataType::Create(GDT_Int32), corners.data()));
  EXPECT_EQ(corners, (std::vector<std::int32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_TRUE(array("Mesh2d_sigma_v"));
  EXPECT_TRUE(array("Mesh2d_max_error"));
  EXPECT_EQ(files(), (std::vector<std::string>{"a.nc"}));
}

TEST_F(TinWriter, FeetGoOutAsFeet) {
  TinSource source;
  source.tin =
      testing::tin_of({{1000000, 200000, 10}, {1000100, 200000, 10}, {1000000, 200100, 20}}, {{0, 1, 2}});
  source.crs = "EPSG:2263";
  Progress progress;
  write("a.ply", make_tin(source, {}, "The TIN", progress));
  const Tin back = read("a.ply");
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(back.to_crs(back.vertices[i]).x, source.tin.vertices[i].x, 1e-6);
    EXPECT_EQ(back.vertices[i].z, source.tin.vertices[i].z);
  }
}

TEST_F(TinWriter, Refuses) {
  EXPECT_THROW(write("a.stl", sample()), InvalidInput);
  EXPECT_THROW(write("a", sample()), InvalidInput);
  EXPECT_THROW(write("missing/a.ply", sample()), IoError);
  EXPECT_THROW(write("a.ply", Tin{}), InvalidInput);
  write_text("kept.ply", "before");
  for (const char* name : {"kept.ply", "kept.obj", "kept.2dm", "kept.nc", "kept.gpkg"}) {
    Progress cancelled([](double) { return false; });
    EXPECT_THROW(write_tin(path(name), sample(), {}, cancelled), Cancelled) << name;
  }
  EXPECT_EQ(files(), (std::vector<std::string>{"kept.ply"}));
  std::ifstream kept(path("kept.ply"));
  std::stringstream text;
  text << kept.rdbuf();
  EXPECT_EQ(text.str(), "before");
}

TEST(TinCrs, NamesAndUnits) {
  EXPECT_EQ(metres_per_plan_unit(""), 1);
  EXPECT_NEAR(metres_per_plan_unit(crs_from_text("EPSG:2263")), 1200.0 / 3937, 1e-15);
  EXPECT_THROW(metres_per_plan_unit(crs_from_text("EPSG:4326")), InvalidInput);
  EXPECT_EQ(short_crs(crs_from_text("EPSG:32633")), "EPSG:32633");
  EXPECT_EQ(short_crs(""), "");
  const std::string own = short_crs(crs_from_text("+proj=tmerc +lat_0=1 +lon_0=2 +datum=WGS84 +units=m"));
  EXPECT_TRUE(says(own, "PROJCRS["));
  EXPECT_EQ(own.find('\n'), std::string::npos);
  EXPECT_EQ(crs_from_text("no CRS"), "");
}

}  // namespace
}  // namespace sightbound
