// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>
#include <ogrsf_frmts.h>

#include "base/error.h"
#include "io/tin_reader.h"
#include "support/says.h"
#include "support/scratch.h"
#include "support/tins.h"
#include "terrain/tin_height_field.h"

namespace sightbound {
namespace {

using testing::all_notes;
using testing::says;

class TinReader : public testing::Scratch {
 protected:
  Tin read(const std::string& name, const std::string& bytes, const TinReadOptions& options = {}) {
    Progress progress;
    return read_tin(write_text(name, bytes), options, progress);
  }
  std::string complaint(const std::string& name, const std::string& bytes,
                        const TinReadOptions& options = {}) {
    try {
      read(name, bytes, options);
    } catch (const InvalidInput& e) {
      return std::string("InvalidInput: ") + e.what();
    } catch (const IoError& e) {
      return std::string("IoError: ") + e.what();
    }
    return "none";
  }
};

std::vector<Xyz> places(const Tin& tin) {
  std::vector<Xyz> all;
  for (const Xyz& v : tin.vertices) all.push_back(tin.to_crs(v));
  return all;
}

const std::vector<Xyz> kSquare{
    {500000.125, 4000000.25, 10}, {500010, 4000000, 11}, {500010, 4000010, 12.5}, {500000, 4000010, 13}};
const std::vector<Face> kTwo{{0, 1, 2}, {0, 2, 3}};

const std::string kAsciiPly = R"(ply
format ascii 1.0
comment crs: EPSG:32633
obj_info whatever
element vertex 4
property double x
property double y
property float z
property float sigma_v
property uchar red
element face 2
property list uchar int vertex_indices
property float max_error
end_header
500000.125 4000000.25 10 0.5 255
500010 4000000 11 nan 0
500010 4000010 12.5 0.25 1
500000 4000010 13 0 2
3 0 1 2 0.1
3 0 2 3 0.2
)";

TEST_F(TinReader, AsciiPly) {
  const Tin tin = read("a.ply", kAsciiPly);
  EXPECT_EQ(places(tin), kSquare);
  EXPECT_EQ(tin.faces, kTwo);
  EXPECT_TRUE(says(tin.crs_wkt, "WGS 84 / UTM zone 33N"));
  ASSERT_EQ(tin.sigma_v.size(), 4U);
  EXPECT_EQ(tin.sigma_v[0], 0.5F);
  EXPECT_TRUE(std::isnan(tin.sigma_v[1]));
  ASSERT_EQ(tin.vertex_attributes.size(), 1U);
  EXPECT_EQ(tin.vertex_attributes[0].name, "red");
  EXPECT_EQ(tin.vertex_attributes[0].values, (std::vector<float>{255, 0, 1, 2}));
  ASSERT_EQ(tin.face_attributes.size(), 1U);
  EXPECT_EQ(tin.face_attributes[0].values, (std::vector<float>{0.1F, 0.2F}));
  EXPECT_TRUE(tin.notes.empty()) << all_notes(tin);
  std::string windows;
  for (const char c : kAsciiPly) windows += c == '\n' ? "\r\n" : std::string(1, c);
  EXPECT_EQ(places(read("w.ply", windows)), kSquare);
}

template <class T>
void put(std::string& bytes, T value, bool big) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (big) std::reverse(raw, raw + sizeof(T));
  bytes.append(raw, sizeof(T));
}

std::string binary_ply(bool big) {
  std::string bytes =
      std::string("ply\nformat binary_") + (big ? "big" : "little") +
      "_endian 1.0\nelement edge 1\nproperty list ushort short nodes\nproperty int n\nelement vertex 4\n"
      "property double x\nproperty double y\nproperty double z\nproperty short tag\nelement face 1\n"
      "property list uint uint vertex_index\nend_header\n";
  put<std::uint16_t>(bytes, 2, big);
  for (int i = 0; i < 2; ++i) put<std::int16_t>(bytes, -1, big);
  put<std::int32_t>(bytes, 7, big);
  for (const Xyz& p : kSquare) {
    for (const double c : {p.x, p.y, p.z}) put(bytes, c, big);
    put<std::int16_t>(bytes, -3, big);
  }
  put<std::uint32_t>(bytes, 4, big);
  for (std::uint32_t i = 0; i < 4; ++i) put(bytes, i, big);
  return bytes;
}

