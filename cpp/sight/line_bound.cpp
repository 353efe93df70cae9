// SPDX-License-Identifier: GPL-3.0-or-later
// Method. The clearance at each place is a sum of independent normal draws (of samples, centres, nodes,
// crossings, fine ground): as such sums clearances have means, variances and covariances, and each step of
// the bound is a probability of two of them. Places stand in the tree below the one before them on the line,
// those of fine ground below the first of the two that they lie between.
#include "sight/line_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "error_model/error_model.h"
#include "error_model/normal_pair.h"

namespace sightbound {

namespace {

// Places as sure as this count by themselves, without the one before: P < 1e-15.
constexpr double kSure = 8;

// mean + sum of part x draw; parts sorted by draw.
struct Sum {
  double mean = 0;
  std::vector<std::pair<std::uint64_t, double>> parts;

  void add(double weight, const Sum& other) {
    mean += weight * other.mean;
    std::vector<std::pair<std::uint64_t, double>> both;
    auto a = parts.begin();
    for (const auto& [draw, part] : other.parts) {
      while (a != parts.end() && a->first < draw) both.push_back(*a++);
      const bool same = a != parts.end() && a->first == draw;
      both.emplace_back(draw, weight * part + (same ? a++->second : 0));
    }
    both.insert(both.end(), a, parts.end());
    parts.swap(both);
  }
};

double covariance(const Sum& one, const Sum& other) {
  double sum = 0;
  auto b = other.parts.begin();
  for (const auto& [draw, part] : one.parts) {
    while (b != other.parts.end() && b->first < draw) ++b;
    if (b != other.parts.end() && b->first == draw) sum += part * b->second;
  }
  return sum;
}

class Clearances {
 public:
  explicit Clearances(const LineInDoubt& line)
      : line_(line), eye_(ground(0)), target_(ground(line.over.places.size() - 1)) {
    eye_.mean -= line.eye_ground;
    target_.mean -= line.target_ground;
  }

  Sum of(std::size_t i) const {
    const DoubtfulPlace& place = line_.places[i];
    Sum clearance{static_cast<double>(place.line), {}};
    clearance.add(-1, ground(i));
    clearance.add(static_cast<double>(place.with_eye), eye_);
    clearance.add(static_cast<double>(place.with_target), target_);
    return clearance;
  }

 private:
  static Sum drawn(double mean, const Departure& own) {
    const std::uint64_t draw = static_cast<std::uint64_t>(own.key.b) << 32 | own.key.a;
    return {mean + static_cast<double>(own.rise), {{draw, static_cast<double>(own.spread)}}};
  }
  Sum source(int n) const {
    const SampleDraw& source = line_.sources[static_cast<std::size_t>(n)];
    return drawn(static_cast<double>(source.mean), source.own);
  }

  // As draw() of a node adds them up.
  Sum node(int n) const {
    const LineNode& node = line_.nodes[static_cast<std::size_t>(n)];
    if (node.is_sample) return source(node.a);
    const bool is_centre = node.draw.kind == NodeDraw::Kind::kCentre;
    Sum sum = is_centre ? Sum{} : drawn(0, node.draw.own);
    for (const int sample : {node.a, node.b}) sum.add(is_centre ? 0.25 : 0.5, source(sample));
    if (node.draw.kind == NodeDraw::Kind::kBetween) return sum;
    sum.mean += static_cast<double>(node.draw.rise);
    if (is_centre) {
      for (const int sample : {node.c, node.d}) sum.add(0.25, source(sample));
      sum.add(1, source(node.e));
    } else {
      for (const int centre : {node.e, node.f}) sum.add(static_cast<double>(node.draw.share), source(centre));
    }
    return sum;
  }

  Sum ground(std::size_t i) const {
    const std::size_t crossings = line_.over.places.size();
    if (i < crossings) {
      const NodePlace& place = line_.over.places[i];
      Sum sum = drawn(0, line_.across[i]);
      for (std::size_t n = 0; n < static_cast<std::size_t>(place.nodes); ++n)
        sum.add(static_cast<double>(place.weight[n]), node(place.index[n]));
      return sum;
    }
    const FineHalf& half = line_.fine[i - crossings];
    Sum sum = drawn(0, half.draw);
    for (const int end : {half.a, half.b}) sum.add(0.5, ground(static_cast<std::size_t>(end)));
    return sum;
  }

  const LineInDoubt& line_;
  Sum eye_, target_;  // by which the ends rise
};

// In standard deviations: the clearance is below 0 where a standard normal variable is below -ratio.
double ratio(const Sum& clearance, double variance) {
  if (variance > 0) return clearance.mean / std::sqrt(variance);
  return clearance.mean >= 0 ? std::numeric_limits<double>::infinity()
                             : -std::numeric_limits<double>::infinity();
}

}  // namespace

double blocked_bound(const LineInDoubt& line) {
  if (line.places.empty()) return 0;
  if (!line.normal) return std::numeric_limits<double>::quiet_NaN();
  const Clearances clearances(line);
  struct Known {
    Sum clearance;
    double variance, k;
  };
  const auto known = [&](std::size_t i) {
    Sum clearance = clearances.of(i);
    const double variance = covariance(clearance, clearance);
    const double k = ratio(clearance, variance);
    return Known{std::move(clearance), variance, k};
  };
  const auto step = [&](const Known& before, const Known& after) {
    if (!(after.k < kSure) || !(before.variance > 0)) return normal_cdf(-after.k);
    const double both = std::sqrt(before.variance * after.variance);
    const double rho = both > 0 ? covariance(before.clearance, after.clearance) / both : 0;
    return below_while_above(-after.k, -before.k, rho);
  };
  const std::size_t crossings = line.over.places.size();
  double bound = 0, closed = 0;  // the latter: by unknown ground
  Known before{{}, 0, 0};
  for (std::size_t i = 0; i < line.places.size(); ++i) {
    if (!line.places[i].judged) continue;
    if (line.places[i].unknown) {
      closed = 0.5;
      continue;
    }
    Known here = known(i);
    if (i < crossings) {
      bound += step(before, here);
      before = std::move(here);
    } else {
      const auto a = static_cast<std::size_t>(line.fine[i - crossings].a);
      bound += line.places[a].judged ? step(known(a), here) : normal_cdf(-here.k);
    }
  }
  return closed + (1 - closed) * std::min(bound, 1.0);
}

}  // namespace sightbound
