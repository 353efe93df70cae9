// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bindings.h"
#include "numpy_views.h"
#include "progress_bridge.h"
#include <pybind11/stl.h>

#include "jobs/option_names.h"
#include "jobs/result_files.h"
#include "jobs/viewshed_job.h"

namespace sightbound::python {

namespace {

using Range = std::pair<double, double>;

void bind_observer(py::module_& m) {
  py::class_<Observer>(m, "Observer")
      .def(py::init([](double x, double y, double height, double target_height, double min_distance,
                       double max_distance, Range azimuth, Range vertical_angle, std::string name) {
             return Observer{x,
                             y,
                             height,
                             target_height,
                             min_distance,
                             max_distance,
                             azimuth.first,
                             azimuth.second,
                             vertical_angle.first,
                             vertical_angle.second,
                             std::move(name)};
           }),
           py::arg("x"), py::arg("y"), py::arg("height"), py::arg("target_height"), py::arg("min_distance"),
           py::arg("max_distance"), py::arg("azimuth"), py::arg("vertical_angle"), py::arg("name"))
      .def_readwrite("number", &Observer::number);
}

void bind_extent(py::module_& m) {
  py::class_<Extent>(m, "Extent")
      .def(py::init([](double x_min, double y_min, double x_max, double y_max) {
             return Extent{x_min, y_min, x_max, y_max};
           }),
           py::arg("x_min"), py::arg("y_min"), py::arg("x_max"), py::arg("y_max"));
}

void bind_options(py::module_& m) {
  py::class_<ViewshedOptions>(m, "ViewshedOptions")
      .def(py::init<>())
      .def_readwrite("confidence", &ViewshedOptions::confidence)
      .def_readwrite("refraction", &ViewshedOptions::refraction)
      .def_readwrite("curvature", &ViewshedOptions::curvature)
      .def_property(
          "stand", [](const ViewshedOptions& self) { return name_of(self.stand); },
          [](ViewshedOptions& self, const std::string& name) { self.stand = stand_from(name); })
      .def_property(
          "combine", [](const ViewshedOptions& self) { return name_of(self.combine); },
          [](ViewshedOptions& self, const std::string& name) { self.combine = combine_from(name); })
      .def_property(
          "height_reference", [](const ViewshedOptions& self) { return name_of(self.height_reference); },
          [](ViewshedOptions& self, const std::string& name) {
            self.height_reference = height_reference_from(name);
          })
      .def("set_ground",
           [](ViewshedOptions& self, std::shared_ptr<DemSource> dem) { self.ground = std::move(dem); })
      .def_readwrite("extent", &ViewshedOptions::extent)
      .def_readwrite("see_across_nodata", &ViewshedOptions::see_across_nodata)
      .def_readwrite("heights", &ViewshedOptions::heights)
      .def_readwrite("threads", &ViewshedOptions::threads)
      .def_readwrite("memory_budget", &ViewshedOptions::memory_budget);
}

py::dict to_dict(const ObserverReport& one) {
  using namespace py::literals;
  return py::dict("x"_a = one.x, "y"_a = one.y, "name"_a = one.name, "ground_height"_a = one.ground_height,
                  "eye_height"_a = one.eye_height, "visible_m2"_a = one.visible_m2,
                  "uncertain_m2"_a = one.uncertain_m2, "hidden_m2"_a = one.hidden_m2,
                  "status"_a = one.status);
}

py::dict to_dict(const ViewshedReport& report) {
  using namespace py::literals;
  py::list observers;
  for (const ObserverReport& one : report.observers) observers.append(to_dict(one));
  return py::dict("observers"_a = observers, "visible_m2"_a = report.visible_m2,
                  "uncertain_m2"_a = report.uncertain_m2, "hidden_m2"_a = report.hidden_m2,
                  "hole_doubt_m2"_a = report.hole_doubt_m2, "memory_bytes"_a = report.memory_bytes,
                  "error_model"_a = report.error_model, "warnings"_a = report.warnings);
}

// The array of a grid of `self`, or None where it was not computed.
template <auto GridField>
py::object grid_of(const py::object& self) {
  const auto& grid = self.cast<const ViewshedResult&>().*GridField;
  if (grid.empty()) return py::none();
  return view_of(grid, self);
}

py::array count_grid(const py::object& self) {
  auto& result = self.cast<ViewshedResult&>();
  if (result.count.empty()) result.count = count_of(result.verdict);
  return view_of(result.count, self);
}

void prepend_warnings(ViewshedResult& result, const std::vector<std::string>& earlier) {
  auto& warnings = result.report.warnings;
  warnings.insert(warnings.begin(), earlier.begin(), earlier.end());
}

void bind_result(py::module_& m) {
  py::class_<ViewshedResult>(m, "ViewshedResult")
      .def_property_readonly("confidence", &grid_of<&ViewshedResult::confidence>)
      .def_property_readonly("verdict", &grid_of<&ViewshedResult::verdict>)
      .def_property_readonly("count", &count_grid)
      .def_property_readonly("lowest_visible_height", &grid_of<&ViewshedResult::lowest_visible_height>)
      .def_property_readonly("likely_visible_height", &grid_of<&ViewshedResult::likely_visible_height>)
      .def_property_readonly("rows", [](const ViewshedResult& self) { return self.confidence.rows(); })
      .def_property_readonly("cols", [](const ViewshedResult& self) { return self.confidence.cols(); })
      .def_property_readonly(
          "geotransform",
          [](const ViewshedResult& self) { return py::tuple(py::cast(self.geotransform.coefficients())); })
      .def_readonly("crs_wkt", &ViewshedResult::crs_wkt)
      .def("prepend_warnings", &prepend_warnings)
      .def("report", [](const ViewshedResult& self) { return to_dict(self.report); });
}

void write(const ViewshedResult& result, const std::vector<Observer>& observers,
           const ViewshedOptions& options, const ViewshedFiles& files, py::object progress) {
  ProgressBridge(std::move(progress)).run([&, used = options, wanted = files](Progress& p) {
    write_viewshed(result, observers, used, wanted, p);
  });
}

}  // namespace

void bind_viewshed(py::module_& m) {
  bind_observer(m);
  bind_extent(m);
  bind_options(m);
  bind_result(m);
  py::class_<ViewshedFiles>(m, "ViewshedFiles")
      .def(py::init<>())
      .def_readwrite("confidence", &ViewshedFiles::confidence)
      .def_readwrite("verdict", &ViewshedFiles::verdict)
      .def_readwrite("count", &ViewshedFiles::count)
      .def_readwrite("height", &ViewshedFiles::lowest_visible_height)
      .def_readwrite("likely_height", &ViewshedFiles::likely_visible_height)
      .def_readwrite("creation_options", &ViewshedFiles::creation_options);
  m.def(
      "viewshed",
      [](const std::shared_ptr<DemSource>& dem, const std::vector<Observer>& observers,
         const ErrorModel& model, const ViewshedOptions& options, py::object progress) {
        return ProgressBridge(std::move(progress)).run([&, given = model, used = options](Progress& p) {
          return run_viewshed(*dem, observers, given, used, p);
        });
      },
      py::arg("dem"), py::arg("observers"), py::arg("model"), py::arg("options"), py::arg("progress"));
  m.def("write_viewshed", &write, py::arg("result"), py::arg("observers"), py::arg("options"),
        py::arg("files"), py::arg("progress"));
}

}  // namespace sightbound::python
