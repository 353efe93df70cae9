// SPDX-License-Identifier: GPL-3.0-or-later
// Method of the fit. For a given length the model is linear in nugget and sill: weighted least squares, both
// kept >= 0. The length with the least sum of squares is looked for on a geometric ladder, then between its
// neighbours. Weights: the variance of a semivariance is about 2 gamma^2 / pairs when pairs are independent;
// pairs that share places make it 2 gamma^2 (1 / pairs + 1 / places). For gamma the
// largest stands, lest a few short distances outweigh all others where the shape is not quite exponential.
#include "error_model/variogram.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightbound {

namespace {

constexpr double kFewestPairs = 30;  // for a semivariance worth having
constexpr std::size_t kFewestBins = 4;
constexpr int kLadder = 48;
// Twice the gain in log-likelihood that chance gives two more parameters in one case of a thousand.
constexpr double kWorthwhile = 13.8;

double semivariance(double mean_root, double pairs) {
  return 0.5 * std::pow(mean_root, 4) / (0.457 + 0.494 / pairs);
}

// 1, 2, 3, 4, 6, 8, 11, 16 ...
int lag_cells(std::size_t number) {
  if (number < 3) return static_cast<int>(number) + 1;
  return static_cast<int>(std::lround(std::exp2(0.5 * (static_cast<double>(number) + 1))));
}

struct Fit {
  double nugget = 0, sill = 0, length = 0;
  double misfit = std::numeric_limits<double>::infinity();  // chi square
};

double largest_of(const std::vector<LagBin>& bins) {
  double largest = 0;
  for (const LagBin& bin : bins) largest = std::max(largest, bin.semivariance);
  return largest;
}

Fit fit_of(const std::vector<LagBin>& bins, double places, double length) {
  const double gamma = largest_of(bins);
  double w = 0, wf = 0, wff = 0, wg = 0, wfg = 0, wgg = 0;
  for (const LagBin& bin : bins) {
    const double weight = 1 / (2 * gamma * gamma * (1 / bin.pairs + 1 / places)), g = bin.semivariance;
    const double f = length > 0 ? 1 - std::exp(-bin.distance / length) : 0;
    w += weight, wf += weight * f, wff += weight * f * f;
    wg += weight * g, wfg += weight * f * g, wgg += weight * g * g;
  }
  Fit fit;
  fit.length = length;
  const double determinant = w * wff - wf * wf;
  if (determinant > 1e-12 * w * wff) {
    fit.nugget = (wff * wg - wf * wfg) / determinant;
    fit.sill = (w * wfg - wf * wg) / determinant;
  }
  if (fit.nugget < 0) fit.nugget = 0, fit.sill = wfg / wff;
  if (fit.sill <= 0) fit.sill = 0, fit.nugget = wg / w;
  fit.misfit = wgg - 2 * (fit.nugget * wg + fit.sill * wfg) + fit.nugget * fit.nugget * w +
               2 * fit.nugget * fit.sill * wf + fit.sill * fit.sill * wff;
  return fit;
}

}  // namespace

double Variogram::at(double distance) const {
  return nugget + (length > 0 ? sill * (1 - std::exp(-distance / length)) : 0);
}

double Variogram::correlation_length(double other) const {
  return sill > 0 ? length * std::sqrt(sill / (std::max(0.0, nugget - other) + sill)) : 0;
}

void GridVariogram::add(const Grid<float>& errors, const CellSize& cell) {
  const auto sum_over = [&](std::vector<Sum>& sums, int rows_apart, int cols_apart, std::size_t number) {
    if (sums.size() <= number) sums.resize(number + 1);
    Sum& sum = sums[number];
    double roots = 0, pairs = 0;
    for (int r = 0; r + rows_apart < errors.rows(); ++r) {
      const float *one = errors.row(r), *other = errors.row(r + rows_apart) + cols_apart;
      for (int c = 0; c + cols_apart < errors.cols(); ++c) {
        const float apart = std::abs(one[c] - other[c]);
        if (std::isnan(apart)) continue;
        roots += std::sqrt(apart);
        ++pairs;
      }
    }
    sum.roots += roots;
    sum.pairs += pairs;
    sum.distance += pairs * (cols_apart * cell.col_m + rows_apart * cell.row_m);
  };
  for (std::size_t number = 0; 2 * lag_cells(number) <= errors.cols(); ++number)
    sum_over(along_rows_, 0, lag_cells(number), number);
  for (std::size_t number = 0; 2 * lag_cells(number) <= errors.rows(); ++number)
    sum_over(along_columns_, lag_cells(number), 0, number);
  for (const float error : errors.values()) places_ += !std::isnan(error);
}

