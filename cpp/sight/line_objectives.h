// SPDX-License-Identifier: GPL-3.0-or-later
// What a search along a sight line looks for: the smallest clearance ratio, or the height a target needs.
// Private to sight_line.cpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "sight/sight_line.h"

namespace sightbound {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Metres; keeps the rounding of a bound (1e-12 of a height) from excluding the place that decides.
inline constexpr double kSlack = 1e-7;

// k* itself: the smallest clearance ratio, from K downwards; unknown ground caps it at 0.
class SightLine::LeastRatio {
 public:
  LeastRatio(const SightLine& line, double least)
      : line_(line), best_(line.scene_.largest_ratio), least_(least) {}

  double best() const { return best_; }
  bool done() const { return best_ <= least_; }
  bool take(double, double clearance, double sigma) { return lower(clearance / sigma); }
  bool take_unknown() { return lower(0); }
  bool unknown_matters() const { return best_ > 0; }
  // What a place must do to matter: leave the line to a target of this height less than this many sigma of
  // clearance.
  double target_height() const { return line_.target_height_; }
  double ratio() const { return best_; }

 private:
  bool lower(double k) {
    if (!(k < best_)) return false;
    best_ = k;
    return true;
  }
  const SightLine& line_;
  double best_, least_;
};

// The height the target needs: at every place (1 - t) O + t T - drop t (1 - t) >= z + k sigma.
class SightLine::NeededHeight {
 public:
  NeededHeight(const SightLine& line, double k, double floor) : line_(line), k_(k), best_(floor) {}

  double best() const { return best_; }
  bool done() const { return best_ == kInfinity; }
  bool take(double t, double clearance, double sigma) {
    // The place lacks k sigma - clearance; raising the target by 1 raises the line there by t.
    return raise(line_.target_height_ + (k_ * sigma - clearance) / t);
  }
  bool take_unknown() { return k_ > 0 && raise(kInfinity); }
  bool unknown_matters() const { return k_ > 0; }
  double target_height() const { return best_; }
  double ratio() const { return k_; }

 private:
  bool raise(double height) {
    if (!(height > best_)) return false;
    best_ = height;
    return true;
  }
  const SightLine& line_;
  double k_, best_;
};

}  // namespace sightbound
