// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <utility>
#include <vector>

#include "bindings.h"
#include "numpy_views.h"
#include "progress_bridge.h"
#include <pybind11/stl.h>

#include "jobs/probable_viewshed_job.h"

namespace sightbound::python {

namespace {

void bind_options(py::module_& m) {
  py::class_<ProbableOptions>(m, "ProbableOptions")
      .def(py::init<>())
      .def_readwrite("confidence", &ProbableOptions::confidence)
      .def_readwrite("refraction", &ProbableOptions::refraction)
      .def_readwrite("curvature", &ProbableOptions::curvature)
      .def_readwrite("realisations", &ProbableOptions::realisations)
      .def_readwrite("seed", &ProbableOptions::seed)
      .def_readwrite("extent", &ProbableOptions::extent)
      .def_readwrite("threads", &ProbableOptions::threads)
      .def_readwrite("memory_budget", &ProbableOptions::memory_budget);
}

// Arrays, geotransform, CRS and report.
py::dict probable_viewshed(const std::shared_ptr<DemSource>& dem, const std::vector<Observer>& observers,
                           const ErrorModel& model, const ProbableOptions& options,
                           const py::object& progress) {
  using namespace py::literals;
  ProbableViewshed made =
      ProgressBridge(progress).run([&, who = observers, given = model, used = options](Progress& p) {
        return run_probable_viewshed(*dem, who, given, used, p);
      });
  const ProbableReport& found = made.report;
  py::list eyes;
  for (const ObserverReport& one : found.observers) {
    eyes.append(py::dict("x"_a = one.x, "y"_a = one.y, "name"_a = one.name,
                         "ground_height"_a = one.ground_height, "eye_height"_a = one.eye_height));
  }
  py::dict report("observers"_a = eyes, "realisations"_a = found.realisations,
                  "expected_visible_m2"_a = found.expected_m2, "visible_m2"_a = found.visible_m2,
                  "uncertain_m2"_a = found.uncertain_m2, "hidden_m2"_a = found.hidden_m2,
                  "error_model"_a = found.error_model, "warnings"_a = found.warnings);
  return py::dict("probability"_a = array_from(std::move(made.probability)),
                  "standard_error"_a = array_from(std::move(made.standard_error)),
                  "verdict"_a = array_from(std::move(made.verdict)),
                  "geotransform"_a = py::tuple(py::cast(made.geotransform.coefficients())),
                  "crs_wkt"_a = made.crs_wkt, "report"_a = report);
}

}  // namespace

void bind_probable(py::module_& m) {
  bind_options(m);
  m.def("probable_viewshed", &probable_viewshed, py::arg("dem"), py::arg("observers"), py::arg("model"),
        py::arg("options"), py::arg("progress"));
}

}  // namespace sightbound::python
