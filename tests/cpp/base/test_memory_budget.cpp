// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "base/error.h"
#include "base/memory_budget.h"

namespace sightbound {
namespace {

constexpr std::size_t kMebi = std::size_t{1} << 20;

TEST(MemoryBudget, DefaultIsThreeQuartersOfWhatThereIs) {
  EXPECT_GT(usable_memory(), 64 * kMebi);
  EXPECT_EQ(MemoryBudget().bytes(), usable_memory() / 4 * 3);
}

TEST(MemoryBudget, AllowsUpToTheBudget) {
  const MemoryBudget budget(10 * kMebi);
  EXPECT_NO_THROW(budget.require(10 * kMebi, "The job", ""));
  EXPECT_THROW(budget.require(10 * kMebi + 1, "The job", ""), OverBudget);
}

TEST(MemoryBudget, SmallAmountsAreNotNought) {
  try {
    MemoryBudget(20).require(51200, "The job", "");
    FAIL();
  } catch (const OverBudget& error) {
    EXPECT_STREQ(error.what(), "The job needs 50.0 KiB of memory, more than the budget of 20 bytes. ");
  }
}

TEST(MemoryBudget, SaysWhatIsNeededAndWhatToDo) {
  try {
    MemoryBudget(10 * kMebi).require(3072 * kMebi, "The viewshed", "Give a shorter max_distance.");
    FAIL();
  } catch (const OverBudget& error) {
    EXPECT_STREQ(error.what(),
                 "The viewshed needs 3.00 GiB of memory, more than the budget of 10.0 MiB. Give a shorter "
                 "max_distance.");
  }
}

}  // namespace
}  // namespace sightbound
