// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "bindings.h"
#include "numpy_views.h"
#include "progress_bridge.h"
#include <pybind11/stl.h>

#include "io/raster_dem.h"
#include "terrain/dem.h"

namespace sightbound::python {

namespace {

std::shared_ptr<DemSource> open(const std::string& path, int band, const std::string& vertical_unit) {
  const VerticalUnit unit = vertical_unit_from(vertical_unit);
  py::gil_scoped_release released;
  return open_dem(path, band, unit);
}

std::shared_ptr<DemSource> from_array(const FloatArray& heights, const std::array<double, 6>& geotransform,
                                      const std::string& crs_wkt, std::optional<double> nodata,
                                      const std::string& vertical_unit) {
  ArrayDem::Heights held;
  held.data = heights.data();
  held.rows = static_cast<int>(heights.shape(0));
  held.cols = static_cast<int>(heights.shape(1));
  held.nodata = nodata.value_or(std::numeric_limits<double>::quiet_NaN());
  held.metres_per_unit = metres_per(vertical_unit_from(vertical_unit));
  held.owner = keep_alive(heights);
  return std::make_shared<ArrayDem>(std::move(held), Geotransform(geotransform), crs_wkt);
}

py::tuple users_geotransform(const DemSource& dem) {
  const Geotransform& own = dem.geotransform();
  return py::tuple(py::cast((dem.flipped() ? own.of_flipped(dem.rows()) : own).coefficients()));
}

py::array heights(const std::shared_ptr<DemSource>& dem) {
  return array_from(ProgressBridge(py::none()).run([&](Progress& progress) {
    Grid<float> grid = dem->read(dem->window(), progress);
    if (dem->flipped()) grid.flip_rows();
    return grid;
  }));
}

}  // namespace

void bind_dem(py::module_& m) {
  py::class_<DemSource, std::shared_ptr<DemSource>>(m, "DemSource")
      .def_property_readonly("rows", &DemSource::rows)
      .def_property_readonly("cols", &DemSource::cols)
      .def_property_readonly("geotransform", &users_geotransform)
      .def_property_readonly("crs_wkt", &DemSource::crs_wkt)
      .def_property_readonly("flipped", &DemSource::flipped)
      .def_property_readonly("notes", &DemSource::notes)
      .def("heights", &heights);
  m.def("open_dem", &open, py::arg("path"), py::arg("band"), py::arg("vertical_unit"));
  m.def("array_dem", &from_array, py::arg("heights").noconvert(), py::arg("geotransform"), py::arg("crs_wkt"),
        py::arg("nodata"), py::arg("vertical_unit"));
}

}  // namespace sightbound::python
