// SPDX-License-Identifier: GPL-3.0-or-later
#include <chrono>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/parallel.h"
#include "base/progress.h"

namespace sightbound {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

void work_for(milliseconds time) {
  const auto until = steady_clock::now() + time;
  while (steady_clock::now() < until) std::this_thread::yield();
}

TEST(Progress, NeverFallsAndEndsAtOne) {
  std::vector<double> seen;
  Progress progress([&](double fraction) {
    seen.push_back(fraction);
    return true;
  });
  progress.begin(0.25, 10);
  for (int i = 0; i < 30; ++i) {  // more than was announced
    progress.advance(1);
    work_for(milliseconds(5));
  }
  progress.begin(0.75, 10);
  for (int i = 0; i < 10; ++i) {
    progress.advance(1);
    work_for(milliseconds(15));
  }
  progress.finish();
  ASSERT_GE(seen.size(), 3U);
  for (std::size_t i = 1; i < seen.size(); ++i) EXPECT_GE(seen[i], seen[i - 1]);
  EXPECT_GE(seen.front(), 0);
  EXPECT_EQ(seen.back(), 1);
}

TEST(Progress, CallsAtMostTenTimesASecond) {
  int calls = 0;
  Progress progress([&](double) {
    ++calls;
    return true;
  });
  progress.begin(1, 1e9);
  const auto start = steady_clock::now();
  while (steady_clock::now() - start < milliseconds(350)) progress.advance(1);
  EXPECT_GE(calls, 2);
  EXPECT_LE(calls, 5);
}

TEST(Progress, RunsOnTheCallingThreadOnly) {
  const std::thread::id caller = std::this_thread::get_id();
  int calls = 0, elsewhere = 0;
  Progress progress([&](double) {
    ++calls;
    elsewhere += std::this_thread::get_id() != caller;
    return true;
  });
  progress.begin(1, 200);
  const Workers workers(4);
  workers.for_each(200, [&](std::size_t) {
    work_for(milliseconds(5));
    progress.advance(1);
  });
  progress.finish();
  EXPECT_GE(calls, 2);
  EXPECT_EQ(elsewhere, 0);
}

TEST(Progress, CancelReachesEveryThread) {
  std::atomic<int> done = 0;
  Progress progress([](double) { return false; });
  const Workers workers(4);
  const auto start = steady_clock::now();
  EXPECT_THROW(workers.for_each(100000,
                                [&](std::size_t) {
                                  progress.advance(1);
                                  work_for(milliseconds(1));
                                  ++done;
                                }),
               Cancelled);
  EXPECT_LT(steady_clock::now() - start, milliseconds(200));
  EXPECT_LT(done, 1000);
}

TEST(Progress, CancelFromTheCallbackThrowsAtOnceAndAgain) {
  Progress progress([](double) { return false; });
  EXPECT_THROW(progress.check(), Cancelled);
  EXPECT_THROW(progress.advance(1), Cancelled);
  EXPECT_THROW(progress.finish(), Cancelled);
}

TEST(Progress, AnExceptionOfTheCallbackComesOut) {
  Progress progress([](double) -> bool { throw InvalidInput("from the callback"); });
  EXPECT_THROW(progress.check(), InvalidInput);
}

TEST(Progress, WithoutACallbackNothingHappens) {
  Progress progress;
  progress.begin(1, 10);
  EXPECT_NO_THROW(progress.advance(5));
  EXPECT_NO_THROW(progress.finish());
}

}  // namespace
}  // namespace sightbound
