// SPDX-License-Identifier: GPL-3.0-or-later
// Every C++ exception has its Python one; none leaks. What is not listed here is a std::exception, which
// pybind11 turns into RuntimeError.
#include <exception>
#include <filesystem>
#include <new>
#include <utility>

#include "bindings.h"

#include "base/error.h"

namespace sightbound::python {

namespace {

constexpr const char* kOutOfMemory =
    "Not enough memory. Reduce max_distance or give a smaller extent; memory_budget makes a job say so "
    "before it starts.";

// Lives as long as the process, like the exceptions of the interpreter itself.
PyObject* cancelled_type = nullptr;

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(std::move(thrown));
  } catch (const InvalidInput& e) {
    PyErr_SetString(PyExc_ValueError, e.what());
  } catch (const IoError& e) {
    PyErr_SetString(PyExc_OSError, e.what());
  } catch (const OverBudget& e) {
    PyErr_SetString(PyExc_MemoryError, e.what());
  } catch (const Cancelled& e) {
    PyErr_SetString(cancelled_type, e.what());
  } catch (const BrokenGuarantee& e) {
    PyErr_SetString(PyExc_RuntimeError, e.what());
  } catch (const std::bad_alloc&) {
    PyErr_SetString(PyExc_MemoryError, kOutOfMemory);
  } catch (const std::filesystem::filesystem_error& e) {
    PyErr_SetString(PyExc_OSError, e.what());
  }
}

}  // namespace

py::handle make_cancelled(py::module_& m) {
  const py::handle cancelled = PyErr_NewExceptionWithDoc(
      "sightbound.Cancelled", "The job was asked to stop; nothing half-written stays behind.", nullptr,
      nullptr);
  if (!cancelled) throw py::error_already_set();
  m.attr("Cancelled") = cancelled;
  return cancelled;
}

void bind_errors(py::handle cancelled) {
  cancelled_type = cancelled.inc_ref().ptr();
  py::register_local_exception_translator(translate);
}

}  // namespace sightbound::python
