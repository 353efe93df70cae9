// SPDX-License-Identifier: GPL-3.0-or-later
// The defaults of the core under the names they have as Python arguments. Unlimited and "learn it from the
// DEM" are None.
#include <cmath>
#include <string>
#include <vector>

#include "bindings.h"
#include <pybind11/stl.h>

#include "error_model/error_model.h"
#include "error_model/products.h"
#include "jobs/error_surfaces_job.h"
#include "jobs/line_of_sight_job.h"
#include "jobs/option_names.h"
#include "jobs/probable_viewshed_job.h"
#include "jobs/volume_viewshed_job.h"

namespace sightbound::python {

namespace {

py::object finite_or_none(double value) {
  if (std::isfinite(value)) return py::float_(value);
  return py::none();
}

std::vector<std::string> product_names() {
  std::vector<std::string> names;
  for (const Product& product : products()) names.push_back(product.name);
  return names;
}

py::dict defaults() {
  using namespace py::literals;
  const Observer observer;
  const ViewshedOptions options;
  const ErrorModel model;
  const VolumeSightOptions sight;
  const ProbableOptions probable;
  const WholeLineOptions whole_line;
  const RadioOptions radio;
  return py::dict(
      "observer_height"_a = observer.height, "target_height"_a = observer.target_height,
      "min_distance"_a = observer.min_distance, "max_distance"_a = finite_or_none(observer.max_distance),
      "azimuth"_a = py::make_tuple(observer.azimuth_from, observer.azimuth_to),
      "vertical_angle"_a = py::make_tuple(observer.angle_from, observer.angle_to),
      "confidence"_a = options.confidence, "refraction"_a = options.refraction,
      "curvature"_a = options.curvature, "stand"_a = name_of(options.stand),
      "combine"_a = name_of(options.combine), "height_reference"_a = name_of(options.height_reference),
      "see_across_nodata"_a = options.see_across_nodata, "heights"_a = options.heights,
      "horizontal_rmse"_a = model.horizontal_rmse, "geologic_model"_a = name_of(model.geologic_shape),
      "correlation_length"_a = model.correlation_length, "shared_bias"_a = model.shared_bias,
      "vertical_unit"_a = "auto", "band"_a = 1, "terrain_table"_a = default_terrain_table(),
      "error_products"_a = product_names(), "target_spacing"_a = sight.targets.spacing_m,
      "target_ceiling"_a = sight.targets.ceiling_m, "seen_from"_a = name_of(sight.seen_from),
      "holds_for"_a = name_of(sight.holds_for), "most_lines"_a = sight.most_lines,
      "realisations"_a = probable.realisations, "precision"_a = probable.precision,
      "method"_a = name_of(probable.method), "refinement"_a = probable.refinement, "seed"_a = probable.seed,
      "probability_stand"_a = name_of(whole_line.stand), "fresnel_share"_a = radio.zone_share);
}

}  // namespace

void bind_defaults(py::module_& m) { m.def("defaults", &defaults); }

}  // namespace sightbound::python
