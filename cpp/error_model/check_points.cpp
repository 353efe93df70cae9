// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_model/check_points.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "base/error.h"
#include "base/number_text.h"

namespace sightbound {

namespace {

constexpr std::size_t kMostBins = 10, kFewestInBin = 30;
// Of a scale from n residuals, times sqrt(n): 1.30 for Laplace, the least sure; 0.89 for normal ones.
constexpr double kRelativeErrorOfScale = 1.3;

constexpr std::size_t kPlaceOf99 = 6;  // in kShownConfidences
static_assert(kShownConfidences[kPlaceOf99] == 0.99);
constexpr std::size_t kFewestForHeavyTails = 1000;
constexpr double kMuchHeavier = 1.25;

using Value = std::function<double(const CheckedPlace&)>;

double squared(double x) { return x * x; }

Dependence dependence_on(std::span<const CheckedPlace> places, const Value& value, double bias, Tails tails) {
  std::vector<std::size_t> order(places.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return value(places[a]) < value(places[b]); });
  const std::size_t bins = std::clamp(places.size() / kFewestInBin, std::size_t{1}, kMostBins);
  Dependence out;
  double all = 0, all_squared = 0, between_bins = 0;
  for (std::size_t bin = 0; bin < bins; ++bin) {
    std::vector<double> sizes;
    double values = 0, taken_off = 0, sum = 0;
    for (std::size_t i = bin * order.size() / bins; i < (bin + 1) * order.size() / bins; ++i) {
      const CheckedPlace& place = places[order[i]];
      sizes.push_back(std::abs(place.error - bias));
      values += value(place), taken_off += squared(place.between);
      sum += sizes.back(), all_squared += squared(sizes.back());
    }
    std::sort(sizes.begin(), sizes.end());
    const auto n = static_cast<double>(sizes.size());
    const double variance = squared(scale_of(sizes, tails)) - taken_off / n;
    out.bins.push_back({values / n, std::sqrt(std::max(0.0, variance)), n});
    all += sum, between_bins += sum * sum / n;
  }
  const double mean_part = squared(all) / static_cast<double>(places.size());
  if (all_squared > mean_part) out.explained = (between_bins - mean_part) / (all_squared - mean_part);
  return out;
}

struct Line {
  double at_zero = 0, rise = 0, se_rise = 0;
};

Line weighted_line(const std::vector<Dependence::Bin>& bins, const std::vector<double>& weights) {
  double w = 0, wt = 0, wtt = 0, ws = 0, wts = 0;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const double t = bins[i].value, s = bins[i].sigma, weight = weights[i];
    w += weight, wt += weight * t, wtt += weight * t * t, ws += weight * s, wts += weight * t * s;
  }
  const double determinant = w * wtt - wt * wt;
  if (!(determinant > 1e-12 * w * wtt)) return {ws / w, 0, 0};
  Line line;
  line.rise = (w * wts - wt * ws) / determinant;
  line.at_zero = (ws - line.rise * wt) / w;
  line.se_rise = std::sqrt(w / determinant);
  if (line.at_zero < 0) line.at_zero = 0, line.rise = wts / wtt;
  return line;
}

// a and b: a line through the bins, each as sure as its number of places makes it, twice: the second time
// with the sureness that the first line gives. A slope part that may be chance (two standard errors) is none.
void fit_slope(const std::vector<Dependence::Bin>& bins, double pooled, ErrorCheck& out) {
  out.at_flat = pooled, out.per_slope = 0;
  if (bins.size() < 3 || !(pooled > 0)) return;
  std::vector<double> expected(bins.size(), pooled), weights(bins.size());
  Line line;
  for (int round = 0; round < 3; ++round) {
    for (std::size_t i = 0; i < bins.size(); ++i)
      weights[i] = bins[i].places / squared(kRelativeErrorOfScale * expected[i]);
    line = weighted_line(bins, weights);
    for (std::size_t i = 0; i < bins.size(); ++i)
      expected[i] = std::max(line.at_zero + line.rise * bins[i].value, 0.1 * pooled);
  }
  if (line.rise <= 0 || line.rise < 2 * line.se_rise) return;
  out.at_flat = line.at_zero;
  out.per_slope = line.rise;
}

double sigma_at(const CheckedPlace& place, const ErrorCheck& check) {
  return std::max(kLeastSigma, std::hypot(check.at_flat + check.per_slope * place.slope, place.between));
}