TEST_F(TinReader, BinaryPlyOfBothByteOrdersWithAQuadAndOtherElements) {
  for (const bool big : {false, true}) {
    const Tin tin = read("b.ply", binary_ply(big));
    EXPECT_EQ(places(tin), kSquare);
    EXPECT_EQ(tin.faces.size(), 2U);
    EXPECT_EQ(tin.vertex_attributes.at(0).values, (std::vector<float>(4, -3.0F)));
    EXPECT_TRUE(says(all_notes(tin), "1 faces of four corners"));
    EXPECT_TRUE(says(all_notes(tin), "no CRS"));
  }
}

TEST_F(TinReader, DamagedPly) {
  const std::string ply = kAsciiPly;
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = ply;
    changed.replace(changed.find(from), from.size(), to);
    return changed;
  };
  EXPECT_TRUE(says(complaint("a.ply", ""), "InvalidInput"));
  EXPECT_TRUE(says(complaint("a.ply", "plyx"), "does not begin with 'ply'"));
  EXPECT_TRUE(says(complaint("a.ply", "ply\nformat ascii 1.0\n"), "header does not end"));
  EXPECT_TRUE(says(complaint("a.ply", with("ascii", "utf8")), "format 'utf8'"));
  EXPECT_TRUE(says(complaint("a.ply", with("vertex 4", "vertex 5")), "'nan' is no number") == false);
  EXPECT_TRUE(says(complaint("a.ply", with("vertex 4", "vertex 4000000000000")), "IoError"));
  EXPECT_TRUE(says(complaint("a.ply", with("vertex 4", "vertex -4")), "has no count"));
  EXPECT_TRUE(
      says(complaint("a.ply", with("face 2", "face 3")), "truncated: it ends in element 'face' 2 of 3"));
  EXPECT_TRUE(says(complaint("a.ply", ply.substr(0, ply.size() - 12)), "truncated"));
  EXPECT_TRUE(
      says(complaint("a.ply", with("3 0 2 3", "3 0 2 4")), "has vertex 4; there are vertices 0 to 3"));
  EXPECT_TRUE(says(complaint("a.ply", with("3 0 2 3", "3 0 2 -1")), "has vertex -1"));
  EXPECT_TRUE(says(complaint("a.ply", with("4000010 13", "4000010 x13")), "'x13' is no number"));
  EXPECT_TRUE(says(complaint("a.ply", with("4000010 13", "4000010 nan")), "must be finite"));
  EXPECT_TRUE(says(complaint("a.ply", with("property double y\n", "")), "lack x, y or z"));
  EXPECT_TRUE(says(complaint("a.ply", with("0 1 2 0.1", "0 1 2 0.1\n3 0 1")), "IoError") == false);
  const std::string binary = binary_ply(false);
  for (std::size_t size = 0; size < binary.size(); size += 3) {
    EXPECT_NE(complaint("b.ply", binary.substr(0, size)), "none") << size;
  }
  EXPECT_TRUE(says(complaint("b.ply", binary.substr(0, binary.size() - 1)), "IoError"));
}

