// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/big_memory.h"

#include <cstdlib>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace sightbound {

namespace {
constexpr std::size_t kHugePage = std::size_t{2} << 20;
constexpr std::size_t kWorthwhile = 4 * kHugePage;
}  // namespace

void* allocate_big(std::size_t bytes) {
#ifdef __linux__
  if (bytes >= kWorthwhile) {
    const std::size_t whole = (bytes + kHugePage - 1) / kHugePage * kHugePage;
    void* memory = std::aligned_alloc(kHugePage, whole);
    if (memory == nullptr) throw std::bad_alloc();
    madvise(memory, whole, MADV_HUGEPAGE);  // a wish: without it everything works, slower
    return memory;
  }
#endif
  void* memory = std::malloc(bytes > 0 ? bytes : 1);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

void* allocate_big_zeroed(std::size_t bytes) {
  void* memory = std::calloc(bytes > 0 ? bytes : 1, 1);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

void release_big(void* memory) noexcept { std::free(memory); }

}  // namespace sightbound
