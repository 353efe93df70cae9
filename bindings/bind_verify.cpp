// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "bindings.h"
#include "numpy_views.h"
#include "progress_bridge.h"
#include <pybind11/stl.h>

#include "jobs/verify_job.h"
#include "terrain/regular_tin.h"

namespace sightbound::python {

namespace {

using namespace py::literals;
using Held = std::shared_ptr<RegularTin>;

py::tuple to_tuple(const Xyz& p) { return py::make_tuple(p.x, p.y, p.z); }

py::dict to_dict(const Extreme& found) {
  return py::dict("bound"_a = found.bound, "measured"_a = found.measured, "place"_a = to_tuple(found.place),
                  "face"_a = found.simplified_face);
}
py::dict to_dict(const FaceCount& found) {
  return py::dict("count"_a = found.count,
                  "first"_a = found.count == 0 ? py::object(py::none()) : py::int_(found.first));
}
py::dict to_dict(const Area& found) {
  return py::dict("m2"_a = found.m2,
                  "place"_a = found.m2 == 0 ? py::object(py::none()) : to_tuple(found.place));
}

py::dict to_dict(const VerifyReport& report) {
  return py::dict("method"_a = report.method, "largest_deviation"_a = to_dict(report.largest_deviation),
                  "largest_ratio"_a = to_dict(report.largest_ratio),
                  "within_tolerance"_a = report.within_tolerance(), "well_formed"_a = report.well_formed(),
                  "flipped"_a = to_dict(report.flipped), "folded"_a = to_dict(report.folded),
                  "degenerate"_a = to_dict(report.degenerate), "uncovered"_a = to_dict(report.uncovered),
                  "surplus"_a = to_dict(report.surplus), "uncovered_vertices"_a = report.uncovered_vertices,
                  "resolution"_a = report.resolution_m, "faces_before"_a = report.original_faces,
                  "faces_after"_a = report.simplified_faces, "pieces"_a = report.pieces,
                  "mean_deviation"_a = report.mean_deviation, "rms_deviation"_a = report.rms_deviation,
                  "histogram"_a = py::dict("low"_a = report.histogram.low, "high"_a = report.histogram.high,
                                           "counts"_a = report.histogram.counts));
}

Tolerance tolerance_of(double metres, const std::optional<FloatArray>& of_vertices) {
  if (!of_vertices) return {metres};
  return {metres, {of_vertices->data(), static_cast<std::size_t>(of_vertices->size())}};
}

// (report, deviation at each vertex).
template <class Original>
py::tuple run(const Original& original, const Held& simplified, const Tolerance& tolerance,
              const VerifyJobOptions& options, const py::object& progress) {
  VerifyReport report = ProgressBridge(progress).run(
      [&](Progress& p) { return run_verify(original, simplified->tin, tolerance, options, p); });
  const std::vector<float>& found = report.vertex_deviation;
  const py::array_t<float> deviation(static_cast<py::ssize_t>(found.size()), found.data());
  return py::make_tuple(to_dict(report), deviation);
}

py::tuple of_tin(const Held& original, const Held& simplified, double tolerance,
                 const std::optional<FloatArray>& of_vertices, double resolution, int threads,
                 std::size_t memory_budget, const py::object& progress) {
  return run(original->tin, simplified, tolerance_of(tolerance, of_vertices),
             {resolution, threads, memory_budget}, progress);
}

py::tuple of_dem(const std::shared_ptr<DemSource>& original, const Held& simplified, double tolerance,
                 const std::optional<FloatArray>& of_vertices, double resolution, int threads,
                 std::size_t memory_budget, const py::object& progress) {
  return run(*original, simplified, tolerance_of(tolerance, of_vertices),
             {resolution, threads, memory_budget}, progress);
}

}  // namespace

void bind_verify(py::module_& m) {
  const auto def = [&](const char* name, auto function) {
    m.def(name, function, py::arg("original"), py::arg("simplified"), py::arg("tolerance"),
          py::arg("of_vertices").noconvert(), py::arg("resolution"), py::arg("threads"),
          py::arg("memory_budget"), py::arg("progress"));
  };
  def("verify_tin", &of_tin);
  def("verify_dem", &of_dem);
}

}  // namespace sightbound::python