TEST_F(TinReader, Crs) {
  const auto with_crs = [&](const std::string& crs) {
    std::string ply = kAsciiPly;
    return ply.replace(ply.find("EPSG:32633"), 10, crs);
  };
  EXPECT_TRUE(says(read("a.ply", kAsciiPly, {.crs = "EPSG:32632"}).crs_wkt, "zone 32N"));
  EXPECT_TRUE(
      says(complaint("a.ply", kAsciiPly, {.crs = "EPSG:4326"}), "reproject to a projected CRS such as UTM"));
  EXPECT_TRUE(says(complaint("a.ply", kAsciiPly, {.crs = "Atlantis"}), "crs is 'Atlantis'"));
  const Tin degrees = read("a.ply", with_crs("EPSG:4326"));
  EXPECT_TRUE(degrees.crs_wkt.empty());
  EXPECT_TRUE(says(all_notes(degrees), "its coordinates cannot be"));
  const Tin unknown = read("a.ply", with_crs("Atlantis"));
  EXPECT_TRUE(unknown.crs_wkt.empty());
  EXPECT_TRUE(says(all_notes(unknown), "cannot be understood"));
  EXPECT_TRUE(
      says(complaint("d.obj", "# crs: EPSG:4326\nv 10 50 1\nv 11 50 1\nv 10 51 1\nf 1 2 3\n"), "degrees"));
}

TEST_F(TinReader, FeetOfTheCrs) {
  // Plan stays in the CRS; inside, metres.
  const std::string obj = "v 1000 2000 10\nv 1100 2000 10\nv 1000 2100 20\nf 1 2 3\n";
  const Tin tin = read("a.obj", obj, {.crs = "EPSG:2263"});  // New York, US survey feet
  EXPECT_NEAR(tin.vertices[1].x - tin.vertices[0].x, 100 * 1200.0 / 3937, 1e-9);
  EXPECT_EQ(tin.vertices[2].z, 20);
  EXPECT_NEAR(tin.to_crs(tin.vertices[1]).x, 1100, 1e-9);
  const Tin feet = read("a.obj", obj, {.crs = "EPSG:2263", .vertical_unit = VerticalUnit::kFoot});
  EXPECT_NEAR(feet.vertices[2].z, 6.096, 1e-12);
  const Tin compound = read("a.obj", obj, {.crs = "EPSG:2263+6360"});  // NAVD88 height (ftUS)
  EXPECT_NEAR(compound.vertices[2].z, 20 * 1200.0 / 3937, 1e-12);
  EXPECT_FALSE(says(compound.crs_wkt, "NAVD88"));
}

TEST_F(TinReader, Obj) {
  const Tin tin = read("a.obj",
                       "# crs: EPSG:32633\nmtllib x\no thing\nf 1/1/1 2//2 3/4\nv 500000 4000000 1\nvn 0 0 "
                       "1\nv 500001 4000000 2 "
                       "0.5 0.5 0.5\nv +500001 4000001 3\nv 500000 4000001 4\nf -4 -2 -1 # last\n");
  EXPECT_EQ(tin.vertices.size(), 4U);
  EXPECT_EQ(tin.faces, kTwo);
  EXPECT_TRUE(says(tin.crs_wkt, "zone 33N"));
  EXPECT_TRUE(says(complaint("a.obj", "v 1 2\n"), "line 1"));
  EXPECT_TRUE(says(complaint("a.obj", "v 1 2 3\nf 1 0 1\n"), "line 2 has '0'"));
  EXPECT_TRUE(says(complaint("a.obj", "v 1 2 3\nf 1 1\n"), "has 2 corners"));
  EXPECT_TRUE(says(complaint("a.obj", "v 1 2 3\nv 2 2 3\nv 3 3 3\nf 1 2 -9\n"), "has vertex -1"));
  const Tin pentagon = read("p.obj", "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nf 1 2 3 4 5\n");
  EXPECT_EQ(pentagon.faces.size(), 3U);
  EXPECT_TRUE(says(all_notes(pentagon), "more than four corners"));
  EXPECT_TRUE(is_height_field(pentagon));
}

