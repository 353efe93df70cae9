// SPDX-License-Identifier: GPL-3.0-or-later
// Method. The clearance at each place is a sum of independent normal draws (of samples, of nodes, of fine
// ground): as such sums clearances have means, variances and covariances, and each step of the bound is a
// probability of two of them. Places stand in the tree below the one before them on the line, those of fine
// ground below the first of the two that they lie between.
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
  Clearances(const LineInDoubt& line, const OpenTerrain& terrain, const RealisedColumns& columns)
      : line_(line),
        terrain_(terrain),
        columns_(columns),
        fine_(terrain, line.over.transposed, line.base_row, line.base_col, 0),
        eye_(ground(0)),
        target_(ground(line.over.places.size() - 1)) {
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
  static constexpr std::uint64_t kFine = std::uint64_t{1} << 63;

  Sum ground(std::size_t i) const {
    Sum sum;
    const std::size_t crossings = line_.over.places.size();
    if (i < crossings) {
      const NodePlace& place = line_.over.places[i];
      for (std::size_t n = 0; n < static_cast<std::size_t>(place.nodes); ++n)
        sum.add(static_cast<double>(place.weight[n]), node(place.node[n].major, place.node[n].minor));
      return sum;
    }
    const LineInDoubt::Halves& of = line_.fine[i - crossings];
    const auto a = static_cast<std::size_t>(of.a), b = static_cast<std::size_t>(of.b);
    sum.add(0.5, ground(a));
    sum.add(0.5, ground(b));
    const double spread = fine_.spread_between(line_.where[a], line_.where[b]);
    sum.add(spread, {0, {{kFine | i, 1}}});
    return sum;
  }

  Sum node(int major, int minor) const {
    const std::uint64_t draw =
        static_cast<std::uint64_t>(major) << 32 | static_cast<std::uint64_t>(static_cast<unsigned>(minor));
    if (major % 2 == 0 && minor % 2 == 0) {
      const int row = (line_.over.transposed ? major : minor) / 2,
                col = (line_.over.transposed ? minor : major) / 2;
      return {terrain_.mean.at(row, col) - line_.datum,
              {{draw, static_cast<double>(terrain_.spread.at(row, col))}}};
    }
    Sum sum;
    sum.add(0.5, node(2 * (major / 2), 2 * (minor / 2)));
    sum.add(0.5, node(2 * ((major + 1) / 2), 2 * ((minor + 1) / 2)));
    sum.add(1, {0, {{draw, columns_.between(major, minor)}}});
    return sum;
  }

  const LineInDoubt& line_;
  const OpenTerrain& terrain_;
  const RealisedColumns& columns_;
  const FineGround fine_;
  Sum eye_, target_;  // by which the ends rise
};

// In standard deviations: the clearance is below 0 where a standard normal variable is below -ratio.
double ratio(const Sum& clearance, double variance) {
  if (variance > 0) return clearance.mean / std::sqrt(variance);
  return clearance.mean >= 0 ? std::numeric_limits<double>::infinity()
                             : -std::numeric_limits<double>::infinity();
}

}  // namespace

double blocked_bound(const LineInDoubt& line, const OpenTerrain& terrain, const RealisedColumns& columns) {
  if (line.places.empty()) return 0;
  const Clearances clearances(line, terrain, columns);
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
  double bound = 0;
  Known before{{}, 0, 0};
  for (std::size_t i = 0; i < line.places.size() && bound < 1; ++i) {
    if (!line.places[i].judged) continue;
    if (i < crossings && !line.over.places[i].known) return 1;
    Known here = known(i);
    if (i < crossings) {
      bound += step(before, here);
      before = std::move(here);
    } else {
      const auto a = static_cast<std::size_t>(line.fine[i - crossings].a);
      bound += line.places[a].judged ? step(known(a), here) : normal_cdf(-here.k);
    }
  }
  return std::min(bound, 1.0);
}

}  // namespace sightbound
