// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <memory>
#include <utility>

#include "bindings.h"
#include "numpy_views.h"
#include "progress_bridge.h"
#include "tin_targets.h"
#include <pybind11/stl.h>

#include "jobs/dem_to_tin_job.h"
#include "jobs/visibility_tolerance_job.h"
#include "terrain/regular_tin.h"

namespace sightbound::python {

namespace {

// `values` are in the user's row order; `flipped` as the DEM's.
void set_keep(DemToTinOptions& options, const FloatArray& values, bool flipped) {
  Grid<float> grid(static_cast<int>(values.shape(0)), static_cast<int>(values.shape(1)));
  std::copy_n(values.data(), grid.size(), grid.data());
  if (flipped) grid.flip_rows();
  options.keep = std::make_shared<const Grid<float>>(std::move(grid));
}

// `places`: (n, 2).
void add_break_line(DemToTinOptions& options, const DoubleArray& places) {
  std::vector<Xy>& line = options.break_lines.emplace_back();
  for (py::ssize_t n = 0; n < places.shape(0); ++n) line.push_back({places.at(n, 0), places.at(n, 1)});
}

void bind_options(py::module_& m) {
  py::class_<DemToTinOptions>(m, "DemToTinOptions")
      .def(py::init<>())
      .def_property(
          "error_is_tolerance",
          [](const DemToTinOptions& self) { return self.error_means == ErrorMeans::kTolerance; },
          [](DemToTinOptions& self, bool is) {
            self.error_means = is ? ErrorMeans::kTolerance : ErrorMeans::kConfidence;
          })
      .def_readwrite("levels", &DemToTinOptions::levels)
      .def_readwrite("extent", &DemToTinOptions::extent)
      .def("set_keep", &set_keep, py::arg("values").noconvert(), py::arg("flipped"))
      .def_readwrite("keep_border", &DemToTinOptions::keep_border)
      .def_readwrite("border_tolerance", &DemToTinOptions::border_tolerance_m)
      .def("add_break_line", &add_break_line, py::arg("places").noconvert())
      .def_readwrite("break_line_tolerance", &DemToTinOptions::break_line_tolerance_m)
      .def("set_target", &set_target<DemToTinOptions>, py::arg("faces"), py::arg("bytes"), py::arg("ending"))
      .def_readwrite("threads", &DemToTinOptions::threads)
      .def_readwrite("memory_budget", &DemToTinOptions::memory_budget);
}

// For each level (TIN, report, vertex of the next level that each vertex was drawn into; None in the last).
py::list dem_to_tin(const std::shared_ptr<DemSource>& dem, const ErrorModel& model,
                    const DemToTinOptions& options, const py::object& progress) {
  using namespace py::literals;
  DemToTin made = ProgressBridge(progress).run(
      [&, given = model, used = options](Progress& p) { return run_dem_to_tin(*dem, given, used, p); });
  py::list levels;
  for (std::size_t n = 0; n < made.levels.size(); ++n) {
    SimplifiedTin& level = made.levels[n];
    py::dict report("method"_a = "vertical", "faces_before"_a = level.report.faces_before,
                    "faces_after"_a = level.report.faces_after,
                    "largest_deviation"_a = level.report.largest_deviation_m,
                    "largest_ratio"_a = level.report.largest_ratio,
                    "least_tolerance"_a = made.factors[n] * made.least_tolerance_m,
                    "largest_tolerance"_a = made.factors[n] * made.largest_tolerance_m,
                    "error_model"_a = made.error_model, "warnings"_a = made.warnings);
    py::object coarser = py::none();
    if (!level.coarser_vertex.empty()) {
      coarser = py::array_t<std::int32_t>(static_cast<py::ssize_t>(level.coarser_vertex.size()),
                                          level.coarser_vertex.data());
    }
    auto tin = std::make_shared<RegularTin>(RegularTin{std::move(level.tin), {}});
    levels.append(py::make_tuple(std::move(tin), std::move(report), std::move(coarser)));
  }
  return levels;
}

py::tuple visibility_tolerance(const std::shared_ptr<DemSource>& dem, const std::vector<Observer>& observers,
                               const ErrorModel& model, double tolerance, const ViewshedOptions& options,
                               const py::object& progress) {
  using namespace py::literals;
  VisibilityTolerance made =
      ProgressBridge(progress).run([&, who = observers, given = model, used = options](Progress& p) {
        return run_visibility_tolerance(*dem, who, given, tolerance, used, p);
      });
  py::dict report("free_share"_a = made.free_share, "error_model"_a = made.error_model,
                  "warnings"_a = made.warnings);
  return py::make_tuple(array_from(std::move(made.tolerance)), std::move(report));
}

}  // namespace

void bind_simplify(py::module_& m) {
  bind_options(m);
  m.def("dem_to_tin", &dem_to_tin, py::arg("dem"), py::arg("model"), py::arg("options"), py::arg("progress"));
  m.def("visibility_tolerance", &visibility_tolerance, py::arg("dem"), py::arg("observers"), py::arg("model"),
        py::arg("tolerance"), py::arg("options"), py::arg("progress"));
}

}  // namespace sightbound::python