TEST_F(TinReader, TwoDm) {
  const Tin tin = read("a.2dm",
                       "MESH2D  1 2 3\nMESHNAME \"x\"\nE3T 1 10 20 30 5\nE4Q 2 30 20 40 50 6\nND 10 0 0 "
                       "1\nND 20 10 0 1\nND 30 0 10 "
                       "1e0\nND 40 20 5 1\nND 50 20 20 1\nNS 1 -2\nBEGPARAMDEF\n");
  EXPECT_EQ(tin.vertices.size(), 5U);
  EXPECT_EQ(tin.faces.size(), 3U);
  EXPECT_EQ(tin.face_attributes.at(0).name, "material");
  EXPECT_EQ(tin.face_attributes[0].values, (std::vector<float>{5, 6, 6}));
  EXPECT_TRUE(says(all_notes(tin), "1 faces of four corners"));
  const Tin quadratic = read("q.2dm",
                             "MESH2D\nND 1 0 0 0\nND 2 1 0 0\nND 3 2 0 0\nND 4 1 1 0\nND 5 0 2 0\nND 6 0 1 "
                             "0\nE6T 1 1 2 3 4 5 6 1\n");
  EXPECT_EQ(places(quadratic), (std::vector<Xyz>{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}));
  EXPECT_TRUE(
      says(complaint("a.2dm", "MESH2D\nND 1 0 0 0\nE3T 1 1 2 3 1\n"), "node 2, which does not exist"));
  EXPECT_TRUE(says(complaint("a.2dm", "MESH2D\nND 1 0 0 0\nND 1 0 0 0\n"), "repeats node 1"));
  EXPECT_TRUE(says(complaint("a.2dm", "MESH2D\nND 1 0 0 a\n"), "line 2 has 'a'"));
  EXPECT_TRUE(says(complaint("a.2dm", "MESH2D\nE3T 1 1 2\n"), "line 2"));
}

std::string landxml(const std::string& units, const std::string& crs = "") {
  return "<?xml version=\"1.0\"?>\n<LandXML xmlns=\"http://www.landxml.org/schema/LandXML-1.2\"><Units>" +
         units + "</Units>" + crs +
         R"(<Surfaces><Surface name="EG"><Definition surfType="TIN"><Pnts><P id="1">2000 1000 10</P><P id="2">2000 1100 10</P>
<P id="7">2100 1000 20</P><P id="9">2100 1100 20</P></Pnts><Faces><F>1 2 7</F><F n="0 0 0">2 9 7</F><F i="1">1 2 9</F></Faces></Definition></Surface>
<Surface name="FG &amp; more"><SourceData><Breaklines><Breakline><PntList3D>1 2 3</PntList3D></Breakline></Breaklines></SourceData>
<Definition surfType="TIN"><Pnts><P id="1">0 0 1</P><P id="2">0 5 1</P><P id="3">5 0 1</P></Pnts><Faces><F>1 2 3</F></Faces></Definition></Surface>
</Surfaces></LandXML>)";
}

TEST_F(TinReader, LandXml) {
  const std::string metric =
      landxml(R"(<Metric linearUnit="meter"/>)", R"(<CoordinateSystem epsgCode="32633"/>)");
  const Tin tin = read("a.xml", metric, {.layers = {"EG"}});
  EXPECT_EQ(places(tin),
            (std::vector<Xyz>{{1000, 2000, 10}, {1100, 2000, 10}, {1000, 2100, 20}, {1100, 2100, 20}}));
  EXPECT_EQ(tin.faces.size(), 2U);
  EXPECT_TRUE(says(tin.crs_wkt, "zone 33N"));
  EXPECT_TRUE(says(all_notes(tin), "1 invisible faces"));
  EXPECT_EQ(read("a.xml", metric, {.layers = {"FG & more"}}).faces.size(), 1U);
  EXPECT_TRUE(says(complaint("a.xml", metric), "several surfaces: 'EG', 'FG & more'"));
  EXPECT_TRUE(says(complaint("a.xml", metric, {.layers = {"XX"}}), "no surface 'XX'; there are 'EG'"));
  Progress progress;
  EXPECT_EQ(tin_layers(write_text("b.xml", metric), progress), (std::vector<std::string>{"EG", "FG & more"}));
  EXPECT_TRUE(says(complaint("a.xml", metric.substr(0, metric.size() - 30), {.layers = {"EG"}}), "IoError"));
  EXPECT_TRUE(says(complaint("a.xml", "<LandXML></LandXML>"), "no surface"));
  std::string other = metric;
  other.replace(other.find("2 9 7"), 5, "2 9 8");
  EXPECT_TRUE(says(complaint("a.xml", other, {.layers = {"EG"}}), "point 8, which does not exist"));
  other = metric;
  other.replace(other.find("2000 1000 10"), 12, "2000 1000   ");
  EXPECT_TRUE(says(complaint("a.xml", other, {.layers = {"EG"}}), "northing easting elevation"));
}

