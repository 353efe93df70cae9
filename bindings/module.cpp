// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "bindings.h"
#include <pybind11/stl.h>

#include "base/version.h"
#include "io/gdal_version.h"

PYBIND11_MODULE(_core, m) {
  using namespace sightbound;
  m.doc() =
      "The compiled part of sightbound. Not for use by hand: its names may change; those of sightbound stay.";
  m.attr("__version__") = version();
  m.def("gdal_versions", [] {
    const GdalVersions versions = gdal_versions();
    return std::pair(versions.compiled, versions.loaded);
  });
  python::bind_errors(python::make_cancelled(m));
  python::bind_dem(m);
  python::bind_error_model(m);
  python::bind_error_check(m);
  python::bind_viewshed(m);
  python::bind_line_of_sight(m);
  python::bind_intervisibility(m);
  python::bind_probable(m);
  python::bind_error_surfaces(m);
  python::bind_tin(m);
  python::bind_simplify(m);
  python::bind_verify(m);
  python::bind_defaults(m);
}
