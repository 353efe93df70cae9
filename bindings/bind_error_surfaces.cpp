// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <utility>

#include "bindings.h"
#include "numpy_views.h"
#include "progress_bridge.h"
#include <pybind11/stl.h>

#include "jobs/error_surfaces_job.h"
#include "jobs/result_files.h"

namespace sightbound::python {

namespace {

template <Grid<float> ErrorSurfaces::*GridField>
py::array grid_of(const py::object& self) {
  return view_of(self.cast<const ErrorSurfaces&>().*GridField, self);
}

void bind_options(py::module_& m) {
  py::class_<ErrorSurfacesOptions>(m, "ErrorSurfacesOptions")
      .def(py::init<>())
      .def_readwrite("confidence", &ErrorSurfacesOptions::confidence)
      .def_readwrite("extent", &ErrorSurfacesOptions::extent)
      .def_readwrite("threads", &ErrorSurfacesOptions::threads)
      .def_readwrite("memory_budget", &ErrorSurfacesOptions::memory_budget);
  py::class_<ErrorSurfaceFiles>(m, "ErrorSurfaceFiles")
      .def(py::init<>())
      .def_readwrite("sigma", &ErrorSurfaceFiles::sigma)
      .def_readwrite("lower", &ErrorSurfaceFiles::lower)
      .def_readwrite("upper", &ErrorSurfaceFiles::upper)
      .def_readwrite("creation_options", &ErrorSurfaceFiles::creation_options);
}

void bind_result(py::module_& m) {
  py::class_<ErrorSurfaces>(m, "ErrorSurfaces")
      .def_property_readonly("sigma", &grid_of<&ErrorSurfaces::sigma>)
      .def_property_readonly("lower", &grid_of<&ErrorSurfaces::lower>)
      .def_property_readonly("upper", &grid_of<&ErrorSurfaces::upper>)
      .def_property_readonly("rows", [](const ErrorSurfaces& self) { return self.sigma.rows(); })
      .def_property_readonly("cols", [](const ErrorSurfaces& self) { return self.sigma.cols(); })
      .def_property_readonly(
          "geotransform",
          [](const ErrorSurfaces& self) { return py::tuple(py::cast(self.geotransform.coefficients())); })
      .def_readonly("crs_wkt", &ErrorSurfaces::crs_wkt)
      .def_readonly("error_model", &ErrorSurfaces::error_model)
      .def_readonly("warnings", &ErrorSurfaces::warnings);
}

}  // namespace

void bind_error_surfaces(py::module_& m) {
  bind_options(m);
  bind_result(m);
  m.def(
      "error_surfaces",
      [](const std::shared_ptr<DemSource>& dem, const ErrorModel& model, const ErrorSurfacesOptions& options,
         py::object progress) {
        return ProgressBridge(std::move(progress)).run([&, given = model, used = options](Progress& p) {
          return run_error_surfaces(*dem, given, used, p);
        });
      },
      py::arg("dem"), py::arg("model"), py::arg("options"), py::arg("progress"));
  m.def(
      "write_error_surfaces",
      [](const ErrorSurfaces& surfaces, const ErrorSurfacesOptions& options, const ErrorSurfaceFiles& files,
         py::object progress) {
        ProgressBridge(std::move(progress)).run([&, used = options, wanted = files](Progress& p) {
          write_error_surfaces(surfaces, used, wanted, p);
        });
      },
      py::arg("surfaces"), py::arg("options"), py::arg("files"), py::arg("progress"));
}

}  // namespace sightbound::python
