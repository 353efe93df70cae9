// SPDX-License-Identifier: GPL-3.0-or-later
// UGRID 1.0 (ugrid-conventions.github.io): a variable without values, Mesh2d, names the others. Written
// through GDAL's multidimensional interface, which needs no NetCDF headers.
#include <algorithm>
#include <memory>

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include "base/error.h"
#include "io/gdal_support.h"
#include "io/tin_crs.h"
#include "io/tin_writers.h"

namespace sightbound {

namespace {

using Array = std::shared_ptr<GDALMDArray>;
using Dimensions = std::vector<std::shared_ptr<GDALDimension>>;

class Mesh {
 public:
  explicit Mesh(const std::string& path) {
    gdal::register_drivers();
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("netCDF");
    if (driver == nullptr) {
      throw IoError("'" + path + "' cannot be written: this GDAL knows no NetCDF; write PLY.");
    }
    dataset_.reset(driver->CreateMultiDimensional(path.c_str(), nullptr, nullptr));
    if (dataset_) root_ = dataset_->GetRootGroup();
    if (!root_) fail();
  }

  std::shared_ptr<GDALDimension> dimension(const std::string& name, std::size_t size) {
    return checked(root_->CreateDimension(name, "", "", size));
  }
  Array array(const std::string& name, const Dimensions& dimensions, GDALDataType type) {
    return checked(root_->CreateMDArray(name, dimensions, GDALExtendedDataType::Create(type)));
  }
  void say(const Array& array, const std::string& name, const std::string& value) {
    if (!checked(array->CreateAttribute(name, {}, GDALExtendedDataType::CreateString()))
             ->Write(value.c_str()))
      fail();
  }
  void say(const Array& array, const std::string& name, int value) {
    if (!checked(array->CreateAttribute(name, {}, GDALExtendedDataType::Create(GDT_Int32)))->Write(value))
      fail();
  }
  void say_root(const std::string& name, const std::string& value) {
    if (!checked(root_->CreateAttribute(name, {}, GDALExtendedDataType::CreateString()))
             ->Write(value.c_str()))
      fail();
  }

  // All values in blocks of rows; fill(first, count, buffer) gives `width` values each.
  template <class T, class Fill>
  void write(const Array& array, std::size_t rows, std::size_t width, GDALDataType type, Progress& progress,
             double units, const Fill& fill) {
    constexpr std::size_t kRows = 1 << 18;
    std::vector<T> buffer;
    for (std::size_t first = 0; first < rows; first += kRows) {
      const std::size_t count = std::min(kRows, rows - first);
      buffer.resize(count * width);
      for (std::size_t r = 0; r < count; ++r) fill(first + r, buffer.data() + r * width);
      const std::array<GUInt64, 2> start{first, 0};
      const std::array<std::size_t, 2> counts{count, width};
      if (!array->Write(start.data(), counts.data(), nullptr, nullptr, GDALExtendedDataType::Create(type),
                        buffer.data()))
        fail();
      progress.advance(units * static_cast<double>(count));
    }
  }

  void close() {
    root_.reset();
    dataset_.reset();
    if (log_.failed()) fail();
  }

 private:
  [[noreturn]] void fail() {
    throw IoError("The UGRID file cannot be written: " + log_.message("the disk is full, or went away."));
  }
  template <class T>
  std::shared_ptr<T> checked(std::shared_ptr<T> made) {
    if (!made) fail();
    return made;
  }

