// SPDX-License-Identifier: GPL-3.0-or-later
// libFuzzer target for one of the simplifiers: -DSIGHTBOUND_FUZZ_TRY=try_dem. See README.md.
#include <cstddef>
#include <cstdint>

#include "simplify_entry.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  sightbound::fuzz::SIGHTBOUND_FUZZ_TRY({data, size});
  return 0;
}
