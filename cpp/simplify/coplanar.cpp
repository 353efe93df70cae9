// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/coplanar.h"

#include <array>
#include <cmath>

namespace sightbound {

namespace {

// A sum of doubles without rounding (Shewchuk 1997): parts that do not overlap.
class ExactSum {
 public:
  // Splits each factor in two halves of 26 bits, whose products are exact (Dekker 1971).
  void add_product(double a, double b) {
    constexpr double kSplitter = 0x1p27 + 1;
    const double product = a * b;
    const double a_high = kSplitter * a - (kSplitter * a - a), b_high = kSplitter * b - (kSplitter * b - b);
    const double a_low = a - a_high, b_low = b - b_high;
    add(a_low * b_low - (product - a_high * b_high - a_low * b_high - a_high * b_low));
    add(product);
  }
  bool zero() const {
    for (std::size_t i = 0; i < size_; ++i) {
      if (parts_[i] != 0) return false;
    }
    return true;
  }

 private:
  void add(double value) {
    for (std::size_t i = 0; i < size_; ++i) {
      const double sum = value + parts_[i], back = sum - value;
      parts_[i] = (value - (sum - back)) + (parts_[i] - back);
      value = sum;
    }
    parts_[size_++] = value;
  }

  std::array<double, 8> parts_{};
  std::size_t size_ = 0;
};

// The ends of the edges from `centre`, counterclockwise from `first` on, from outline to outline or round to
// first again.
struct Fan {
  std::array<Point, EdgeStar::kMostRing + 2> at;
  std::size_t size = 0;
  void add(const Point& p) { at[size++] = p; }
};

// One plane from `first` on, another one for the rest: where the second begins, first and that place lie on a
// line through the centre.
bool two_planes_at_most(const Point& centre, const Fan& fan, bool open) {
  int planes = 1;
  std::size_t start = 0;
  for (std::size_t i = 2; i < fan.size; ++i) {
    if (coplanar(centre, fan.at[start], fan.at[start + 1], fan.at[i])) continue;
    if (open || ++planes > 2) return false;
    start = i - 1;
  }
  return true;
}

bool may_go(const EdgeStar& star, bool b_goes) {
  const Point &gone = b_goes ? star.place_b : star.place_a, &kept = b_goes ? star.place_a : star.place_b;
  const bool outline_edge = star.right < 0;
  const int begin = star.b_begin, end = star.b_end;
  const auto at = [&](int i) { return star.at[static_cast<std::size_t>(i)]; };
  Fan fan;
  if (outline_edge) {
    // The ring leads up to the apex round the end that comes first, and on round the other one.
    const bool b_first = begin == 0 && end == star.left;
    if (b_goes == b_first) {
      for (int i = 0; i <= star.left; ++i) fan.add(at(i));
      fan.add(kept);
    } else {
      fan.add(kept);
      for (int i = star.left; i < star.size; ++i) fan.add(at(i));
    }
    return two_planes_at_most(gone, fan, true);
  }
  if (b_goes) {
    fan.add(kept);
    for (int i = begin; i <= end; ++i) fan.add(at(i));
    fan.add(kept);
  } else {
    // Only ends inside go, so the ring is closed: from left (0) to right (begin).
    if (!star.closed) return false;
    fan.add(kept);
    for (int i = 0; i <= begin; ++i) fan.add(at(i));
    fan.add(kept);
  }
  return two_planes_at_most(gone, fan, false);
}

}  // namespace

// Six times the volume of the four is the sum of each height times the plan area of the other three.
bool coplanar(const Point& a, const Point& b, const Point& c, const Point& d) {
  if (a.z == b.z && a.z == c.z && a.z == d.z) return true;
  const std::array<double, 4> area{area2(b, c, d), -area2(a, c, d), area2(a, b, d), -area2(a, b, c)};
  const std::array<double, 4> height{a.z, b.z, c.z, d.z};
  double sum = 0, size = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    sum += area[i] * height[i];
    size += std::abs(area[i] * height[i]);
  }
  constexpr double kRounding = 0x1p-50;  // seven roundings of 2^-53
  if (std::abs(sum) > kRounding * size) return false;
  ExactSum exact;
  for (std::size_t i = 0; i < 4; ++i) exact.add_product(area[i], height[i]);
  return exact.zero();
}

std::optional<Point> place_without_change(const EdgeStar& star, bool only_a) {
  if (may_go(star, true)) return star.place_a;
  if (!only_a && may_go(star, false)) return star.place_b;
  return {};
}

}  // namespace sightbound