  gdal::ErrorLog log_;
  std::unique_ptr<GDALDataset> dataset_;
  std::shared_ptr<GDALGroup> root_;
};

// As QGIS (MDAL) looks for it.
void write_crs(Mesh& mesh, const std::string& crs_wkt) {
  const std::string name = short_crs(crs_wkt);
  if (name.empty()) return;
  const Array crs = mesh.array("projected_coordinate_system", {}, GDT_Int32);
  if (name.starts_with("EPSG:")) {
    mesh.say(crs, "epsg", std::stoi(name.substr(5)));
    mesh.say(crs, "EPSG_code", name);
  }
  OGRSpatialReference reference;
  char* wkt = nullptr;
  if (reference.importFromWkt(crs_wkt.c_str()) == OGRERR_NONE && reference.exportToWkt(&wkt) == OGRERR_NONE &&
      wkt != nullptr) {
    mesh.say(crs, "wkt", wkt);
  }
  CPLFree(wkt);
}

}  // namespace

void write_ugrid(const std::string& path, const Tin& tin, Progress& progress) {
  Mesh mesh(path);
  mesh.say_root("Conventions", "CF-1.8 UGRID-1.0");
  const auto nodes = mesh.dimension("nMesh2d_node", tin.vertices.size());
  const auto faces = mesh.dimension("nMesh2d_face", tin.faces.size());
  const auto corners = mesh.dimension("nMax_mesh2d_face_nodes", 3);

  const Array topology = mesh.array("Mesh2d", {}, GDT_Int32);
  mesh.say(topology, "cf_role", "mesh_topology");
  mesh.say(topology, "long_name", "Topology data of 2D mesh");
  mesh.say(topology, "topology_dimension", 2);
  mesh.say(topology, "node_coordinates", "Mesh2d_node_x Mesh2d_node_y");
  mesh.say(topology, "face_node_connectivity", "Mesh2d_face_nodes");
  mesh.say(topology, "node_dimension", "nMesh2d_node");
  mesh.say(topology, "face_dimension", "nMesh2d_face");
  mesh.say(topology, "max_face_nodes_dimension", "nMax_mesh2d_face_nodes");
  write_crs(mesh, tin.crs_wkt);

  const auto on_mesh = [&](const Array& array, const std::string& location) {
    mesh.say(array, "mesh", "Mesh2d");
    mesh.say(array, "location", location);
  };
  const auto coordinate = [&](const std::string& axis, const std::string& standard_name, auto&& of) {
    const Array array = mesh.array("Mesh2d_node_" + axis, {nodes}, GDT_Float64);
    mesh.say(array, "standard_name", standard_name);
    on_mesh(array, "node");
    if (axis == "z") mesh.say(array, "units", "m");
    mesh.write<double>(array, tin.vertices.size(), 1, GDT_Float64, progress, 1.0 / 3,
                       [&](std::size_t v, double* to) { *to = of(tin.to_crs(tin.vertices[v])); });
  };
  coordinate("x", "projection_x_coordinate", [](const Xyz& p) { return p.x; });
  coordinate("y", "projection_y_coordinate", [](const Xyz& p) { return p.y; });
  coordinate("z", "altitude", [](const Xyz& p) { return p.z; });

  const Array connectivity = mesh.array("Mesh2d_face_nodes", {faces, corners}, GDT_Int32);
  mesh.say(connectivity, "cf_role", "face_node_connectivity");
  mesh.say(connectivity, "start_index", 0);
  mesh.write<std::int32_t>(
      connectivity, tin.faces.size(), 3, GDT_Int32, progress, 1,
      [&](std::size_t f, std::int32_t* to) { std::copy_n(tin.faces[f].begin(), 3, to); });

  const auto values = [&](const std::vector<NamedValues>& all, const std::string& location,
                          const auto& dimension) {
    for (const NamedValues& one : all) {
      const Array array = mesh.array("Mesh2d_" + one.name, {dimension}, GDT_Float32);
      mesh.say(array, "long_name", one.name);
      on_mesh(array, location);
      mesh.write<float>(array, one.values->size(), 1, GDT_Float32, progress, 0,
                        [&](std::size_t i, float* to) { *to = (*one.values)[i]; });
    }
  };
  std::vector<std::string> taken{"node_x", "node_y", "node_z", "face_nodes"};
  const std::vector<NamedValues> of_vertices = vertex_values(tin, taken);
  for (const NamedValues& one : of_vertices) taken.push_back(one.name);
  values(of_vertices, "node", nodes);
  values(face_values(tin, taken), "face", faces);
  mesh.close();
}

}  // namespace sightbound
