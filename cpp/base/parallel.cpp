// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel.h"

#include <algorithm>
#include <string>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

#include "base/error.h"

namespace sightbound {

namespace {
constexpr int kMaxThreads = 1024;

thread_local int innermost_count = 0;  // of the calling thread's Workers; 0 = it has none

int thread_count(int threads) {
  if (threads < 0 || threads > kMaxThreads) {
    throw InvalidInput("threads is " + std::to_string(threads) + "; give 0 (all cores) to " +
                       std::to_string(kMaxThreads) + ".");
  }
  // More threads than cores gain nothing, and TBB complains of them on stderr.
  const int cores = tbb::this_task_arena::max_concurrency();
  return threads > 0 ? std::min(threads, cores) : cores;
}
}  // namespace

struct Workers::Arena {
  explicit Arena(int threads) : arena(threads) {}
  tbb::task_arena arena;
};

Workers::Workers(int threads)
    : count_(thread_count(threads)),
      count_outside_(innermost_count),
      arena_(std::make_unique<Arena>(count_)) {
  innermost_count = count_;
}

Workers::~Workers() { innermost_count = count_outside_; }

int Workers::count_here() { return innermost_count > 0 ? innermost_count : thread_count(0); }

void Workers::for_each(std::size_t n, const std::function<void(std::size_t)>& f) const {
  if (count_ == 1) {
    for (std::size_t i = 0; i < n; ++i) f(i);
    return;
  }
  arena_->arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, n, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t i = range.begin(); i != range.end(); ++i) f(i);
        },
        tbb::simple_partitioner());
  });
}

}  // namespace sightbound
