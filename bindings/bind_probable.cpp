// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <utility>
#include <vector>

#include "bindings.h"
#include "numpy_views.h"
#include "progress_bridge.h"
#include <pybind11/stl.h>

#include "jobs/probable_viewshed_job.h"
#include "jobs/result_files.h"

namespace sightbound::python {

namespace {

void bind_options(py::module_& m) {
  py::class_<ProbableOptions>(m, "ProbableOptions")
      .def(py::init<>())
      .def_readwrite("confidence", &ProbableOptions::confidence)
      .def_readwrite("refraction", &ProbableOptions::refraction)
      .def_readwrite("curvature", &ProbableOptions::curvature)
      .def_readwrite("realisations", &ProbableOptions::realisations)
      .def_readwrite("precision", &ProbableOptions::precision)
      .def_readwrite("refinement", &ProbableOptions::refinement)
      .def_readwrite("heights", &ProbableOptions::heights)
      .def_readwrite("seed", &ProbableOptions::seed)
      .def_readwrite("extent", &ProbableOptions::extent)
      .def_readwrite("threads", &ProbableOptions::threads)
      .def_readwrite("memory_budget", &ProbableOptions::memory_budget);
}

py::dict report_of(const ProbableReport& found) {
  using namespace py::literals;
  py::list eyes;
  for (const ObserverReport& one : found.observers) {
    eyes.append(py::dict("x"_a = one.x, "y"_a = one.y, "name"_a = one.name,
                         "ground_height"_a = one.ground_height, "eye_height"_a = one.eye_height));
  }
  return py::dict("observers"_a = eyes, "realisations"_a = found.realisations,
                  "largest_standard_error"_a = found.largest_standard_error,
                  "in_doubt_m2"_a = found.in_doubt_m2, "heights"_a = found.heights,
                  "expected_visible_m2"_a = found.expected_m2, "visible_m2"_a = found.visible_m2,
                  "uncertain_m2"_a = found.uncertain_m2, "hidden_m2"_a = found.hidden_m2,
                  "error_model"_a = found.error_model, "warnings"_a = found.warnings);
}

template <auto GridField>
py::object grid_of(const py::object& self) {
  return view_of(self.cast<const ProbableViewshed&>().*GridField, self);
}

void bind_result(py::module_& m) {
  py::class_<ProbableViewshed>(m, "ProbableViewshed")
      .def_property_readonly("probability", &grid_of<&ProbableViewshed::probability>)
      .def_property_readonly("standard_error", &grid_of<&ProbableViewshed::standard_error>)
      .def_property_readonly("realisations", &grid_of<&ProbableViewshed::realisations>)
      .def("at_height",
           [](const py::object& self, std::size_t n) {
             return view_of(self.cast<const ProbableViewshed&>().at_heights.at(n), self);
           })
      .def_property_readonly("verdict", &grid_of<&ProbableViewshed::verdict>)
      .def_property_readonly(
          "geotransform",
          [](const ProbableViewshed& self) { return py::tuple(py::cast(self.geotransform.coefficients())); })
      .def_readonly("crs_wkt", &ProbableViewshed::crs_wkt)
      .def("report", [](const ProbableViewshed& self) { return report_of(self.report); });
  py::class_<ProbableFiles>(m, "ProbableFiles")
      .def(py::init<>())
      .def_readwrite("probability", &ProbableFiles::probability)
      .def_readwrite("standard_error", &ProbableFiles::standard_error)
      .def_readwrite("verdict", &ProbableFiles::verdict)
      .def_readwrite("creation_options", &ProbableFiles::creation_options);
}

ProbableViewshed probable_viewshed(const std::shared_ptr<DemSource>& dem,
                                   const std::vector<Observer>& observers, const ErrorModel& model,
                                   const ProbableOptions& options, const py::object& progress) {
  return ProgressBridge(progress).run([&, who = observers, given = model, used = options](Progress& p) {
    return run_probable_viewshed(*dem, who, given, used, p);
  });
}

void write(const ProbableViewshed& result, const std::vector<Observer>& observers,
           const ProbableOptions& options, const ProbableFiles& files, const py::object& progress) {
  ProgressBridge(progress).run([&, who = observers, used = options, wanted = files](Progress& p) {
    write_probable(result, who, used, wanted, p);
  });
}

}  // namespace

void bind_probable(py::module_& m) {
  bind_options(m);
  bind_result(m);
  m.def("write_probable", &write, py::arg("result"), py::arg("observers"), py::arg("options"),
        py::arg("files"), py::arg("progress"));
  m.def("probable_viewshed", &probable_viewshed, py::arg("dem"), py::arg("observers"), py::arg("model"),
        py::arg("options"), py::arg("progress"));
}

}  // namespace sightbound::python
