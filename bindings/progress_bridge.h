// SPDX-License-Identifier: GPL-3.0-or-later
// A job of the core, run for Python: the interpreter is free meanwhile, and comes back for an instant, on the
// calling thread and at most ten times a second (base/progress.h), to hear the fraction done and to look for
// Ctrl-C.
//
//   the callback returns False                    -> the job is cancelled -> sightbound.Cancelled
//   the callback raises, or Ctrl-C was pressed    -> the job is cancelled -> that very exception
#pragma once

#include <functional>
#include <optional>
#include <utility>

#include <pybind11/pybind11.h>

#include "base/progress.h"

namespace sightbound::python {

class ProgressBridge {
 public:
  // None, or a callable that takes the fraction done. Throws TypeError for anything else.
  explicit ProgressBridge(pybind11::object callback);

  // Calls job(progress) without the GIL and returns its result. `job` must not touch Python objects.
  template <class Job>
  auto run(Job&& job) {
    Progress progress([this](double fraction) { return tell(fraction); });
    try {
      pybind11::gil_scoped_release released;
      return std::forward<Job>(job)(progress);
    } catch (...) {
      // Whatever the job made of being stopped, the cause is what Python shall hear of.
      if (raised_) throw *raised_;
      throw;
    }
  }

 private:
  // False stops the job. Python's exceptions are kept here: the core never sees one.
  bool tell(double fraction);

  pybind11::object callback_;
  std::optional<pybind11::error_already_set> raised_;
};

}  // namespace sightbound::python