std::vector<LagBin> GridVariogram::bins() const {
  std::vector<LagBin> bins;
  for (const std::vector<Sum>* sums : {&along_rows_, &along_columns_}) {
    for (const Sum& sum : *sums) {
      if (sum.pairs < kFewestPairs) continue;
      bins.push_back({sum.distance / sum.pairs, semivariance(sum.roots / sum.pairs, sum.pairs), sum.pairs});
    }
  }
  std::sort(bins.begin(), bins.end(),
            [](const LagBin& a, const LagBin& b) { return a.distance < b.distance; });
  return bins;
}

std::vector<LagBin> variogram_of_places(std::span<const PlacedError> all, double nearest) {
  std::vector<PlacedError> places;
  const std::size_t wanted = std::min(all.size(), kMostPaired);
  for (std::size_t i = 0; i < wanted; ++i) places.push_back(all[i * all.size() / wanted]);
  double x_low = 1e300, x_high = -1e300, y_low = 1e300, y_high = -1e300;
  for (const PlacedError& p : places) {
    x_low = std::min(x_low, p.x), x_high = std::max(x_high, p.x);
    y_low = std::min(y_low, p.y), y_high = std::max(y_high, p.y);
  }
  const double farthest = 0.5 * std::hypot(x_high - x_low, y_high - y_low);
  if (!(farthest > 0)) return {};

  // Bins from the typical distance of neighbours / 4 on, each wider than the last by a third.
  const double typical =
      std::sqrt((x_high - x_low + farthest) * (y_high - y_low + farthest) / static_cast<double>(wanted));
  const double first = std::max(nearest, std::min(0.25 * typical, farthest / 4));
  if (first >= farthest) return {};
  constexpr double kGrowth = 4.0 / 3;
  const auto bin_of = [&](double d) {
    return d < first ? 0 : 1 + static_cast<std::size_t>(std::log(d / first) / std::log(kGrowth));
  };
  struct Sum {
    double distance = 0, roots = 0, pairs = 0;
  };
  std::vector<Sum> sums(bin_of(farthest) + 1);
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t j = i + 1; j < places.size(); ++j) {
      const double d = std::hypot(places[i].x - places[j].x, places[i].y - places[j].y);
      if (d < nearest || d > farthest) continue;
      Sum& sum = sums[bin_of(d)];
      sum.distance += d;
      sum.roots += std::sqrt(std::abs(places[i].error - places[j].error));
      ++sum.pairs;
    }
  }
  std::vector<LagBin> bins;
  for (const Sum& sum : sums) {
    if (sum.pairs < kFewestPairs) continue;
    bins.push_back({sum.distance / sum.pairs, semivariance(sum.roots / sum.pairs, sum.pairs), sum.pairs});
  }
  return bins;
}

Variogram fit_variogram(std::vector<LagBin> bins, std::size_t places) {
  Variogram out;
  out.bins = std::move(bins);
  std::vector<LagBin> known;
  for (const LagBin& bin : out.bins) {
    if (bin.semivariance > 0) known.push_back(bin);
  }
  if (known.size() < kFewestBins) return out;
  const auto n = static_cast<double>(places);
  const Fit alone = fit_of(known, n, 0);
  const double shortest = 0.5 * known.front().distance, longest = known.back().distance;
  const double step = std::pow(longest / shortest, 1.0 / kLadder);
  Fit best;
  for (int i = 0; i <= kLadder; ++i) {
    const Fit fit = fit_of(known, n, shortest * std::pow(step, i));
    if (fit.misfit < best.misfit) best = fit;
  }
  const double middle = best.length;
  for (int i = -kLadder; i <= kLadder; ++i) {
    const Fit fit = fit_of(known, n, middle * std::pow(step, i / static_cast<double>(kLadder)));
    if (fit.misfit < best.misfit && fit.length <= longest) best = fit;
  }
  if (best.sill > 0 && alone.misfit - best.misfit > kWorthwhile) {
    out.nugget = best.nugget, out.sill = best.sill, out.length = best.length;
    out.length_is_largest = best.length >= longest / step;
  } else {
    out.nugget = alone.nugget;
  }
  return out;
}

}  // namespace sightbound
