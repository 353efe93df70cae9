// SPDX-License-Identifier: GPL-3.0-or-later
#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/parallel.h"

namespace sightbound {
namespace {

TEST(Workers, CallEveryIndexOnce) {
  for (const int threads : {0, 1, 2, 7}) {
    const Workers workers(threads);
    for (const std::size_t n : {0U, 1U, 2U, 1000U}) {
      std::vector<std::atomic<int>> calls(n);
      workers.for_each(n, [&](std::size_t i) { ++calls[i]; });
      for (std::size_t i = 0; i < n; ++i) EXPECT_EQ(calls[i], 1);
    }
  }
}

TEST(Workers, OneThreadIsTheCallersAndInOrder) {
  const Workers workers(1);
  EXPECT_EQ(workers.count(), 1);
  const std::thread::id caller = std::this_thread::get_id();
  std::vector<std::size_t> order;
  workers.for_each(5, [&](std::size_t i) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    order.push_back(i);
  });
  EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
}

TEST(Workers, UseNoMoreThreadsThanAsked) {
  const Workers workers(2);
  EXPECT_LE(workers.count(), 2);
  std::mutex mutex;
  std::set<std::thread::id> seen;
  workers.for_each(200, [&](std::size_t) {
    std::this_thread::sleep_for(std::chrono::microseconds(200));
    const std::lock_guard lock(mutex);
    seen.insert(std::this_thread::get_id());
  });
  EXPECT_LE(seen.size(), 2U);
}

TEST(Workers, TheFirstExceptionComesOutAndStopsTheRest) {
  for (const int threads : {1, 3}) {
    const Workers workers(threads);
    std::atomic<int> calls = 0;
    EXPECT_THROW(workers.for_each(100000,
                                  [&](std::size_t i) {
                                    ++calls;
                                    if (i == 5) throw IoError("five");
                                    std::this_thread::sleep_for(std::chrono::microseconds(50));
                                  }),
                 IoError);
    EXPECT_LT(calls, 50000);
    std::atomic<int> again = 0;
    workers.for_each(10, [&](std::size_t) { ++again; });
    EXPECT_EQ(again, 10);
  }
}

TEST(Workers, TellWhatTheJobOnThisThreadMayUse) {
  const int all = Workers(0).count();
  EXPECT_EQ(Workers::count_here(), all);
  {
    const Workers one(1);
    EXPECT_EQ(Workers::count_here(), 1);
    {
      const Workers more(0);
      EXPECT_EQ(Workers::count_here(), all);
    }
    EXPECT_EQ(Workers::count_here(), 1);
    std::jthread([&] { EXPECT_EQ(Workers::count_here(), all); });
  }
  EXPECT_EQ(Workers::count_here(), all);
}

TEST(Workers, RefuseSillyNumbers) {
  EXPECT_THROW(Workers(-1), InvalidInput);
  EXPECT_THROW(Workers(100000), InvalidInput);
  EXPECT_GE(Workers(0).count(), 1);
}

}  // namespace
}  // namespace sightbound
