// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/upper_horizon.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace sightbound {

namespace {
constexpr int kLeastPart = 16;  // columns an upper horizon stands for, at least
constexpr int kMostParts = 128;
}  // namespace

UpperHorizon::UpperHorizon(int base, double observer, int sign, double reach, int wedges)
    : base_(base),
      observer_(static_cast<int>(std::floor(observer))),
      sign_(sign),
      part_length_(kLeastPart),
      wedges_(static_cast<std::size_t>(wedges)) {
  // Parts of equal length, a power of two, so many that a search can be confined to few columns.
  while (part_length_ * kMostParts < reach) part_length_ *= 2;
}

float* UpperHorizon::between(int near, int here) { return part_between(near, here).above.data(); }

void UpperHorizon::raise_all(int near, int here, float slope) {
  float& everywhere = part_between(near, here).everywhere;
  everywhere = std::max(everywhere, slope);
}

void UpperHorizon::forget() {
  for (Part& part : parts_) part.everywhere = kUnbounded;
}

void UpperHorizon::split() {
  wedges_ *= 2;
  for (Part& part : parts_) {
    part.above.resize(wedges_);
    for (std::size_t i = wedges_; i-- > 0;) part.above[i] = part.above[i / 2];
  }
}

OpenParts UpperHorizon::open_parts(WedgePair wedge, float slope, bool sure, int target_major) {
  ranges_.clear();
  add_range(observer_ + base_ + (sign_ < 0 ? 1 : 0),
            parts_.empty() ? target_major : parts_.front().from + base_);
  for (const Part& part : parts_) {
    const float reaches = std::max({part.everywhere, part.above[static_cast<std::size_t>(wedge.a)],
                                    part.above[static_cast<std::size_t>(wedge.b)]});
    if (!sure || !(reaches + 1e-6f * std::abs(reaches) < slope))
      add_range(part.from + base_, part.to + base_);
  }
  if (!parts_.empty()) add_range(parts_.back().to + base_, target_major);
  return ranges_;
}

UpperHorizon::Part& UpperHorizon::part_between(int near, int here) {
  const int number = part_number(here);
  if (parts_.empty() || parts_.back().number != number)
    parts_.push_back({number, near, near, -kUnbounded, std::vector<float>(wedges_, -kUnbounded)});
  parts_.back().to = here;
  return parts_.back();
}

// Parts are short near the observer, where an upper horizon is loose and should not speak for many columns.
int UpperHorizon::part_number(int major) const {
  const auto steps = static_cast<unsigned>(std::abs(major - observer_));
  if (steps >= static_cast<unsigned>(part_length_)) return static_cast<int>(steps) / part_length_;
  return static_cast<int>(std::bit_width(steps)) - std::numeric_limits<unsigned>::digits;
}

// Columns in the order of the march; steps in order of the grid.
void UpperHorizon::add_range(int from, int to) {
  const MajorRange range{std::min(from, to), std::max(from, to)};
  if (range.from == range.to) return;
  if (!ranges_.empty() && sign_ > 0 && ranges_.back().to == range.from) {
    ranges_.back().to = range.to;
  } else if (!ranges_.empty() && sign_ < 0 && ranges_.back().from == range.to) {
    ranges_.back().from = range.from;
  } else {
    ranges_.push_back(range);
  }
}

}  // namespace sightbound
