// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bindings.h"
#include "numpy_views.h"
#include "progress_bridge.h"
#include <pybind11/stl.h>

#include "error_model/error_model.h"
#include "error_model/estimate.h"
#include "error_model/products.h"
#include "io/error_rasters.h"
#include "jobs/resolve_error.h"

namespace sightbound::python {

namespace {

// A quantity in Python: None (from the DEM), metres, (path, band) of a raster. Arrays come by set_... and
// stay inside.
struct ToPython {
  py::object operator()(FromDem) const { return py::none(); }
  py::object operator()(double metres) const { return py::float_(metres); }
  py::object operator()(const RasterFile& raster) const { return py::make_tuple(raster.path, raster.band); }
  py::object operator()(const SharedGrid&) const { return py::none(); }
};

Quantity quantity_from(const py::object& value) {
  if (value.is_none()) return FromDem{};
  if (py::isinstance<py::float_>(value)) return value.cast<double>();
  const auto [path, band] = value.cast<std::pair<std::string, int>>();
  return RasterFile{path, band};
}

// A named choice of the core as its name; None when unset.
template <class Choice>
py::object name_or_none(const std::optional<Choice>& choice) {
  return choice ? py::cast(name_of(*choice)) : py::object(py::none());
}
template <class Choice>
std::optional<Choice> choice_from(const std::optional<std::string>& name,
                                  Choice (*from_name)(const std::string&)) {
  return name ? std::optional(from_name(*name)) : std::nullopt;
}

template <Quantity ErrorModel::*Field>
void def_quantity(py::class_<ErrorModel>& model, const char* name) {
  model.def_property(
      name, [](const ErrorModel& self) { return std::visit(ToPython{}, self.*Field); },
      [](ErrorModel& self, const py::object& value) { self.*Field = quantity_from(value); });
}

// `values` are in the user's row order; `flipped` as the DEM's.
template <Quantity ErrorModel::*Field>
void set_array(ErrorModel& model, const FloatArray& values, bool flipped) {
  Grid<float> grid(static_cast<int>(values.shape(0)), static_cast<int>(values.shape(1)));
  std::copy_n(values.data(), grid.size(), grid.data());
  if (flipped) grid.flip_rows();
  model.*Field = std::make_shared<const Grid<float>>(std::move(grid));
}

void bind_model(py::module_& m) {
  py::class_<ErrorModel> model(m, "ErrorModel");
  def_quantity<&ErrorModel::vertical_rmse>(model, "vertical_rmse");
  def_quantity<&ErrorModel::geologic_variation>(model, "geologic_variation");
  model.def(py::init<>())
      .def("copy", [](const ErrorModel& self) { return ErrorModel(self); })
      .def_readwrite("horizontal_rmse", &ErrorModel::horizontal_rmse)
      .def_property(
          "geologic_model", [](const ErrorModel& self) { return name_of(self.geologic_shape); },
          [](ErrorModel& self, const std::string& name) { self.geologic_shape = geologic_shape_from(name); })
      .def_readwrite("geologic_range", &ErrorModel::geologic_range)
      .def_readwrite("growth_exponent", &ErrorModel::growth_exponent)
      .def_readonly("typical_m", &ErrorModel::typical_m)
      .def_readwrite("terrain_types", &ErrorModel::terrain_types)
      .def_property(
          "tails", [](const ErrorModel& self) { return name_or_none(self.tails); },
          [](ErrorModel& self, const std::optional<std::string>& name) {
            self.tails = choice_from(name, tails_from);
          })
      .def_property(
          "samples_or_means", [](const ErrorModel& self) { return name_or_none(self.samples_or_means); },
          [](ErrorModel& self, const std::optional<std::string>& name) {
            self.samples_or_means = choice_from(name, cell_content_from);
          })
      .def_readwrite("correlation_length", &ErrorModel::correlation_length)
      .def_readwrite("shared_bias", &ErrorModel::shared_bias)
      .def_readwrite("ridge_gain", &ErrorModel::ridge_gain)
      .def_readwrite("level_variance", &ErrorModel::level_variance)
      .def_readwrite("step_variance", &ErrorModel::step_variance)
      .def_readwrite("level_tail", &ErrorModel::level_tail)
      .def_readwrite("step_tail", &ErrorModel::step_tail)
      .def("set_vertical_rmse", &set_array<&ErrorModel::vertical_rmse>, py::arg("values").noconvert(),
           py::arg("flipped"))
      .def("set_geologic_variation", &set_array<&ErrorModel::geologic_variation>,
           py::arg("values").noconvert(), py::arg("flipped"))
      .def("validate", &ErrorModel::validate)
      .def("to_json", &ErrorModel::to_json)
      .def_static("from_json", &ErrorModel::from_json, py::arg("text"));
}

void bind_terrain_types(py::module_& m) {
  py::class_<TerrainTypes>(m, "TerrainTypes")
      .def(py::init([](std::string path, std::string layer, std::string field,
                       std::map<std::string, double> table) {
             return TerrainTypes{std::move(path), std::move(layer), std::move(field), std::move(table)};
           }),
           py::arg("path"), py::arg("layer"), py::arg("field"), py::arg("table"))
      .def_readonly("path", &TerrainTypes::path)
      .def_readonly("layer", &TerrainTypes::layer)
      .def_readonly("field", &TerrainTypes::field)
      .def_readonly("table", &TerrainTypes::table);
  m.def("terrain_table", &default_terrain_table);
  m.def("read_terrain_table", &read_terrain_table, py::arg("path"));
}

void bind_accuracy(py::module_& m) {
  m.def("vertical_sigma_of_le90",
        [](double metres) { return vertical_sigma(metres, VerticalMeasure::kLe90); });
  m.def("vertical_sigma_of_le95",
        [](double metres) { return vertical_sigma(metres, VerticalMeasure::kLe95); });
  m.def("horizontal_sigma_of_ce90",
        [](double metres) { return horizontal_sigma(metres, HorizontalMeasure::kCe90); });
  m.def("horizontal_sigma_of_ce95",
        [](double metres) { return horizontal_sigma(metres, HorizontalMeasure::kCe95); });
  m.def(
      "two_sided_quantile",
      [](double confidence, const std::string& tails) {
        return two_sided_quantile(confidence, tails_from(tails));
      },
      py::arg("confidence"), py::arg("tails"));
  m.def(
      "tails_cdf", [](double k, const std::string& tails) { return cdf(k, tails_from(tails)); }, py::arg("k"),
      py::arg("tails"));
}

void bind_products(py::module_& m) {
  using namespace py::literals;
  m.def("products", [] {
    py::dict all;
    for (const Product& product : products()) {
      all[py::str(product.name)] =
          py::dict("title"_a = product.title, "vertical_rmse"_a = product.vertical_rmse(),
                   "shared"_a = product.shared, "source"_a = product.source);
    }
    return all;
  });
  m.def(
      "require_product", [](const std::string& name) { product_from(name); }, py::arg("name"));
}

// What the DEM itself tells; `warnings` are data.
void bind_estimate(py::module_& m) {
  py::class_<Estimate::Quantiles>(m, "SelfCheck")
      .def_readonly("places", &Estimate::Quantiles::places)
      .def_readonly("median", &Estimate::Quantiles::median)
      .def_readonly("q683", &Estimate::Quantiles::q683)
      .def_readonly("q90", &Estimate::Quantiles::q90)
      .def_readonly("q95", &Estimate::Quantiles::q95)
      .def_readonly("q99", &Estimate::Quantiles::q99);
  py::class_<Estimate>(m, "Estimate")
      .def_readonly("growth_exponent", &Estimate::growth_exponent)
      .def_readonly("typical_m", &Estimate::typical_m)
      .def_readonly("rounding_m", &Estimate::rounding_m)
      .def_property_readonly(
          "rms_of_spacing",
          [](const Estimate& e) { return std::vector<double>(e.rms_of_spacing, e.rms_of_spacing + 3); })
      .def_property_readonly("samples_or_means", [](const Estimate& e) { return name_of(e.content); })
      .def_readonly("means_score", &Estimate::content_score)
      .def_readonly("ridge_gain", &Estimate::ridge_gain)
      .def_property_readonly("tails", [](const Estimate& e) { return name_of(e.tails); })
      .def_readonly("local_scale", &Estimate::local_scale)
      .def_property_readonly("level_variance", [](const Estimate& e) { return e.steps.level.variance; })
      .def_property_readonly("step_variance", [](const Estimate& e) { return e.steps.step.variance; })
      .def_property_readonly("level_tail", [](const Estimate& e) { return e.steps.level.tail; })
      .def_property_readonly("step_tail", [](const Estimate& e) { return e.steps.step.tail; })
      .def_readonly("self_check", &Estimate::self_check)
      .def_readonly("warnings", &Estimate::warnings);
  m.def(
      "estimate",
      [](const std::shared_ptr<DemSource>& dem, const std::optional<std::string>& samples_or_means,
         py::object progress) {
        std::optional<CellContent> content;
        if (samples_or_means) content = cell_content_from(*samples_or_means);
        return ProgressBridge(std::move(progress)).run([&](Progress& p) {
          return estimate(*dem, content, p);
        });
      },
      py::arg("dem"), py::arg("samples_or_means"), py::arg("progress"));
  m.def("with_estimate", &with_estimate, py::arg("model"), py::arg("estimate"));
  m.def(
      "complete_model",
      [](const std::shared_ptr<DemSource>& dem, const ErrorModel& model, py::object progress) {
        return ProgressBridge(std::move(progress)).run([&, given = model](Progress& p) {
          std::vector<std::string> warnings;
          ErrorModel completed = complete_model(given, *dem, warnings, p);
          return std::pair(std::move(completed), std::move(warnings));
        });
      },
      py::arg("dem"), py::arg("model"), py::arg("progress"));
}

}  // namespace

void bind_error_model(py::module_& m) {
  bind_terrain_types(m);
  bind_model(m);
  bind_accuracy(m);
  bind_products(m);
  bind_estimate(m);
}

}  // namespace sightbound::python
