// SPDX-License-Identifier: GPL-3.0-or-later
// Rasters across the boundary without copies.
//
// In:  a C-contiguous float32 array is borrowed; whoever holds the shared pointer keeps it alive.
// Out: an array that shares the memory of a Grid or vector, and keeps its owner alive. Arrays that show a
// result are
//      read-only: what write() saves is what was computed.
// pybind11 imports numpy at the first call of one of these, not when the module is loaded.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>

#include "terrain/grid.h"

namespace sightbound::python {

using FloatArray = pybind11::array_t<float, pybind11::array::c_style>;
using DoubleArray = pybind11::array_t<double, pybind11::array::c_style>;

// Keeps a Python object alive for the core; may be dropped by any thread, with or without the GIL.
inline std::shared_ptr<const void> keep_alive(pybind11::object object) {
  return {new pybind11::object(std::move(object)), [](const pybind11::object* held) {
            pybind11::gil_scoped_acquire acquired;
            delete held;
          }};
}

inline pybind11::array read_only(pybind11::array array) {
  array.attr("setflags")(pybind11::arg("write") = false);
  return array;
}

// `owner` is the Python object that holds the grid.
template <class T>
pybind11::array view_of(const Grid<T>& grid, pybind11::handle owner) {
  return read_only(pybind11::array_t<T>({grid.rows(), grid.cols()}, grid.data(), owner));
}

template <class T>
pybind11::array view_of(const std::vector<T>& values, pybind11::handle owner) {
  return read_only(pybind11::array_t<T>(static_cast<pybind11::ssize_t>(values.size()), values.data(), owner));
}

// An array of the caller's own.
template <class T>
pybind11::array array_from(Grid<T> grid) {
  auto held = std::make_unique<Grid<T>>(std::move(grid));
  const Grid<T>& cells = *held;
  const pybind11::capsule owner(held.release(), [](void* p) { delete static_cast<Grid<T>*>(p); });
  return pybind11::array_t<T>({cells.rows(), cells.cols()}, cells.data(), owner);
}

}  // namespace sightbound::python
