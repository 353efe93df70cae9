// SPDX-License-Identifier: GPL-3.0-or-later
// Memory for rasters: large blocks ask the system for huge pages, since sight runs across rows and would
// otherwise spend a third of its time looking up pages.
#pragma once

#include <cstddef>

namespace sightbound {

// Not initialised. Throws std::bad_alloc. Give back with release_big.
void* allocate_big(std::size_t bytes);
// All bytes 0: pages that are never written cost neither time nor memory.
void* allocate_big_zeroed(std::size_t bytes);
void release_big(void* memory) noexcept;

}  // namespace sightbound
