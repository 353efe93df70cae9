// SPDX-License-Identifier: GPL-3.0-or-later
// The five ways in which Sightbound says no. Messages name the field, the value, the allowed range and the remedy.
#pragma once

#include <stdexcept>
#include <string>

namespace sightbound {

class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The caller's mistake. Python: ValueError.
class InvalidInput : public Error {
 public:
  using Error::Error;
};

// A file cannot be read or written. Python: OSError.
class IoError : public Error {
 public:
  using Error::Error;
};

// The job would exceed its memory budget; says which knob to turn. Python: MemoryError.
class OverBudget : public Error {
 public:
  using Error::Error;
};

// Asked to stop; nothing half-written stays behind. Python: sightbound.Cancelled.
class Cancelled : public Error {
 public:
  Cancelled() : Error("Cancelled.") {}
};

// Our bug: a self-check failed. Python: RuntimeError.
class BrokenGuarantee : public Error {
 public:
  explicit BrokenGuarantee(const std::string& what) : Error("Internal check failed, please report: " + what) {}
};

}  // namespace sightbound
