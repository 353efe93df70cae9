// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bindings.h"
#include "numpy_views.h"
#include "progress_bridge.h"
#include <pybind11/stl.h>

#include "jobs/hidden_files.h"
#include "jobs/option_names.h"
#include "jobs/volume_targets_job.h"

namespace sightbound::python {

namespace {

using Volume = std::shared_ptr<ErrorVolume>;
using Views = std::vector<ViewVolume>;
using Layer = std::shared_ptr<LayerResult>;

py::dict counts_of(const SightEstimate& found) {
  using namespace py::literals;
  return py::dict("view_places"_a = found.view_places, "targets"_a = found.targets, "lines"_a = found.lines,
                  "bytes"_a = found.bytes);
}

Layer layer(const Volume& volume, const Views& views, double target_height, const VolumeSightOptions& options,
            const py::object& progress) {
  return ProgressBridge(progress).run([&, used = options](Progress& p) {
    return std::make_shared<LayerResult>(see_layer(*volume, views, target_height, used, p));
  });
}

void write(const Layer& layer, const std::string& confidence, const std::string& verdict,
           const std::vector<std::string>& creation_options, int threads, const py::object& progress) {
  ProgressBridge(progress).run([&](Progress& p) {
    write_layer(*layer, {confidence, verdict, creation_options}, threads, p);
  });
}

// (verdicts, p) as arrays, counts, warnings.
py::tuple targets(const Volume& volume, const Views& views,
                  const std::vector<std::pair<double, double>>& places, const std::vector<double>& heights,
                  const std::string& reference, const VolumeSightOptions& options,
                  const py::object& progress) {
  std::vector<TargetPoint> asked;
  for (std::size_t n = 0; n < places.size(); ++n)
    asked.push_back({places[n].first, places[n].second, heights.at(n)});
  const HeightReference from = height_reference_from(reference);
  const TargetsResult found = ProgressBridge(progress).run(
      [&, used = options](Progress& p) { return see_targets(*volume, views, asked, from, used, p); });
  const auto count = static_cast<py::ssize_t>(found.answers.size());
  py::array_t<std::uint8_t> verdict(count);
  py::array_t<float> p(count);
  for (py::ssize_t n = 0; n < count; ++n) {
    const TargetAnswer& answer = found.answers[static_cast<std::size_t>(n)];
    verdict.mutable_at(n) = answer.verdict;
    p.mutable_at(n) = answer.verdict == kNoVerdict ? std::numeric_limits<float>::quiet_NaN() : answer.p;
  }
  return py::make_tuple(verdict, p, counts_of(found.estimate), found.warnings);
}

}  // namespace

void bind_volume_targets(py::module_& m) {
  py::class_<LayerResult, Layer>(m, "VolumeLayer")
      .def("write", &write, py::arg("confidence"), py::arg("verdict"), py::arg("creation_options"),
           py::arg("threads"), py::arg("progress"))
      .def_property_readonly(
          "verdict",
          [](const py::object& self) { return view_of(self.cast<const LayerResult&>().verdict, self); })
      .def_property_readonly(
          "confidence",
          [](const py::object& self) { return view_of(self.cast<const LayerResult&>().confidence, self); })
      .def_property_readonly(
          "geotransform",
          [](const LayerResult& self) { return py::tuple(py::cast(self.geotransform.coefficients())); })
      .def_readonly("crs_wkt", &LayerResult::crs_wkt)
      .def_property_readonly("observers", [](const LayerResult& self) { return self.info.observers; })
      .def_property_readonly("error_model", [](const LayerResult& self) { return self.info.error_model; })
      .def_property_readonly("counts", [](const LayerResult& self) { return counts_of(self.estimate); })
      .def_readonly("warnings", &LayerResult::warnings);
  m.def("volume_layer", &layer, py::arg("volume"), py::arg("views"), py::arg("target_height"),
        py::arg("options"), py::arg("progress"));
  m.def("volume_targets", &targets, py::arg("volume"), py::arg("views"), py::arg("targets"),
        py::arg("target_heights"), py::arg("target_height_reference"), py::arg("options"),
        py::arg("progress"));
}

}  // namespace sightbound::python
