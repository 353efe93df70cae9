// SPDX-License-Identifier: GPL-3.0-or-later
#include "progress_bridge.h"

namespace py = pybind11;

namespace sightbound::python {

ProgressBridge::ProgressBridge(py::object callback) : callback_(std::move(callback)) {
  if (!callback_.is_none() && PyCallable_Check(callback_.ptr()) == 0) {
    throw py::type_error("progress must be a function that takes the fraction done, or None; got " +
                         py::repr(callback_).cast<std::string>() + ".");
  }
}

bool ProgressBridge::tell(double fraction) {
  py::gil_scoped_acquire acquired;
  if (raised_) return false;
  try {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (callback_.is_none()) return true;
    const py::object answer = callback_(fraction);
    return answer.is_none() || py::bool_(answer);
  } catch (py::error_already_set& error) {
    raised_ = std::move(error);
    return false;
  }
}

}  // namespace sightbound::python
