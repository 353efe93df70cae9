// SPDX-License-Identifier: GPL-3.0-or-later
// The only place that knows TBB.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace sightbound {

// A set of threads for one job; the calling thread is one of them. Not process-wide: two jobs with different
// numbers do not disturb each other.
class Workers {
 public:
  // 0 = as many as the machine has, which is also the most that are used.
  explicit Workers(int threads = 0);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  int count() const { return count_; }

  // How many threads the job that runs on this thread may use: those of the Workers made last on it and still
  // alive, or all cores. For work below that starts threads of its own (reading a file).
  static int count_here();

  // Calls f(i) for i in [0, n), each once, in any order and on any of the threads; returns when all are done.
  // The first exception thrown by f stops the rest and comes out here.
  void for_each(std::size_t n, const std::function<void(std::size_t)>& f) const;

 private:
  struct Arena;
  int count_, count_outside_;
  std::unique_ptr<Arena> arena_;
};

}  // namespace sightbound
