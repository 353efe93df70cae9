// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory_budget.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <limits>
#include <tuple>

#ifdef _WIN32
#include <windows.h>
#else
#include <unistd.h>
#endif

#include "base/error.h"

namespace sightbound {

namespace {

constexpr std::size_t kLeastAssumed = std::size_t{1} << 30;  // when the system does not tell

std::size_t physical_memory() {
#ifdef _WIN32
  MEMORYSTATUSEX status;
  status.dwLength = sizeof(status);
  return GlobalMemoryStatusEx(&status) ? static_cast<std::size_t>(status.ullTotalPhys) : kLeastAssumed;
#else
  const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
  return pages > 0 && page > 0 ? static_cast<std::size_t>(pages) * static_cast<std::size_t>(page)
                               : kLeastAssumed;
#endif
}

// Limit of the control group (containers); the largest value when there is none.
std::size_t container_limit() {
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (const char* path : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
    std::uint64_t bytes = 0;  // "max" does not parse and leaves no limit
    if (std::ifstream(path) >> bytes && bytes > 0) least = std::min<std::uint64_t>(least, bytes);
  }
  return least;
}

std::string amount(std::size_t bytes) {
  constexpr double kKibi = 1024, kMebi = 1024 * kKibi, kGibi = 1024 * kMebi;
  const auto size = static_cast<double>(bytes);
  const auto [unit, name, digits] = size < kKibi         ? std::tuple(1.0, "bytes", 0)
                                    : size < 0.1 * kMebi ? std::tuple(kKibi, "KiB", 1)
                                    : size < kGibi       ? std::tuple(kMebi, "MiB", 1)
                                                         : std::tuple(kGibi, "GiB", 2);
  char text[32];
  std::snprintf(text, sizeof(text), "%.*f %s", digits, size / unit, name);
  return text;
}

}  // namespace

std::size_t usable_memory() { return std::min(physical_memory(), container_limit()); }

MemoryBudget::MemoryBudget(std::size_t bytes) : bytes_(bytes > 0 ? bytes : usable_memory() / 4 * 3) {}

void MemoryBudget::require(std::size_t bytes, const std::string& what, const std::string& remedy) const {
  if (bytes <= bytes_) return;
  throw OverBudget(what + " needs " + amount(bytes) + " of memory, more than the budget of " +
                   amount(bytes_) + ". " + remedy);
}

}  // namespace sightbound
