// SPDX-License-Identifier: GPL-3.0-or-later
#include <limits>
#include <memory>
#include <vector>

#include "bindings.h"
#include "numpy_views.h"
#include "progress_bridge.h"
#include <pybind11/stl.h>

#include "jobs/intervisibility_job.h"

namespace sightbound::python {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// One value of each pair.
template <class Value, class Of>
py::array column(const Intervisibility& network, const Of& of) {
  py::array_t<Value> values(static_cast<py::ssize_t>(network.pairs.size()));
  auto at = values.template mutable_unchecked<1>();
  for (std::size_t i = 0; i < network.pairs.size(); ++i)
    at(static_cast<py::ssize_t>(i)) = of(network.pairs[i]);
  return read_only(values);
}

py::array sight(const Intervisibility& network, double LineOfSight::*field) {
  return column<double>(network, [field](const JudgedPair& pair) {
    return pair.status == PairStatus::kJudged ? pair.sight.*field : kNan;
  });
}

template <class Field>
py::array whole(const Intervisibility& network, Field field) {
  return column<double>(network, [field](const JudgedPair& pair) {
    return pair.sight.whole_line ? static_cast<double>((*pair.sight.whole_line).*field) : kNan;
  });
}

template <class Field>
py::array fresnel(const Intervisibility& network, Field field) {
  return column<double>(network, [field](const JudgedPair& pair) {
    return pair.sight.fresnel ? static_cast<double>((*pair.sight.fresnel).*field) : kNan;
  });
}

// Columns of the table, NaN (verdict 255) where a pair has no value.
py::dict columns(const Intervisibility& network) {
  using namespace py::literals;
  py::list status;
  for (const JudgedPair& pair : network.pairs) status.append(name_of(pair.status));
  py::dict table(
      "a"_a = column<std::int64_t>(
          network, [](const JudgedPair& pair) { return static_cast<std::int64_t>(pair.from); }),
      "b"_a = column<std::int64_t>(network,
                                   [](const JudgedPair& pair) { return static_cast<std::int64_t>(pair.to); }),
      "status"_a = status,
      "verdict"_a = column<std::uint8_t>(network, [](const JudgedPair& pair) { return pair.sight.verdict; }),
      "p"_a = sight(network, &LineOfSight::p), "k"_a = sight(network, &LineOfSight::k),
      "distance"_a = sight(network, &LineOfSight::distance),
      "azimuth"_a = sight(network, &LineOfSight::azimuth),
      "critical_x"_a = sight(network, &LineOfSight::critical_x),
      "critical_y"_a = sight(network, &LineOfSight::critical_y),
      "critical_distance"_a = sight(network, &LineOfSight::critical_distance),
      "critical_clearance"_a = sight(network, &LineOfSight::critical_clearance));
  table["probability"] = whole(network, &WholeLine::probability);
  table["standard_error"] = whole(network, &WholeLine::standard_error);
  table["blocked_bound"] = whole(network, &WholeLine::blocked_bound);
  table["fresnel_probability"] = whole(network, &WholeLine::zone_probability);
  table["fresnel_clear"] = fresnel(network, &FresnelClearance::clear);
  table["fresnel_p"] = fresnel(network, &FresnelClearance::p);
  table["fresnel_distance"] = fresnel(network, &FresnelClearance::distance);
  return table;
}

std::vector<Station> stations(const DoubleArray& points) {
  const auto at = points.unchecked<2>();
  std::vector<Station> all;
  for (py::ssize_t i = 0; i < at.shape(0); ++i) all.push_back({at(i, 0), at(i, 1), at(i, 2)});
  return all;
}

Intervisibility run(const std::shared_ptr<DemSource>& dem, const DoubleArray& points_a,
                    const DoubleArray& points_b, const ErrorModel& model, const ViewshedOptions& options,
                    const LineExtras& extras, double max_distance, const py::object& progress) {
  const std::vector<Station> a = stations(points_a), b = stations(points_b);
  return ProgressBridge(progress).run([&, given = model, used = options, asked = extras](Progress& p) {
    return run_intervisibility(*dem, a, b, given, used, asked, {max_distance}, p);
  });
}

}  // namespace

void bind_intervisibility(py::module_& m) {
  py::class_<Intervisibility>(m, "Intervisibility")
      .def("columns", &columns)
      .def_property_readonly(
          "shape", [](const Intervisibility& self) { return py::make_tuple(self.points_a, self.points_b); })
      .def_readonly("too_far", &Intervisibility::too_far)
      .def_readonly("error_model", &Intervisibility::error_model)
      .def_readonly("warnings", &Intervisibility::warnings);
  m.def("intervisibility", &run, py::arg("dem"), py::arg("points_a"), py::arg("points_b"), py::arg("model"),
        py::arg("options"), py::arg("extras"), py::arg("max_distance"), py::arg("progress"));
}

}  // namespace sightbound::python
