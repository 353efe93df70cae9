// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bindings.h"
#include "numpy_views.h"
#include "progress_bridge.h"
#include <pybind11/stl.h>

#include "jobs/volume_files.h"
#include "jobs/volume_terrain.h"
#include "terrain/regular_tin.h"
#include "volume/cover_rasters.h"

namespace sightbound::python {

namespace {

using Terrain = std::shared_ptr<VolumeTerrain>;
using Held = std::shared_ptr<ErrorVolume>;

Terrain terrain_of_dem(const std::shared_ptr<DemSource>& dem, const ErrorModel& model,
                       const std::optional<Extent>& extent, int threads, std::size_t memory_budget,
                       const py::object& progress) {
  return ProgressBridge(progress).run([&, given = model](Progress& p) {
    const VolumeTerrainOptions options{extent, threads, memory_budget};
    return std::make_shared<VolumeTerrain>(volume_terrain(*dem, given, options, p));
  });
}

Terrain terrain_of_tin(const std::shared_ptr<RegularTin>& tin, const ErrorModel& model,
                       const py::object& progress) {
  return ProgressBridge(progress).run([&, given = model](Progress&) {
    return std::make_shared<VolumeTerrain>(volume_terrain(tin->tin, given));
  });
}

py::dict need(const Terrain& terrain, const VolumeOptions& options) {
  using namespace py::literals;
  const VolumeNeed found = [&] {
    const py::gil_scoped_release released;
    return need_of(*terrain, options);
  }();
  return py::dict("voxel"_a = found.voxel_m, "voxel_height"_a = found.voxel_height_m,
                  "voxels"_a = found.voxels, "bytes"_a = found.bytes);
}

Held build(const Terrain& terrain, const VolumeOptions& options, const py::object& progress) {
  return ProgressBridge(progress).run([&, used = options](Progress& p) {
    return std::make_shared<ErrorVolume>(build_volume(*terrain, used, p));
  });
}

Held open(const std::string& path, const py::object& progress) {
  return ProgressBridge(progress).run(
      [&](Progress& p) { return std::make_shared<ErrorVolume>(ErrorVolume::open(path, p)); });
}

void save(const Held& volume, const std::string& path, const py::object& progress) {
  ProgressBridge(progress).run([&](Progress& p) { volume->save(path, p); });
}

py::tuple rasters(const ErrorVolume& volume, double confidence) {
  CoverRasters found = [&] {
    const py::gil_scoped_release released;
    return rasters_of(volume, confidence);
  }();
  return py::make_tuple(array_from(std::move(found.lower)), array_from(std::move(found.upper)),
                        array_from(std::move(found.thickness)),
                        py::tuple(py::cast(found.geotransform.coefficients())));
}

void write(const Held& volume, const VolumeFiles& files, double confidence, int threads,
           const py::object& progress) {
  ProgressBridge(progress).run(
      [&, wanted = files](Progress& p) { write_volume(*volume, wanted, confidence, threads, p); });
}

py::dict report(const ErrorVolume& volume) {
  using namespace py::literals;
  const VolumeReport& found = volume.report();
  return py::dict("faces"_a = found.faces, "faces_not_held"_a = found.faces_not_held,
                  "finest_needed"_a = found.finest_needed_m, "voxels"_a = found.voxels,
                  "leaves"_a = found.leaves, "bytes"_a = found.bytes,
                  "unknown_columns"_a = found.unknown_columns, "ambiguous_voxels"_a = found.ambiguous_voxels,
                  "warnings"_a = found.warnings);
}

py::tuple bounds(const ErrorVolume& volume) {
  const Surface& surface = volume.surface();
  const Xyz low = surface.frame().to_crs(surface.bounds().low),
            high = surface.frame().to_crs(surface.bounds().high);
  return py::make_tuple(low.x, low.y, low.z, high.x, high.y, high.z);
}

}  // namespace

void bind_volume(py::module_& m) {
  py::class_<VolumeTerrain, Terrain>(m, "VolumeTerrain")
      .def_readonly("error_model", &VolumeTerrain::error_model)
      .def_readonly("warnings", &VolumeTerrain::warnings)
      .def("need", &need, py::arg("options"));
  py::class_<VolumeOptions>(m, "VolumeOptions")
      .def(py::init<>())
      .def_readwrite("voxel_m", &VolumeOptions::voxel_m)
      .def_readwrite("voxel_height_m", &VolumeOptions::voxel_height_m)
      .def_readwrite("alpha", &VolumeOptions::alpha)
      .def_readwrite("confidence", &VolumeOptions::confidence)
      .def_readwrite("largest_confidence", &VolumeOptions::largest_confidence)
      .def_readwrite("memory_bytes", &VolumeOptions::memory_bytes)
      .def_readwrite("threads", &VolumeOptions::threads);
  py::class_<VolumeFiles>(m, "VolumeFiles")
      .def(py::init<>())
      .def_readwrite("lower", &VolumeFiles::lower)
      .def_readwrite("upper", &VolumeFiles::upper)
      .def_readwrite("thickness", &VolumeFiles::thickness)
      .def_readwrite("creation_options", &VolumeFiles::creation_options);
  py::class_<ErrorVolume, Held>(m, "ErrorVolume")
      .def("save", &save, py::arg("path"), py::arg("progress"))
      .def("write", &write, py::arg("files"), py::arg("confidence"), py::arg("threads"), py::arg("progress"))
      .def("rasters", &rasters, py::arg("confidence"))
      .def("report", &report)
      .def_property_readonly("voxel_m", &ErrorVolume::voxel_m)
      .def_property_readonly("voxel_height_m", &ErrorVolume::voxel_height_m)
      .def_property_readonly("largest_confidence",
                             [](const ErrorVolume& v) { return v.largest_confidence(); })
      .def_property_readonly("error_model", [](const ErrorVolume& v) { return v.error_model(); })
      .def_property_readonly("crs_wkt", [](const ErrorVolume& v) { return v.surface().frame().crs_wkt; })
      .def_property_readonly("is_height_field",
                             [](const ErrorVolume& v) { return v.surface().metric() == Metric::kVertical; })
      .def_property_readonly("bounds", &bounds);
  m.def("volume_terrain_of_dem", &terrain_of_dem, py::arg("dem"), py::arg("model"), py::arg("extent"),
        py::arg("threads"), py::arg("memory_budget"), py::arg("progress"));
  m.def("volume_terrain_of_tin", &terrain_of_tin, py::arg("tin"), py::arg("model"), py::arg("progress"));
  m.def("build_volume", &build, py::arg("terrain"), py::arg("options"), py::arg("progress"));
  m.def("open_volume", &open, py::arg("path"), py::arg("progress"));
}

}  // namespace sightbound::python
