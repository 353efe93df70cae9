// SPDX-License-Identifier: GPL-3.0-or-later
// Progress and cancellation, passed last.
//
// Any thread may add work done and any thread learns of a cancellation; the callback itself runs only on the
// thread that made the Progress, at most ten times a second. A fraction never falls and ends at 1.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

namespace sightbound {

class Progress {
 public:
  // Gets the fraction done in [0, 1]; false cancels.
  using Callback = std::function<bool(double)>;

  explicit Progress(Callback callback = {});
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // The next `share` (0..1) of the whole is made of `units` units of work. Called between parallel parts only.
  void begin(double share, double units);
  // Adds `units` of work done. Throws Cancelled once cancelled. Cheap: one relaxed add; call every few milliseconds.
  void advance(double units);
  // Throws Cancelled once cancelled, and gives the callback a chance to say so.
  void check();
  // Reports 1.
  void finish();

 private:
  void report(bool force);

  Callback callback_;
  std::thread::id owner_;
  std::chrono::steady_clock::time_point last_;
  double base_ = 0, share_ = 0, units_ = 1;
  double reported_ = 0;
  std::atomic<double> done_{0};
  std::atomic<bool> cancelled_{false};
};

}  // namespace sightbound
