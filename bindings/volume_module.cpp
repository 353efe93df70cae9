// SPDX-License-Identifier: GPL-3.0-or-later
// A module of its own, loaded when first asked for: OpenVDB's libraries take as long to load as all others
// together. Classes of _core (DEMs, TINs, error models) are known here, too.
#include "bindings.h"

PYBIND11_MODULE(_volume, m) {
  using namespace sightbound;
  m.doc() =
      "The compiled part of sightbound that knows OpenVDB. Not for use by hand: its names may change; those "
      "of "
      "sightbound stay.";
  const auto core = python::py::module_::import("sightbound._core");
  python::bind_errors(core.attr("Cancelled"));
  python::bind_volume(m);
  python::bind_hidden_volume(m);
  python::bind_volume_targets(m);
  python::bind_simplify_tin(m);
}
