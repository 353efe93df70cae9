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

#include "io/check_points_reader.h"
#include "jobs/error_check_job.h"
#include "jobs/error_maps_job.h"

namespace sightbound::python {

namespace {

using namespace pybind11::literals;

py::dict as_dict(const ResidualStatistics& s) {
  return py::dict("count"_a = s.count, "mean"_a = s.mean, "median"_a = s.median, "rmse"_a = s.rmse,
                  "sd"_a = s.sd, "nmad"_a = s.nmad, "le90"_a = s.le90, "le95"_a = s.le95,
                  "le90_unbiased"_a = s.le90_unbiased, "le95_unbiased"_a = s.le95_unbiased,
                  "skewness"_a = s.skewness, "excess_kurtosis"_a = s.excess_kurtosis,
                  "outliers"_a = s.outliers);
}

py::dict as_dict(const Dependence& d) {
  py::list values, sigmas, places;
  for (const auto& bin : d.bins)
    values.append(bin.value), sigmas.append(bin.sigma), places.append(bin.places);
  return py::dict("value"_a = values, "sigma"_a = sigmas, "places"_a = places, "explained"_a = d.explained);
}

py::dict as_dict(const Variogram& v, const ErrorCheck& check) {
  py::list distances, semivariances, pairs, fitted;
  for (const LagBin& bin : v.bins) {
    distances.append(bin.distance), semivariances.append(bin.semivariance), pairs.append(bin.pairs);
    fitted.append(v.at(bin.distance));
  }
  return py::dict("distance"_a = distances, "semivariance"_a = semivariances, "pairs"_a = pairs,
                  "fitted"_a = fitted, "nugget"_a = v.nugget, "sill"_a = v.sill, "length"_a = v.length,
                  "correlation_length"_a = v.correlation_length(check.between * check.between));
}

py::object as_dict(const ErrorCheck& check, const DemSource& dem) {
  if (!check.shift) return py::none();
  const MapShift shift = on_map(*check.shift, dem);
  return py::dict("dx"_a = shift.east, "dy"_a = shift.north, "dz"_a = shift.up, "se_dx"_a = shift.se_east,
                  "se_dy"_a = shift.se_north, "se_dz"_a = shift.se_up,
                  "significant"_a = check.shift->is_significant(), "corrected"_a = check.corrected,
                  "nmad_before"_a = check.shift->nmad_before, "nmad_after"_a = check.shift->nmad_after);
}

py::dict correction_of(const ErrorCheck& check, const DemSource& dem) {
  const MapShift correction = on_map(check.correction, dem);
  return py::dict("dx"_a = correction.east, "dy"_a = correction.north, "dz"_a = correction.up,
                  "taken_off"_a = check.corrected);
}

py::dict details(const ErrorCheck& check, const DemSource& dem) {
  py::dict out = as_dict(check.statistics);
  out["tails"] = name_of(check.tails);
  out["confidences"] = std::vector<double>(std::begin(kShownConfidences), std::end(kShownConfidences));
  out["quantiles"] = check.quantiles;
  out["sigma_at_flat"] = check.at_flat;
  out["sigma_per_slope"] = check.per_slope;
  out["between_samples"] = check.between;
  out["ridge_bias"] = check.ridge_bias;
  out["slope"] = as_dict(check.slope);
  out["curvature"] = as_dict(check.curvature);
  out["variogram"] = as_dict(check.variogram, check);
  out["shift"] = as_dict(check, dem);
  out["correction"] = correction_of(check, dem);
  out["left_out"] = check.left_out;
  out["equal_level"] = check.equal_level;
  out["warnings"] = check.warnings;
  return out;
}

std::vector<Xyz> places_of(const DoubleArray& array) {
  std::vector<Xyz> places;
  const auto values = array.unchecked<2>();
  for (py::ssize_t i = 0; i < values.shape(0); ++i)
    places.push_back({values(i, 0), values(i, 1), values(i, 2)});
  return places;
}

ErrorCheckOptions options_of(const std::string& content, bool correct_shift) {
  ErrorCheckOptions options;
  options.content = cell_content_from(content);
  options.correct_shift = correct_shift;
  return options;
}

void bind_check(py::module_& m) {
  py::class_<ErrorCheck>(m, "ErrorCheck").def("details", [](const ErrorCheck& self, const DemSource& dem) {
    return details(self, dem);
  });
  m.def(
      "read_check_points",
      [](const std::shared_ptr<DemSource>& dem, const std::string& path, const std::string& layer,
         const std::string& field, const std::string& unit, py::object progress) {
        const CheckPointFile file{path, layer, field, vertical_unit_from(unit)};
        CheckPoints read = ProgressBridge(std::move(progress)).run([&](Progress& p) {
          return read_check_points(file, *dem, p);
        });
        DoubleArray places({static_cast<py::ssize_t>(read.places.size()), py::ssize_t{3}});
        auto out = places.mutable_unchecked<2>();
        for (std::size_t i = 0; i < read.places.size(); ++i) {
          const auto row = static_cast<py::ssize_t>(i);
          out(row, 0) = read.places[i].x, out(row, 1) = read.places[i].y, out(row, 2) = read.places[i].z;
        }
        return py::make_tuple(places, read.notes);
      },
      "dem"_a, "path"_a, "layer"_a, "elevation_field"_a, "vertical_unit"_a, "progress"_a);
  // `before`: whose correction is taken off, whatever shift the points tell.
  m.def(
      "check_with_points",
      [](const std::shared_ptr<DemSource>& dem, const ErrorModel& completed, const DoubleArray& points,
         bool correct_shift, const ErrorCheck* before, py::object progress) {
        ErrorCheckOptions options = options_of("samples", correct_shift);
        if (before != nullptr) options.correction = before->correction;
        return ProgressBridge(std::move(progress))
            .run([&, model = completed, places = places_of(points)](Progress& p) {
              return check_with_points(*dem, model, places, options, p);
            });
      },
      "dem"_a, "completed"_a, py::arg("points").noconvert(), "correct_shift"_a, "before"_a, "progress"_a);
  m.def(
      "check_with_reference",
      [](const std::shared_ptr<DemSource>& dem, const std::shared_ptr<DemSource>& reference,
         const std::string& content, bool correct_shift, py::object progress) {
        return ProgressBridge(std::move(progress))
            .run([&, options = options_of(content, correct_shift)](Progress& p) {
              return check_with_reference(*dem, *reference, options, p);
            });
      },
      "dem"_a, "reference"_a, "samples_or_means"_a, "correct_shift"_a, "progress"_a);
  m.def(
      "content_seen",
      [](const std::shared_ptr<DemSource>& dem, const std::shared_ptr<DemSource>& reference,
         py::object progress) {
        const auto seen = ProgressBridge(std::move(progress)).run([&](Progress& p) {
          return content_seen(*dem, *reference, p);
        });
        return seen ? std::optional(name_of(*seen)) : std::nullopt;
      },
      "dem"_a, "reference"_a, "progress"_a);
  m.def("with_check", &with_check, "model"_a, "check"_a);
  m.def(
      "write_corrected_dem",
      [](const std::string& path, const std::shared_ptr<DemSource>& dem, double dx, double dy, double dz,
         const std::vector<std::string>& creation_options, py::object progress) {
        const MapShift shift{dx, dy, dz};
        ProgressBridge(std::move(progress)).run([&](Progress& p) {
          write_corrected_dem(path, *dem, shift, creation_options, 0, p);
        });
      },
      "path"_a, "dem"_a, "dx"_a, "dy"_a, "dz"_a, "creation_options"_a, "progress"_a);
}

void bind_maps(py::module_& m) {
  py::class_<ErrorMaps>(m, "ErrorMaps")
      .def_property_readonly(
          "between",
          [](const py::object& self) { return view_of(self.cast<const ErrorMaps&>().between, self); })
      .def_property_readonly("sampling", [](const py::object& self) {
        return view_of(self.cast<const ErrorMaps&>().sampling, self);
      });
  m.def(
      "error_maps",
      [](const std::shared_ptr<DemSource>& dem, const ErrorModel& model, int threads, py::object progress) {
        return ProgressBridge(std::move(progress)).run([&, given = model](Progress& p) {
          return run_error_maps(*dem, given, threads, p);
        });
      },
      "dem"_a, "model"_a, "threads"_a, "progress"_a);
  m.def(
      "write_error_maps",
      [](const ErrorMaps& maps, const std::string& between, const std::string& sampling,
         const std::vector<std::string>& creation_options, int threads, py::object progress) {
        ProgressBridge(std::move(progress)).run([&](Progress& p) {
          write_error_maps(maps, between, sampling, creation_options, threads, p);
        });
      },
      "maps"_a, "between"_a, "sampling"_a, "creation_options"_a, "threads"_a, "progress"_a);
}

}  // namespace

void bind_error_check(py::module_& m) {
  bind_check(m);
  bind_maps(m);
}

}  // namespace sightbound::python
