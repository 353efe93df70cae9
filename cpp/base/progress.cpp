// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/progress.h"

#include <algorithm>
#include <utility>

#include "base/error.h"

namespace sightbound {

namespace {
constexpr std::chrono::milliseconds kReportInterval{100};
}

Progress::Progress(Callback callback) : callback_(std::move(callback)), owner_(std::this_thread::get_id()) {}

void Progress::begin(double share, double units) {
  base_ += share_;
  share_ = share;
  units_ = std::max(units, 1.0);
  done_.store(0, std::memory_order_relaxed);
  check();
}

void Progress::advance(double units) {
  double seen = done_.load(std::memory_order_relaxed);
  while (!done_.compare_exchange_weak(seen, seen + units, std::memory_order_relaxed)) {
  }
  check();
}

void Progress::check() {
  if (std::this_thread::get_id() == owner_) report(false);
  if (cancelled_.load(std::memory_order_relaxed)) throw Cancelled();
}

void Progress::finish() {
  base_ = 1;
  share_ = 0;
  report(true);
  if (cancelled_.load(std::memory_order_relaxed)) throw Cancelled();
}

void Progress::report(bool force) {
  if (!callback_) return;
  const auto now = std::chrono::steady_clock::now();
  if (!force && now - last_ < kReportInterval) return;
  last_ = now;
  const double part = std::min(done_.load(std::memory_order_relaxed) / units_, 1.0);
  reported_ = std::clamp(base_ + share_ * part, reported_, 1.0);
  if (!callback_(reported_)) cancelled_.store(true, std::memory_order_relaxed);
}

}  // namespace sightbound
