// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bindings.h"
#include "numpy_views.h"
#include "progress_bridge.h"
#include <pybind11/stl.h>

#include "io/tin_crs.h"
#include "io/tin_reader.h"
#include "io/tin_writer.h"
#include "terrain/tin_height_field.h"

namespace sightbound::python {

namespace {

using Indices = py::array_t<std::int32_t, py::array::c_style>;
using Columns = std::map<std::string, FloatArray>;

// A TIN, and the samples its vertices are when it was made of a DEM.
using Held = std::shared_ptr<RegularTin>;

static_assert(sizeof(Xyz) == 3 * sizeof(double) && sizeof(Face) == 3 * sizeof(std::int32_t),
              "arrays share their memory");

std::vector<Xyz> places(const DoubleArray& rows) {
  const auto* first = reinterpret_cast<const Xyz*>(rows.data());
  return {first, first + rows.shape(0)};
}

std::vector<float> values(const FloatArray& column) { return {column.data(), column.data() + column.size()}; }

std::vector<TinAttribute> attributes(const Columns& columns) {
  std::vector<TinAttribute> all;
  for (const auto& [name, column] : columns) all.push_back({name, values(column)});
  return all;
}

Held hold(Tin tin) { return std::make_shared<RegularTin>(RegularTin{std::move(tin), {}}); }

Held make(TinSource source, const TinReadOptions& options, const char* what, const py::object& progress) {
  return ProgressBridge(progress).run(
      [&](Progress& p) { return hold(make_tin(std::move(source), options, what, p)); });
}

TinReadOptions options_of(const std::string& crs, const std::string& vertical_unit) {
  TinReadOptions options;
  options.crs = crs;
  options.vertical_unit = vertical_unit_from(vertical_unit);
  return options;
}

// Rows of `faces` end with -1 where they have fewer corners than others.
Held from_arrays(const DoubleArray& vertices, const Indices& faces, const std::string& crs,
                 const std::optional<FloatArray>& sigma_v, const Columns& vertex_attributes,
                 const Columns& face_attributes, const std::string& vertical_unit) {
  TinSource source;
  source.tin.vertices = places(vertices);
  if (sigma_v) source.tin.sigma_v = values(*sigma_v);
  source.tin.vertex_attributes = attributes(vertex_attributes);
  FaceCollector collector(source.tin, "The TIN");
  const auto width = static_cast<std::size_t>(faces.shape(1));
  for (py::ssize_t f = 0; f < faces.shape(0); ++f) {
    const std::int32_t* row = faces.data(f, 0);
    std::size_t corners = width;
    while (corners > 3 && row[corners - 1] == -1) --corners;
    collector.add({row, corners});
  }
  collector.finish(attributes(face_attributes));
  return make(std::move(source), options_of(crs, vertical_unit), "The TIN", py::none());
}

Held from_points(const DoubleArray& points, const std::vector<DoubleArray>& breaklines,
                 const std::string& crs, const std::optional<FloatArray>& sigma_v,
                 const Columns& point_attributes, double longest_edge, const std::string& vertical_unit,
                 const py::object& progress) {
  TinSource source;
  source.tin.vertex_attributes = attributes(point_attributes);
  if (sigma_v) source.tin.sigma_v = values(*sigma_v);
  source.add_survey(places(points), [&] {
    std::vector<std::vector<Xyz>> lines;
    for (const DoubleArray& line : breaklines) lines.push_back(places(line));
    return lines;
  }());
  TinReadOptions options = options_of(crs, vertical_unit);
  options.longest_edge = longest_edge;
  return make(std::move(source), options, "The TIN", progress);
}

Held from_dem(const std::shared_ptr<DemSource>& dem, std::size_t memory_budget, const py::object& progress) {
  return ProgressBridge(progress).run([&](Progress& p) {
    p.begin(1, dem->rows());
    auto made = std::make_shared<RegularTin>(tin_of_dem(*dem, MemoryBudget(memory_budget), p));
    p.finish();
    return made;
  });
}

Held read(const std::string& path, const std::vector<std::string>& layers, const std::string& crs,
          const std::string& vertical_unit, const std::string& z_field, double longest_edge,
          const py::object& progress) {
  TinReadOptions options = options_of(crs, vertical_unit);
  options.layers = layers;
  options.z_field = z_field;
  options.longest_edge = longest_edge;
  return ProgressBridge(progress).run([&](Progress& p) { return hold(read_tin(path, options, p)); });
}

std::vector<std::string> layers(const std::string& path) {
  return ProgressBridge(py::none()).run([&](Progress& p) { return tin_layers(path, p); });
}

std::vector<std::string> write(const Held& held, const std::string& path, bool ascii,
                               const py::object& progress) {
  return ProgressBridge(progress).run([&](Progress& p) {
    p.begin(1, static_cast<double>(held->tin.vertices.size() + held->tin.faces.size()));
    std::vector<std::string> warnings = write_tin(path, held->tin, {.ascii = ascii}, p);
    p.finish();
    return warnings;
  });
}

py::array_t<double> crs_vertices(const Held& held) {
  py::array_t<double> out({static_cast<py::ssize_t>(held->tin.vertices.size()), py::ssize_t{3}});
  auto* to = reinterpret_cast<Xyz*>(out.mutable_data());
  for (const Xyz& v : held->tin.vertices) *to++ = held->tin.to_crs(v);
  return out;
}

py::array local_vertices(const Held& held) {
  const auto& all = held->tin.vertices;
  return read_only(py::array_t<double>({static_cast<py::ssize_t>(all.size()), py::ssize_t{3}},
                                       reinterpret_cast<const double*>(all.data()), py::cast(held)));
}

py::array faces(const Held& held) {
  const auto& all = held->tin.faces;
  return read_only(py::array_t<std::int32_t>({static_cast<py::ssize_t>(all.size()), py::ssize_t{3}},
                                             reinterpret_cast<const std::int32_t*>(all.data()),
                                             py::cast(held)));
}

py::object sigma_v(const Held& held) {
  if (held->tin.sigma_v.empty()) return py::none();
  return view_of(held->tin.sigma_v, py::cast(held));
}

py::object samples(const Held& held) {
  if (held->samples.empty()) return py::none();
  return view_of(held->samples, py::cast(held));
}

py::dict columns(const Held& held, const std::vector<TinAttribute>& all) {
  py::dict found;
  for (const TinAttribute& one : all) found[py::str(one.name)] = view_of(one.values, py::cast(held));
  return found;
}

}  // namespace

void bind_tin(py::module_& m) {
  py::class_<RegularTin, Held>(m, "Tin")
      .def_property_readonly("vertices", &crs_vertices)
      .def_property_readonly("local_vertices", &local_vertices)
      .def_property_readonly("faces", &faces)
      .def_property_readonly("sigma_v", &sigma_v)
      .def_property_readonly("samples", &samples)
      .def_property_readonly("vertex_attributes",
                             [](const Held& t) { return columns(t, t->tin.vertex_attributes); })
      .def_property_readonly("face_attributes",
                             [](const Held& t) { return columns(t, t->tin.face_attributes); })
      .def_property_readonly("vertex_count", [](const RegularTin& t) { return t.tin.vertices.size(); })
      .def_property_readonly("face_count", [](const RegularTin& t) { return t.tin.faces.size(); })
      .def_property_readonly(
          "origin",
          [](const RegularTin& t) { return std::tuple(t.tin.origin.x, t.tin.origin.y, t.tin.origin.z); })
      .def_property_readonly("metres_per_unit", [](const RegularTin& t) { return t.tin.metres_per_unit; })
      .def_property_readonly("crs_wkt", [](const RegularTin& t) { return t.tin.crs_wkt; })
      .def_property_readonly("notes", [](const RegularTin& t) { return t.tin.notes; })
      .def_property_readonly("bounds",
                             [](const RegularTin& t) {
                               const Box3 box = bounds_of(t.tin);
                               const Xyz low = t.tin.to_crs(box.low), high = t.tin.to_crs(box.high);
                               return std::tuple(low.x, low.y, low.z, high.x, high.y, high.z);
                             })
      .def_property_readonly("median_edge", [](const RegularTin& t) { return median_edge(t.tin); })
      .def("height_field_test",
           [](const RegularTin& t) {
             const py::gil_scoped_release released;
             const HeightFieldTest found = height_field_test(t.tin);
             return std::pair(found.passed, found.reason);
           })
      .def("write", &write, py::arg("path"), py::arg("ascii"), py::arg("progress"));
  m.def("tin_from_arrays", &from_arrays, py::arg("vertices").noconvert(), py::arg("faces").noconvert(),
        py::arg("crs"), py::arg("sigma_v").noconvert(), py::arg("vertex_attributes"),
        py::arg("face_attributes"), py::arg("vertical_unit"));
  m.def("tin_from_points", &from_points, py::arg("points").noconvert(), py::arg("breaklines"), py::arg("crs"),
        py::arg("sigma_v").noconvert(), py::arg("attributes"), py::arg("longest_edge"),
        py::arg("vertical_unit"), py::arg("progress"));
  m.def("tin_from_dem", &from_dem, py::arg("dem"), py::arg("memory_budget"), py::arg("progress"));
  m.def("read_tin", &read, py::arg("path"), py::arg("layers"), py::arg("crs"), py::arg("vertical_unit"),
        py::arg("z_field"), py::arg("longest_edge"), py::arg("progress"));
  m.def("tin_layers", &layers, py::arg("path"));
}

}  // namespace sightbound::python
