// SPDX-License-Identifier: GPL-3.0-or-later
// How much memory a job may use, asked before it is taken.
#pragma once

#include <cstddef>
#include <string>

namespace sightbound {

class MemoryBudget {
 public:
  // 0 = three quarters of the memory that this process may use (the machine's, or its container's when that
  // is less).
  explicit MemoryBudget(std::size_t bytes = 0);

  std::size_t bytes() const { return bytes_; }

  // Throws OverBudget when a job's planned peak exceeds the budget: "<what> needs 12.3 GiB, ... <remedy>".
  void require(std::size_t bytes, const std::string& what, const std::string& remedy) const;

 private:
  std::size_t bytes_;
};

// Bytes of memory that this process may use at most.
std::size_t usable_memory();

}  // namespace sightbound