TEST_F(TinReader, LandXmlInFeet) {
  const std::string feet = R"(<Imperial linearUnit="foot"/>)";
  const Tin plane = read("a.xml", landxml(feet), {.layers = {"EG"}});
  EXPECT_NEAR(plane.to_crs(plane.vertices[0]).x, 304.8, 1e-9);
  EXPECT_NEAR(plane.vertices[2].z, 6.096, 1e-12);
  EXPECT_NEAR(plane.vertices[1].x - plane.vertices[0].x, 30.48, 1e-9);
  // Either foot, says the file; which one, the CRS.
  const Tin survey =
      read("a.xml", landxml(feet, R"(<CoordinateSystem epsgCode="2263"/>)"), {.layers = {"EG"}});
  EXPECT_NEAR(survey.to_crs(survey.vertices[1]).x, 1100, 1e-9);
  EXPECT_NEAR(survey.vertices[1].x - survey.vertices[0].x, 100 * 1200.0 / 3937, 1e-9);
  const Tin metric_crs =
      read("a.xml", landxml(feet, R"(<CoordinateSystem epsgCode="32633"/>)"), {.layers = {"EG"}});
  EXPECT_NEAR(metric_crs.to_crs(metric_crs.vertices[1]).x, 335.28, 1e-9);
}

