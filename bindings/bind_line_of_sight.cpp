// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <utility>
#include <vector>

#include "bindings.h"
#include "numpy_views.h"
#include "progress_bridge.h"
#include <pybind11/stl.h>

#include "jobs/line_of_sight_job.h"

namespace sightbound::python {

namespace {

py::dict profile(const py::object& self) {
  using namespace py::literals;
  const SightProfile& places = self.cast<const LineOfSight&>().profile;
  return py::dict("distance"_a = view_of(places.distance, self), "x"_a = view_of(places.x, self),
                  "y"_a = view_of(places.y, self), "ground"_a = view_of(places.ground, self),
                  "sigma"_a = view_of(places.sigma, self), "line"_a = view_of(places.line, self),
                  "clearance"_a = view_of(places.clearance, self));
}

void bind_result(py::module_& m) {
  py::class_<LineOfSight>(m, "LineOfSight")
      .def_readonly("p", &LineOfSight::p)
      .def_readonly("k", &LineOfSight::k)
      .def_readonly("verdict", &LineOfSight::verdict)
      .def_readonly("distance", &LineOfSight::distance)
      .def_readonly("azimuth", &LineOfSight::azimuth)
      .def_property_readonly(
          "critical", [](const LineOfSight& self) { return std::pair(self.critical_x, self.critical_y); })
      .def_readonly("critical_distance", &LineOfSight::critical_distance)
      .def_readonly("observer_ground", &LineOfSight::observer_ground)
      .def_readonly("eye_height", &LineOfSight::eye_height)
      .def_readonly("target_ground", &LineOfSight::target_ground)
      .def_readonly("target_top", &LineOfSight::target_top)
      .def_readonly("required_height", &LineOfSight::required_height)
      .def_readonly("likely_height", &LineOfSight::likely_height)
      .def_readonly("error_model", &LineOfSight::error_model)
      .def_readonly("warnings", &LineOfSight::warnings)
      .def("profile", &profile);
}

using Places = std::vector<std::pair<double, double>>;

std::vector<LineOfSight> run(const std::shared_ptr<DemSource>& dem, const std::vector<Observer>& observers,
                             const Places& places, const ErrorModel& model, const ViewshedOptions& options,
                             py::object progress) {
  std::vector<LineOfSightTarget> targets;
  targets.reserve(places.size());
  for (const auto& [x, y] : places) targets.push_back({x, y});
  return ProgressBridge(std::move(progress)).run([&, given = model, used = options](Progress& p) {
    return run_lines_of_sight(*dem, observers, targets, given, used, p);
  });
}

}  // namespace

void bind_line_of_sight(py::module_& m) {
  bind_result(m);
  m.def("lines_of_sight", &run, py::arg("dem"), py::arg("observers"), py::arg("targets"), py::arg("model"),
        py::arg("options"), py::arg("progress"));
}

}  // namespace sightbound::python
