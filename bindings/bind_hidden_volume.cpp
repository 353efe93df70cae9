// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
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
#include "jobs/volume_viewshed_job.h"
#include "terrain/regular_tin.h"

namespace sightbound::python {

namespace {

using Held = std::shared_ptr<HiddenVolume>;
using Volume = std::shared_ptr<ErrorVolume>;
using Views = std::vector<ViewVolume>;

Held hold(HiddenVolume volume) { return std::make_shared<HiddenVolume>(std::move(volume)); }

void bind_options(py::module_& m) {
  py::class_<ViewVolume>(m, "ViewVolume")
      .def(py::init([](const std::vector<std::vector<std::pair<double, double>>>& rings, double from,
                       double to, std::string name) {
             ViewVolume view{{}, from, to, std::move(name)};
             for (const auto& ring : rings) {
               view.rings.emplace_back();
               for (const auto& [x, y] : ring) view.rings.back().push_back({x, y});
             }
             return view;
           }),
           py::arg("rings"), py::arg("height_from"), py::arg("height_to"), py::arg("name"));
  py::class_<VolumeSightOptions>(m, "VolumeSightOptions")
      .def(py::init<>())
      .def_readwrite("confidence", &VolumeSightOptions::confidence)
      .def_readwrite("refraction", &VolumeSightOptions::refraction)
      .def_readwrite("curvature", &VolumeSightOptions::curvature)
      .def_property(
          "seen_from", [](const VolumeSightOptions& self) { return name_of(self.seen_from); },
          [](VolumeSightOptions& self, const std::string& name) { self.seen_from = seen_from(name); })
      .def_property(
          "holds_for", [](const VolumeSightOptions& self) { return name_of(self.holds_for); },
          [](VolumeSightOptions& self, const std::string& name) { self.holds_for = holds_for(name); })
      .def_property(
          "height_reference", [](const VolumeSightOptions& self) { return name_of(self.height_reference); },
          [](VolumeSightOptions& self, const std::string& name) {
            self.height_reference = height_reference_from(name);
          })
      .def_readwrite("max_distance", &VolumeSightOptions::max_distance)
      .def_readwrite("view_spacing", &VolumeSightOptions::view_spacing)
      .def_property(
          "target_spacing", [](const VolumeSightOptions& self) { return self.targets.spacing_m; },
          [](VolumeSightOptions& self, double metres) { self.targets.spacing_m = metres; })
      .def_property(
          "target_height_spacing",
          [](const VolumeSightOptions& self) { return self.targets.height_spacing_m; },
          [](VolumeSightOptions& self, double metres) { self.targets.height_spacing_m = metres; })
      .def_property(
          "target_ceiling", [](const VolumeSightOptions& self) { return self.targets.ceiling_m; },
          [](VolumeSightOptions& self, double metres) { self.targets.ceiling_m = metres; })
      .def_readwrite("most_lines", &VolumeSightOptions::most_lines)
      .def_readwrite("threads", &VolumeSightOptions::threads)
      .def_readwrite("memory_budget", &VolumeSightOptions::memory_budget);
}

py::dict to_dict(const SightEstimate& found) {
  using namespace py::literals;
  return py::dict("view_places"_a = found.view_places, "targets"_a = found.targets, "lines"_a = found.lines,
                  "bytes"_a = found.bytes, "seconds"_a = found.seconds);
}

py::dict to_dict(const HiddenArea& found) {
  using namespace py::literals;
  return py::dict("asked_m2"_a = found.asked_m2, "hidden_m2"_a = found.hidden_m2,
                  "core_m2"_a = found.core_m2);
}

py::dict to_dict(const HiddenPlace& place) {
  using namespace py::literals;
  return py::dict("area_m2"_a = place.area_m2, "volume_m3"_a = place.volume_m3,
                  "centroid"_a = py::make_tuple(place.centroid_x, place.centroid_y),
                  "deepest"_a = py::make_tuple(place.deepest_x, place.deepest_y), "depth"_a = place.depth_m);
}

py::dict lattice_of(const HiddenVolume& volume) {
  using namespace py::literals;
  const TargetLattice& lattice = volume.lattice();
  return py::dict("spacing"_a = lattice.spacing_m, "height_spacing"_a = lattice.height_spacing_m,
                  "ceiling"_a = lattice.ceiling_m, "columns"_a = lattice.nx, "rows"_a = lattice.ny,
                  "targets"_a = lattice.targets());
}

py::dict volumes_of(const HiddenVolume& volume) {
  using namespace py::literals;
  const VerdictVolumes found = volume.volumes();
  return py::dict("hidden_m3"_a = found.hidden_m3, "uncertain_m3"_a = found.uncertain_m3,
                  "visible_m3"_a = found.visible_m3);
}

py::list places_of(const HiddenVolume& volume, double height, bool sure, std::size_t most) {
  const std::vector<HiddenPlace> found = [&] {
    const py::gil_scoped_release released;
    return hidden_places(volume, height, sure ? Hiding::kSurelyHidden : Hiding::kNotVisible, most);
  }();
  py::list places;
  for (const HiddenPlace& place : found) places.append(to_dict(place));
  return places;
}

// (verdict, p) of the target whose box holds the place, in CRS coordinates; None where nothing was asked.
py::object answer_at(const HiddenVolume& volume, double x, double y, double z) {
  const TargetLattice& lattice = volume.lattice();
  const Xyz local = lattice.frame.from_crs({x, y, z}) - lattice.corner;
  const double i = std::floor(local.x / lattice.spacing_m), j = std::floor(local.y / lattice.spacing_m),
               k = std::floor(local.z / lattice.height_spacing_m);
  if (!(i >= 0 && i < lattice.nx && j >= 0 && j < lattice.ny && std::abs(k) < 1e9)) return py::none();
  const TargetAnswer found = volume.at(static_cast<int>(i), static_cast<int>(j), static_cast<int>(k));
  if (found.verdict == kNoVerdict) return py::none();
  return py::make_tuple(static_cast<int>(found.verdict), found.p);
}

py::tuple rasters(const HiddenVolume& volume) {
  HiddenRasters found = [&] {
    const py::gil_scoped_release released;
    return rasters_of(volume);
  }();
  return py::make_tuple(array_from(std::move(found.lowest_visible_height)),
                        array_from(std::move(found.thickness)), array_from(std::move(found.core_thickness)));
}

std::shared_ptr<RegularTin> top(const HiddenVolume& volume) {
  const py::gil_scoped_release released;
  return std::make_shared<RegularTin>(RegularTin{top_of(volume), {}});
}

template <HiddenVolume (*Operation)(const HiddenVolume&, const HiddenVolume&)>
Held combine(const Held& a, const Held& b) {
  const py::gil_scoped_release released;
  return hold(Operation(*a, *b));
}

void save(const Held& volume, const std::string& path, const py::object& progress) {
  ProgressBridge(progress).run([&](Progress& p) { volume->save(path, p); });
}

Held open(const std::string& path, const py::object& progress) {
  return ProgressBridge(progress).run([&](Progress& p) { return hold(HiddenVolume::open(path, p)); });
}

std::vector<std::string> write(const Held& volume, const HiddenFiles& files, int threads,
                               const py::object& progress) {
  return ProgressBridge(progress).run(
      [&, wanted = files](Progress& p) { return write_hidden(*volume, wanted, threads, p); });
}

py::dict estimate(const Volume& volume, const Views& views, const VolumeSightOptions& options,
                  const py::object& progress) {
  return to_dict(ProgressBridge(progress).run(
      [&, used = options](Progress& p) { return estimate_sight(*volume, views, used, p); }));
}

py::tuple see(const Volume& volume, const Views& views, const VolumeSightOptions& options,
              const py::object& progress) {
  HiddenResult found = ProgressBridge(progress).run(
      [&, used = options](Progress& p) { return run_volume_viewshed(*volume, views, used, p); });
  return py::make_tuple(hold(std::move(found.hidden)), to_dict(found.estimate), found.warnings);
}

py::tuple subtract(const Held& hidden, const Volume& volume, const Views& views,
                   const VolumeSightOptions& options, double height, const py::object& progress) {
  using namespace py::literals;
  Subtraction found = ProgressBridge(progress).run([&, used = options](Progress& p) {
    return subtract_observer(*hidden, *volume, views, used, height, p);
  });
  py::dict gain("gained_m2"_a = found.before.hidden_m2 - found.after.hidden_m2,
                "gained_core_m2"_a = found.before.core_m2 - found.after.core_m2,
                "gained_m3"_a = found.gained_m3, "gained_core_m3"_a = found.gained_core_m3,
                "before"_a = to_dict(found.before), "after"_a = to_dict(found.after));
  return py::make_tuple(hold(std::move(found.rest)), gain, to_dict(found.estimate), found.warnings);
}

}  // namespace

void bind_hidden_volume(py::module_& m) {
  bind_options(m);
  py::class_<HiddenFiles>(m, "HiddenFiles")
      .def(py::init<>())
      .def_readwrite("height", &HiddenFiles::lowest_visible_height)
      .def_readwrite("thickness", &HiddenFiles::thickness)
      .def_readwrite("core_thickness", &HiddenFiles::core_thickness)
      .def_readwrite("top", &HiddenFiles::top)
      .def_readwrite("fog", &HiddenFiles::fog)
      .def_readwrite("creation_options", &HiddenFiles::creation_options);
  py::class_<HiddenVolume, Held>(m, "HiddenVolume")
      .def("save", &save, py::arg("path"), py::arg("progress"))
      .def("write", &write, py::arg("files"), py::arg("threads"), py::arg("progress"))
      .def("lattice", &lattice_of)
      .def("volumes", &volumes_of)
      .def(
          "area", [](const HiddenVolume& self, double height) { return to_dict(hidden_area(self, height)); },
          py::arg("height"))
      .def("places", &places_of, py::arg("height"), py::arg("sure"), py::arg("most"))
      .def("at", &answer_at, py::arg("x"), py::arg("y"), py::arg("z"))
      .def("rasters", &rasters)
      .def("top", &top)
      .def("union_of_seen", &combine<union_of_seen>, py::arg("other"))
      .def("intersection_of_seen", &combine<intersection_of_seen>, py::arg("other"))
      .def("difference_of_seen", &combine<difference_of_seen>, py::arg("other"))
      .def(
          "same_as", [](const HiddenVolume& a, const HiddenVolume& b) { return a == b; }, py::arg("other"))
      .def_property_readonly("geotransform",
                             [](const HiddenVolume& self) {
                               return py::tuple(py::cast(geotransform_of(self.lattice()).coefficients()));
                             })
      .def_property_readonly("crs_wkt", [](const HiddenVolume& self) { return self.lattice().frame.crs_wkt; })
      .def_property_readonly("confidence", [](const HiddenVolume& self) { return self.info().confidence; })
      .def_property_readonly("observers", [](const HiddenVolume& self) { return self.info().observers; })
      .def_property_readonly("error_model", [](const HiddenVolume& self) { return self.info().error_model; })
      .def_property_readonly("operations", [](const HiddenVolume& self) { return self.info().operations; })
      .def_property_readonly("bytes", &HiddenVolume::bytes);
  m.def("open_hidden_volume", &open, py::arg("path"), py::arg("progress"));
  m.def("estimate_sight", &estimate, py::arg("volume"), py::arg("views"), py::arg("options"),
        py::arg("progress"));
  m.def("volume_viewshed", &see, py::arg("volume"), py::arg("views"), py::arg("options"),
        py::arg("progress"));
  m.def("subtract_observer", &subtract, py::arg("hidden"), py::arg("volume"), py::arg("views"),
        py::arg("options"), py::arg("height"), py::arg("progress"));
}

}  // namespace sightbound::python
