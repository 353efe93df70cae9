// SPDX-License-Identifier: GPL-3.0-or-later
// One function per concept; each adds its classes and functions to a module: sightbound._core, or, where
// OpenVDB is needed, sightbound._volume. No logic here: what a job means is in cpp/, coercion of arguments
// and docstrings are in the Python files of sightbound/.
#pragma once

#include <pybind11/pybind11.h>

namespace sightbound::python {

namespace py = pybind11;

// Adds the exception Cancelled.
py::handle make_cancelled(py::module_& m);
// From now on what this module's functions throw is translated. Each module needs it.
void bind_errors(py::handle cancelled);
void bind_dem(py::module_& m);
void bind_error_model(py::module_& m);
void bind_error_check(py::module_& m);
void bind_viewshed(py::module_& m);
void bind_line_of_sight(py::module_& m);
void bind_intervisibility(py::module_& m);
void bind_probable(py::module_& m);
void bind_error_surfaces(py::module_& m);
void bind_tin(py::module_& m);
void bind_simplify(py::module_& m);
void bind_volume(py::module_& m);
void bind_hidden_volume(py::module_& m);
void bind_volume_targets(py::module_& m);
void bind_simplify_tin(py::module_& m);
void bind_verify(py::module_& m);
void bind_defaults(py::module_& m);

}  // namespace sightbound::python