void fit_sizes(std::span<const CheckedPlace> places, ErrorCheck& out) {
  const double bias = out.statistics.median;
  out.slope = dependence_on(
      places, [](const CheckedPlace& p) { return p.slope; }, bias, out.tails);
  double pooled = 0, n = 0;
  for (const auto& bin : out.slope.bins) pooled += bin.places * squared(bin.sigma), n += bin.places;
  fit_slope(out.slope.bins, std::sqrt(pooled / n), out);
}

std::vector<double> sizes_in_sigmas(std::span<const CheckedPlace> places, const ErrorCheck& check) {
  std::vector<double> sizes;
  for (const CheckedPlace& place : places)
    sizes.push_back((place.error - check.statistics.median) / sigma_at(place, check));
  return sorted_sizes(sizes);
}

double ridge_bias_of(std::span<const CheckedPlace> places, double bias) {
  double cc = 0, cr = 0;
  for (const CheckedPlace& place : places) {
    cc += squared(place.curvature);
    cr += place.curvature * (place.error - bias);
  }
  return cc > 0 ? -cr / cc : 0;
}

void warn(ErrorCheck& check) {
  const ResidualStatistics& found = check.statistics;
  const auto say = [&](std::string text) { check.warnings.push_back(std::move(text)); };
  if (found.outliers > 0) {
    say(std::to_string(found.outliers) + " of " + std::to_string(found.count) +
        " residuals are farther than 5 NMAD (" + number_text(kOutlierNmads * found.nmad, 3) +
        " m) from the median: look whether they are blunders. They were kept.");
  }
  if (found.count < kFewestForTails) {
    say("With " + std::to_string(found.count) + " places the kind of tails cannot be told (needed: 100).");
  }
  const double z99 = two_sided_quantile(0.99, check.tails), q99 = check.quantiles[kPlaceOf99];
  if (found.count >= kFewestForHeavyTails && q99 > kMuchHeavier * z99) {
    say("The tails are heavier than any that the model knows: one residual in a hundred is beyond " +
        number_text(q99, 3) + " sigma, where " + name_of(check.tails) + " tails have it beyond " +
        number_text(z99, 3) + ". Claims at 99 % will hold less often than that.");
  }
  if (check.at_flat == 0 && check.between > 0) {
    say("The residuals are no larger than what the DEM's own shape lets expect between its samples: nothing "
        "is left for an error of the measured heights, and vertical_rmse is 0 on level ground.");
  }
}

}  // namespace

void judge(std::span<const CheckedPlace> places, ErrorCheck& out) {
  if (places.size() < kFewestChecks) {
    throw InvalidInput("Only " + std::to_string(places.size()) +
                       " places have a height in the DEM and a true one; at least " +
                       std::to_string(kFewestChecks) + " are needed.");
  }
  std::vector<double> residuals;
  double between = 0;
  for (const CheckedPlace& place : places) {
    residuals.push_back(place.error);
    between += squared(place.between);
  }
  out.statistics = statistics_of(residuals);
  out.between = std::sqrt(between / static_cast<double>(places.size()));
  out.tails = Tails::kNormal;
  fit_sizes(places, out);
  out.tails = tails_of(sizes_in_sigmas(places, out));
  fit_sizes(places, out);
  const std::vector<double> sizes = sizes_in_sigmas(places, out);
  for (const double c : kShownConfidences) out.quantiles.push_back(quantile(sizes, c));
  const double bias = out.statistics.median;
  out.curvature = dependence_on(
      places, [](const CheckedPlace& p) { return std::abs(p.curvature); }, bias, out.tails);
  out.ridge_bias = ridge_bias_of(places, bias);
  warn(out);
}

ErrorModel with_check(ErrorModel model, const ErrorCheck& check) {
  if (std::holds_alternative<FromDem>(model.vertical_rmse)) {
    model.vertical_rmse = check.at_flat;
    if (model.horizontal_rmse == 0) model.horizontal_rmse = check.per_slope;
  }
  if (!model.tails && check.statistics.count >= kFewestForTails) model.tails = check.tails;
  if (model.correlation_length == 0)
    model.correlation_length = check.variogram.correlation_length(squared(check.between));
  if (model.shared_bias == 0) model.shared_bias = check.statistics.median;
  return model;
}

}  // namespace sightbound
