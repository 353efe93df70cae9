// SPDX-License-Identifier: GPL-3.0-or-later
// libFuzzer target for one format: -DSIGHTBOUND_FUZZ_FORMAT=kPly. See README.md.
#include <cstddef>
#include <cstdint>

#include "tin_entry.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  sightbound::fuzz::try_tin(sightbound::fuzz::Format::SIGHTBOUND_FUZZ_FORMAT,
                            {reinterpret_cast<const char*>(data), size});
  return 0;
}
