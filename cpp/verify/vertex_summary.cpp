// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/vertex_summary.h"

#include <algorithm>
#include <cmath>

namespace sightbound {

namespace {

constexpr std::size_t kBins = 40;

}  // namespace

void summarise_vertices(VerifyReport& report, const std::vector<bool>& used) {
  double sum = 0, squares = 0, low = 0, high = 0;
  std::size_t count = 0;
  for (std::size_t n = 0; n < used.size(); ++n) {
    if (!used[n]) continue;
    const auto deviation = static_cast<double>(report.vertex_deviation[n]);
    if (std::isnan(deviation)) {
      ++report.uncovered_vertices;
      continue;
    }
    low = count == 0 ? deviation : std::min(low, deviation);
    high = count == 0 ? deviation : std::max(high, deviation);
    sum += deviation;
    squares += deviation * deviation;
    ++count;
  }
  if (count == 0) return;
  report.mean_deviation = sum / static_cast<double>(count);
  report.rms_deviation = std::sqrt(squares / static_cast<double>(count));
  report.histogram = {low, high, std::vector<std::size_t>(kBins, 0)};
  const double per_m = high > low ? static_cast<double>(kBins) / (high - low) : 0;
  for (const float value : report.vertex_deviation) {
    if (std::isnan(value)) continue;
    const auto bin = static_cast<std::size_t>((static_cast<double>(value) - low) * per_m);
    ++report.histogram.counts[std::min(bin, kBins - 1)];
  }
}

}  // namespace sightbound