// A GeoPackage with layers of its own making.
std::string vector_file(const std::string& path,
                        const std::vector<std::pair<std::string, std::vector<std::string>>>& layers) {
  GDALAllRegister();
  GDALDatasetUniquePtr dataset(
      GetGDALDriverManager()->GetDriverByName("GPKG")->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  OGRSpatialReference crs;
  crs.importFromEPSG(32633);
  for (const auto& [name, geometries] : layers) {
    OGRLayer* layer = dataset->CreateLayer(name.c_str(), &crs, wkbUnknown, nullptr);
    OGRFieldDefn field("height", OFTReal);
    layer->CreateField(&field);
    for (std::size_t i = 0; i < geometries.size(); ++i) {
      OGRFeature feature(layer->GetLayerDefn());
      feature.SetField("height", 100.0 + static_cast<double>(i));
      OGRGeometry* geometry = nullptr;
      OGRGeometryFactory::createFromWkt(geometries[i].c_str(), &crs, &geometry);
      feature.SetGeometryDirectly(geometry);
      if (layer->CreateFeature(&feature) != OGRERR_NONE) throw std::runtime_error("no feature");
    }
  }
  return path;
}

TEST_F(TinReader, PolygonsAndTins) {
  const std::string file = vector_file(
      path("v.gpkg"), {{"faces",
                        {"POLYGON Z((0 0 1,10 0 1,10 10 2,0 0 1))", "POLYGON Z((0 0 1,10 10 2,0 10 3,0 0 1))",
                         "MULTIPOLYGON Z(((10 0 1,20 0 1,20 10 2,10 10 2,10 0 1)))"}},
                       {"tin", {"TIN Z(((0 0 0,1 0 0,0 1 0,0 0 0)),((1 0 0,1 1 5,0 1 0,1 0 0)))"}},
                       {"flat", {"POLYGON((0 0,1 0,0 1,0 0))"}}});
  Progress progress;
  const Tin faces = read_tin(file, {.layers = {"faces"}}, progress);
  EXPECT_EQ(faces.vertices.size(), 6U);
  EXPECT_EQ(faces.faces.size(), 4U);
  EXPECT_EQ(faces.face_attributes.at(0).values, (std::vector<float>{100, 101, 102, 102}));
  EXPECT_TRUE(says(faces.crs_wkt, "zone 33N"));
  EXPECT_EQ(read_tin(file, {.layers = {"tin"}}, progress).faces.size(), 2U);
  EXPECT_EQ(tin_layers(file, progress), (std::vector<std::string>{"faces", "tin", "flat"}));
  const auto complaint_of = [&](const TinReadOptions& options) -> std::string {
    try {
      read_tin(file, options, progress);
    } catch (const InvalidInput& e) {
      return e.what();
    }
    return "none";
  };
  EXPECT_TRUE(says(complaint_of({}), "3 layers: 'faces', 'tin', 'flat'"));
  EXPECT_TRUE(says(complaint_of({.layers = {"nix"}}), "no layer 'nix'"));
  EXPECT_TRUE(says(complaint_of({.layers = {"flat"}}), "z_field"));
  EXPECT_TRUE(says(complaint_of({.layers = {"flat"}, .z_field = "nix"}), "no field 'nix'"));
  EXPECT_EQ(read_tin(file, {.layers = {"flat"}, .z_field = "height"}, progress).vertices[0].z, 100);
}

TEST_F(TinReader, PointsAndBreaklines) {
  const std::string file = vector_file(
      path("v.gpkg"),
      {{"points", {"POINT Z(0 0 1)", "POINT Z(10 0 1)", "MULTIPOINT Z((10 10 1),(0 10 1),(5 2 3))"}},
       {"lines", {"LINESTRING Z(5 1 7,5 9 7)"}},
       {"mixed", {"POINT Z(0 0 0)", "POLYGON Z((0 0 0,1 0 0,0 1 0,0 0 0))"}}});
  Progress progress;
  const Tin points = read_tin(file, {.layers = {"points"}}, progress);
  EXPECT_EQ(points.vertices.size(), 5U);
  EXPECT_EQ(points.vertex_attributes.at(0).values, (std::vector<float>{100, 101, 102, 102, 102}));
  const Tin both = read_tin(file, {.layers = {"points", "lines"}}, progress);
  EXPECT_EQ(both.vertices.size(), 7U);
  EXPECT_TRUE(is_height_field(both));
  EXPECT_THROW(read_tin(file, {.layers = {"mixed"}}, progress), InvalidInput);
  EXPECT_THROW(read_tin(file, {.layers = {"points"}, .longest_edge = -1}, progress), InvalidInput);
  EXPECT_EQ(read_tin(file, {.layers = {"points"}, .longest_edge = 10.5}, progress).faces.size(), 4U);
}

TEST_F(TinReader, WhatIsNoTin) {
  Progress progress;
  EXPECT_THROW(read_tin("", {}, progress), InvalidInput);
  EXPECT_THROW(read_tin(path("missing.ply"), {}, progress), IoError);
  EXPECT_THROW(read_tin(write_text("a.txt", "hello"), {}, progress), IoError);
  EXPECT_TRUE(says(complaint("a.ply", kAsciiPly, {.layers = {"x"}}), "leave out layer ('x')"));
  Progress cancelled([](double) { return false; });
  EXPECT_THROW(read_tin(write_text("a.ply", kAsciiPly), {}, cancelled), Cancelled);
}

}  // namespace
}  // namespace sightbound
