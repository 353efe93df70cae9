// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <utility>
#include <vector>

#include "bindings.h"
#include "numpy_views.h"
#include "progress_bridge.h"
#include "tin_targets.h"
#include <pybind11/stl.h>

#include "jobs/simplify_tin_job.h"
#include "terrain/regular_tin.h"

namespace sightbound::python {

namespace {

using Doubles = py::array_t<double, py::array::c_style>;
using Flags = py::array_t<std::uint8_t, py::array::c_style>;

// Polylines [k, 3] in the CRS, heights NaN where they have none.
void set_break_lines(SimplifyTinJob& job, const std::shared_ptr<RegularTin>& tin,
                     const std::vector<Doubles>& lines) {
  for (const Doubles& line : lines) {
    std::vector<Xyz>& local = job.break_lines.emplace_back();
    for (py::ssize_t i = 0; i < line.shape(0); ++i)
      local.push_back(tin->tin.from_crs({line.at(i, 0), line.at(i, 1), line.at(i, 2)}));
  }
}

py::tuple simplify(const std::shared_ptr<RegularTin>& tin, const SimplifyTinJob& job,
                   const py::object& progress) {
  using namespace py::literals;
  SimplifiedAnyTin made = ProgressBridge(progress).run(
      [&, used = job](Progress& p) { return run_simplify_tin(tin->tin, used, p); });
  const SimplifyTinReport& found = made.report;
  py::dict report("faces_before"_a = found.faces_before, "faces_after"_a = found.faces_after,
                  "method"_a = found.vertical ? "vertical" : "distance",
                  "least_tolerance"_a = found.least_tolerance_m,
                  "largest_tolerance"_a = found.largest_tolerance_m,
                  "largest_deviation"_a = found.largest_deviation_m, "largest_ratio"_a = found.largest_ratio,
                  "border_tolerance"_a = found.border_tolerance_m, "voxel"_a = found.voxel_m,
                  "faces_not_held"_a = found.faces_not_held, "fixed_vertices"_a = found.fixed_vertices,
                  "error_model"_a = found.error_model, "warnings"_a = found.warnings);
  return py::make_tuple(std::make_shared<RegularTin>(RegularTin{std::move(made.tin), {}}), std::move(report));
}

}  // namespace

void bind_simplify_tin(py::module_& m) {
  py::class_<SimplifyTinJob>(m, "SimplifyTinJob")
      .def(py::init<>())
      .def_readwrite("tolerance", &SimplifyTinJob::tolerance_m)
      .def(
          "set_tolerances",
          [](SimplifyTinJob& self, const FloatArray& values) {
            self.tolerances_m.assign(values.data(), values.data() + values.size());
          },
          py::arg("values").noconvert())
      .def_readwrite("model", &SimplifyTinJob::model)
      .def_readwrite("confidence", &SimplifyTinJob::confidence)
      .def_readwrite("border_tolerance", &SimplifyTinJob::border_tolerance_m)
      .def("set_break_lines", &set_break_lines, py::arg("tin"), py::arg("lines"))
      .def_readwrite("break_line_tolerance", &SimplifyTinJob::break_line_tolerance_m)
      .def(
          "set_keep",
          [](SimplifyTinJob& self, const Flags& values) {
            self.keep.assign(values.data(), values.data() + values.size());
          },
          py::arg("values").noconvert())
      .def("set_target", &set_target<SimplifyTinJob>, py::arg("faces"), py::arg("bytes"), py::arg("ending"))
      .def_readwrite("voxel", &SimplifyTinJob::voxel_m)
      .def_readwrite("threads", &SimplifyTinJob::threads)
      .def_readwrite("memory_budget", &SimplifyTinJob::memory_budget);
  m.def("simplify_tin", &simplify, py::arg("tin"), py::arg("job"), py::arg("progress"));
}

}  // namespace sightbound::python
