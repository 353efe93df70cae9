// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bindings.h"
#include "numpy_views.h"
#include "progress_bridge.h"
#include <pybind11/stl.h>

#include "jobs/line_of_sight_job.h"
#include "jobs/option_names.h"

namespace sightbound::python {

namespace {

py::dict profile(const py::object& self) {
  using namespace py::literals;
  const SightProfile& places = self.cast<const LineOfSight&>().profile;
  py::dict found("distance"_a = view_of(places.distance, self), "x"_a = view_of(places.x, self),
                 "y"_a = view_of(places.y, self), "ground"_a = view_of(places.ground, self),
                 "sigma"_a = view_of(places.sigma, self), "line"_a = view_of(places.line, self),
                 "clearance"_a = view_of(places.clearance, self));
  if (self.cast<const LineOfSight&>().fresnel) found["fresnel"] = view_of(places.zone, self);
  return found;
}

py::object whole_line(const py::object& self) {
  using namespace py::literals;
  const std::optional<WholeLine>& found = self.cast<const LineOfSight&>().whole_line;
  if (!found) return py::none();
  const py::dict places("distance"_a = view_of(found->distance, self), "x"_a = view_of(found->x, self),
                        "y"_a = view_of(found->y, self), "blocked"_a = view_of(found->blocked, self));
  return py::dict("probability"_a = found->probability, "standard_error"_a = found->standard_error,
                  "interval"_a = py::make_tuple(found->interval.low, found->interval.high),
                  "verdict"_a = found->verdict, "blocked_bound"_a = found->blocked_bound,
                  "blocked_at"_a = py::make_tuple(found->blocked_x, found->blocked_y),
                  "blocked_distance"_a = found->blocked_distance, "blocked_share"_a = found->blocked_share,
                  "fresnel_probability"_a = found->zone_probability, "realisations"_a = found->realisations,
                  "seed"_a = found->seed, "places"_a = places);
}

py::object fresnel(const LineOfSight& self) {
  using namespace py::literals;
  if (!self.fresnel) return py::none();
  const FresnelClearance& found = *self.fresnel;
  return py::dict("clear"_a = found.clear, "worst"_a = py::make_tuple(found.x, found.y),
                  "worst_distance"_a = found.distance, "worst_radius"_a = found.radius,
                  "middle_radius"_a = found.middle_radius, "k"_a = found.k, "p"_a = found.p,
                  "verdict"_a = found.verdict);
}

void bind_extras(py::module_& m) {
  py::class_<LineExtras>(m, "LineExtras")
      .def(py::init<>())
      .def("set_whole_line",
           [](LineExtras& self, int realisations, std::uint64_t seed, const std::string& stand) {
             self.whole_line = WholeLineOptions{realisations, seed, stand_from(stand)};
           })
      .def("set_radio", [](LineExtras& self, double frequency_mhz, double zone_share) {
        self.radio = RadioOptions{frequency_mhz, zone_share};
      });
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
      .def_readonly("critical_clearance", &LineOfSight::critical_clearance)
      .def_readonly("observer_ground", &LineOfSight::observer_ground)
      .def_readonly("eye_height", &LineOfSight::eye_height)
      .def_readonly("target_ground", &LineOfSight::target_ground)
      .def_readonly("target_top", &LineOfSight::target_top)
      .def_readonly("required_height", &LineOfSight::required_height)
      .def_readonly("likely_height", &LineOfSight::likely_height)
      .def_readonly("error_model", &LineOfSight::error_model)
      .def_readonly("warnings", &LineOfSight::warnings)
      .def("profile", &profile)
      .def("whole_line", &whole_line)
      .def("fresnel", &fresnel);
}

using Places = std::vector<std::pair<double, double>>;

std::vector<LineOfSight> run(const std::shared_ptr<DemSource>& dem, const std::vector<Observer>& observers,
                             const Places& places, const ErrorModel& model, const ViewshedOptions& options,
                             const LineExtras& extras, py::object progress) {
  std::vector<LineOfSightTarget> targets;
  targets.reserve(places.size());
  for (const auto& [x, y] : places) targets.push_back({x, y});
  return ProgressBridge(std::move(progress))
      .run([&, given = model, used = options, asked = extras](Progress& p) {
        return run_lines_of_sight(*dem, observers, targets, given, used, asked, p);
      });
}

}  // namespace

void bind_line_of_sight(py::module_& m) {
  bind_extras(m);
  bind_result(m);
  m.def("lines_of_sight", &run, py::arg("dem"), py::arg("observers"), py::arg("targets"), py::arg("model"),
        py::arg("options"), py::arg("extras"), py::arg("progress"));
}

}  // namespace sightbound::python
