// SPDX-License-Identifier: GPL-3.0-or-later
// A short, deterministic run of the fuzz entries: bytes with fixed seeds.
#include <cstdint>
#include <functional>
#include <random>
#include <span>
#include <vector>

#include "../../fuzz/simplify_entry.h"
#include <gtest/gtest.h>

namespace sightbound {
namespace {

// How many of them made a surface.
int run(int cases, const std::function<bool(std::span<const std::uint8_t>)>& f) {
  int made = 0;
  for (int seed = 0; seed < cases; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(static_cast<unsigned>(seed));
    std::vector<std::uint8_t> bytes(200);
    for (std::uint8_t& one : bytes) one = static_cast<std::uint8_t>(random());
    EXPECT_NO_THROW(made += f(bytes) ? 1 : 0);
  }
  return made;
}

TEST(SimplifyFuzz, AnyRaster) { EXPECT_GT(run(1500, fuzz::try_dem), 1000); }

TEST(SimplifyFuzz, AnySoup) { EXPECT_GT(run(300, fuzz::try_soup), 250); }

}  // namespace
}  // namespace sightbound
